"""Each improvement over the published methods switched off alone: by a setting, or by a step that does nothing."""

from dataclasses import dataclass, field, replace

import numpy as np
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.driving.layers import driving_lines_to_features
from lanewright.core.pipeline.road_map import RoadMapSettings
from lanewright.core.road.common.tracking import StepChain
from lanewright.core.road.surface.extract import extract_road_surface

from .chain import set_in

DEFAULT = RoadMapSettings()


@dataclass(frozen=True)
class Ablation:
    """What is switched off, the first stage that feels it, and how."""

    text: str
    first: str
    settings: RoadMapSettings = DEFAULT
    swaps: tuple = ()
    stages: dict = field(default_factory=dict)
    needs_beams: bool = False


class _NoBeams:
    of = staticmethod(lambda *_: None)


def nearest_steps(steps, _label, _width, limits):
    """The thesis's choice: on every profile the step nearest the vehicle, all in one chain."""
    slope = np.arctan2(steps.height, np.maximum(steps.run, 1e-6))
    good = np.flatnonzero((steps.height >= limits.clear_height) & (slope >= limits.clear_slope))
    order = good[np.lexsort((steps.u[good], steps.profile[good]))]
    first = order[np.r_[True, np.diff(steps.profile[order]) != 0]] if len(order) else order
    return [StepChain(first, float(steps.s[first].min()), float(steps.s[first].max()))] if len(first) else []


def _whole(chains, *_):
    return [(k, chain.start, chain.end) for k, chain in enumerate(chains)]


def _surface_alone(work, settings):
    work.road, work.surface = extract_road_surface(work.survey, None, settings.surface)


def _keep_all(work, settings):
    work.kept = work.points


def _driving_alone(work, settings):
    lines, *_ = make_driving_lines(work.lines, work.frame, settings.driving, road_points=work.bright)
    work.driving = driving_lines_to_features(lines, work.frame)


ABLATIONS = (
    Ablation("Curbs: the step nearest the vehicle on each profile, instead of chains along the road", "curbs", swaps=(
        ("road.profiles.detect", "curb_chains", nearest_steps), ("road.profiles.detect", "select_along_road", _whole),
        ("road.profiles.detect", "drop_short_curbs", lambda chosen, *_: chosen))),
    Ablation("Edges: curb points far off the others are kept", "edges", swaps=(
        ("road.edges.fit", "without_outliers", lambda points: points),)),
    Ablation("Surface: its limits are grown from the ground alone, without road edges", "surface", stages=dict(surface=_surface_alone)),
    Ablation("Intensity: no correction", "intensity", replace(DEFAULT, correct=False)),
    Ablation("Intensity: beams of spinning scanners are not made alike", "intensity", swaps=(
        ("intensity.correction", "Beams", _NoBeams),), needs_beams=True),
    Ablation("Image: bright points count no more than dark ones (plain inverse distance)", "image", set_in(DEFAULT, "image", beta=0.0)),
    Ablation("Thresholds: concrete gutters are not told from paint", "markings", swaps=(
        ("markings.paint.asphalt_level", "gutter_cells", lambda z, rim: np.zeros(z.shape, bool)),)),
    Ablation("Thresholds: no local level of asphalt (wheel tracks, seams)", "markings", swaps=(
        ("markings.paint.asphalt_level", "background", lambda z, even: np.float32(0.0)),)),
    Ablation("Thresholds: bright repairs are not told from paint", "markings", swaps=(
        ("markings.paint.asphalt_level", "patch_level", lambda z, bright: np.float32(0.0)),)),
    Ablation("Thresholds: no least run along or across the road", "markings", set_in(DEFAULT, "markings", close=0.0, shortest=0.0)),
    Ablation("Outliers: one limit for the whole survey (PCL), not one per window", "outliers", set_in(DEFAULT, "outliers", scope="all")),
    Ablation("Outliers: none removed", "outliers", stages=dict(outliers=_keep_all)),
    Ablation("Clusters: markings that touch are not taken apart", "clusters", swaps=(
        ("markings.objects.cluster", "split_compounds", lambda records, labels, *_: labels),)),
    Ablation("Clusters: pieces of worn lines are not joined", "clusters", swaps=(
        ("markings.objects.cluster", "join_fragments", lambda shapes, width: np.arange(len(shapes))),)),
    Ablation("Lines: gaps longer than 13 m are not bridged", "lines", set_in(DEFAULT, "lines", max_bridge=DEFAULT.lines.max_gap)),
    Ablation("Lines: strays beside a line are not dropped", "lines", swaps=(
        ("markings.lines.fit", "without_strays", lambda line, trend, edges: line),)),
    Ablation("Driving lines: from marking lines alone, without road edges and hatching", "driving", stages=dict(driving=_driving_alone)),
)
