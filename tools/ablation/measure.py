"""The road map of one survey, and what it becomes without each rule."""

import hashlib
import json
import pickle
import time
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from accuracy import judge
from accuracy.chain import STAGES as SINGLE_STAGES
from accuracy.chain import Work
from accuracy.otherwise import on_the_street, rows_of, surveyed
from accuracy.streets import judged
from accuracy.surveys import read_case
from accuracy.variants import VARIANTS, Variant
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.road.detect_boundaries import draw_boundaries
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.road.surface.ground_grid import MeasuredGround
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.store.road_points import columns_of_roads
from lanewright.core.survey.trajectory.reader import read_trajectory
from osgeo import gdal

from .swap import Watch, replaced
from .switches import DEFAULT, SWITCHES

ALL_VARIANTS = {variant.name: variant for variant in (
    Variant("as surveyed"), *VARIANTS, Variant("thinned to a quarter", every=4), Variant("stations moved by 0.3 m", moved=0.3),
    Variant("stations moved by 1 m", moved=1.0))}


def _edges(work, settings):
    work.ground = MeasuredGround(work.survey)
    work.edges = draw_boundaries(work.found, work.frame, settings.edges, survey=work.survey, ground=work.ground).edges


def _surface(work, settings):
    work.road, work.surface = extract_road_surface(work.survey, work.edges, settings.surface, ground=work.ground)


STAGES = {**SINGLE_STAGES, "edges": _edges, "surface": _surface}   # as make_road_map runs them, edges of the pavement included
POINTS = "s", "d", "z"


def _state(work, stage):
    """A digest of what a stage hands on; None where that is not looked at."""
    found = {"curbs": lambda: work.found, "edges": lambda: work.edges,
             "surface": lambda: (work.surface, *_columns(work.road, "half_width", "covered")),
             "intensity": lambda: _columns(work.bright, "corrected"), "markings": lambda: _columns(work.points, "spacing"),
             "outliers": lambda: _columns(work.kept), "clusters": lambda: (work.marking_objects, *_columns(work.clustered, "cluster")),
             "lines": lambda: (work.lines, work.marking_objects), "driving": lambda: _map(work)}.get(stage)
    return None if found is None else hashlib.sha256(pickle.dumps(found())).hexdigest()


def _columns(points, *names):
    records = columns_of_roads(points.store, points.roads())
    return [np.asarray(records[name]) for name in (*POINTS, *names) if name in records.names]


def _map(work):
    return [[(geometry.wkb, sorted(map(str, row.items()))) for geometry, row in layer]
            for layer in (work.edges.to_features(work.frame), work.markings, work.driving)]


class Survey:
    """One survey in one variant, read once, with the results of every stage.

    Parameters
    ----------
    folder : of the survey
    variant : Variant
    scratch : folder for what is written meanwhile
    switches : that are watched
    """

    def __init__(self, folder, variant, scratch, switches):
        self.case, self.variant, self.scratch = read_case(folder), variant, Path(scratch)
        self.rows, self.centre = rows_of(self.case)
        cloud, trajectory = surveyed(self.case, variant, self.rows, self.centre, self.scratch)
        self.survey = open_survey([cloud], read_trajectory(trajectory))
        self.watch, self.states = Watch(switches), {}
        self.work = Work(self.survey, self.scratch)
        with self.watch.watching():
            for stage, run in STAGES.items():
                self.watch.stage = stage
                run(self.work, DEFAULT)
        self.states = {stage: _state(self.work, stage) for stage in STAGES}
        self.figures = self.judged(self.work)

    def close(self):
        self.survey.store.close()

    def judged(self, work):
        """{name: (right, of how much)}."""
        edges, markings, lanes = (on_the_street(layer, self.variant, self.centre)
                                  for layer in (work.edges.to_features(work.frame), work.markings, work.driving))
        paint = None
        if "markings" in self.case.truth.has:
            paint = judge.paint(self.case, [geometry for geometry, _ in markings], [row["class"] for _, row in markings])["counts"]
        figures = judged(self.case, self.rows[:, 1:3], edges, paint, lanes)
        if paint and paint["classed"]:
            figures["classes"] = paint["named"], paint["classed"]
        return figures

    def _stages(self, switches):
        return {stage for switch in switches for stage in (self.watch.felt[switch.name] | {switch.stage}) if stage}

    def idle(self, switches):
        """Why the map needs not be made without some rules: "not called", or "no effect" where they gave what stands in for them; "" otherwise."""
        if self._stages(switches):
            return ""
        return "no effect" if any(switch.name in self.watch.called for switch in switches) else "not called"

    def without(self, switches):
        """What the map is without some rules: {"outcome": "not called", "no effect", "same map", "another map" or "refused", "figures": ...}."""
        if why := self.idle(switches):
            return dict(outcome=why)
        first = self._stages(switches)
        names, work = list(STAGES), self.work.copy()
        settings = next((switch.settings for switch in switches if switch.settings is not DEFAULT), DEFAULT)
        began, differs = min(map(names.index, first)), False
        try:
            with replaced([swap for switch in switches for swap in switch.swaps]):
                for stage in names[began:]:
                    STAGES[stage](work, settings)
                    later, same = names[names.index(stage) + 1:], self.states[stage] and _state(work, stage) == self.states[stage]
                    # edges are drawn themselves, and judged, though all that follows may be the same
                    differs |= stage == "edges" and not same
                    if same and not differs and not first & set(later):
                        return dict(outcome="same map")
        except RoadExtractionError as problem:
            return dict(outcome="refused", why=str(problem))
        finally:
            if work.image_path != self.work.image_path:
                work.image_path.unlink(missing_ok=True)
        return dict(outcome="another map", figures=self.judged(work))


def measure(folder, variant, switches, groups, into, code):
    """Measure what is missing of one survey in one variant, and keep every result as soon as it is there.

    folder : of the survey; variant : its name; switches : {name: Switch}; groups : {name: [names of switches]}; into : JSON file
    code : digest of the core; results of another one are measured anew

    All other switches are watched too: `idle` names those that need not be tried, and why.
    """
    known = json.loads(into.read_text()) if into.exists() else {}
    whose = dict(code=code, survey=str(folder))
    known = known if known.items() >= whose.items() else dict(whose, off={})
    wanted = {**{name: [name] for name in switches}, **groups}
    missing = [name for name, members in wanted.items() if known["off"].get(name, {}).get("of") != sorted(members)]
    if not missing and "figures" in known or "refused" in known:
        return
    into.parent.mkdir(parents=True, exist_ok=True)
    # every raster made in memory would be said to lack a CRS
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    with TemporaryDirectory() as scratch:
        began = time.monotonic()
        try:
            survey = Survey(folder, ALL_VARIANTS[variant], scratch, [*SWITCHES.values()])
        except RoadExtractionError as problem:
            into.write_text(json.dumps({**known, "refused": str(problem)}))
            return
        with closing(survey):
            idle = {name: survey.idle([switch]) for name, switch in SWITCHES.items()}
            known.update(figures=survey.figures, seconds=time.monotonic() - began, idle={name: why for name, why in idle.items() if why})
            for name in missing:
                began = time.monotonic()
                found = survey.without([switches[one] for one in wanted[name]])
                known["off"][name] = {**found, "of": sorted(wanted[name]), "seconds": round(time.monotonic() - began, 1)}
                into.write_text(json.dumps(known, indent=1))
            into.write_text(json.dumps(known, indent=1))
