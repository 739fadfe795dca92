"""The chain stage by stage, so that one stage can be run again another way on what the others gave."""

import time
from dataclasses import replace

from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.intensity.correction import correct_intensity
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.io.geotiff import IntensityImage
from lanewright.core.markings.lines.fit import fit_marking_lines, named_by_lines
from lanewright.core.markings.objects.cluster import cluster_markings
from lanewright.core.markings.outliers import remove_outliers
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.pipeline.road_map import RoadMapSettings
from lanewright.core.road.detect_boundaries import draw_boundaries, find_curb_points
from lanewright.core.road.surface.extract import extract_road_surface


class Work:
    """What the stages have made so far: survey, curbs, edges, road, bright, image, points, kept, markings, ..."""

    def __init__(self, survey, scratch):
        self.survey, self.frame, self.scratch = survey, survey.frame, scratch
        self.seconds, self.beams = {}, 0

    def copy(self):
        other = Work(self.survey, self.scratch)
        other.__dict__.update({name: value for name, value in self.__dict__.items() if name != "seconds"})
        return other


def _curbs(w, settings):
    w.found = find_curb_points(w.survey, settings.boundaries)


def _edges(w, settings):
    w.edges = draw_boundaries(w.found, w.frame, settings.edges).edges


def _surface(w, settings):
    w.road, w.surface = extract_road_surface(w.survey, w.edges, settings.surface)


def _intensity(w, settings):
    w.bright, w.beams = w.road, 0
    if settings.correct:
        w.bright, report = correct_intensity(w.road, w.frame, settings.intensity)
        w.beams = report.beams


def _image(w, settings):
    w.image_path = w.scratch / f"image_{len(list(w.scratch.iterdir()))}.tif"
    make_intensity_image(w.bright, settings.image, path=w.image_path).close()


def _markings(w, settings):
    w.points = extract_markings(w.bright, IntensityImage.open(w.image_path), w.frame, settings.markings)


def _outliers(w, settings):
    w.kept = remove_outliers(w.points, settings.outliers) if len(w.points) else w.points


def _clusters(w, settings):
    w.unnamed, w.clustered = cluster_markings(w.kept, w.frame, settings.clusters)
    w.marking_objects = w.unnamed
    w.markings = w.marking_objects.to_features(w.frame)


def _lines(w, settings):
    w.lines = fit_marking_lines(w.clustered, w.unnamed, w.frame, settings.lines, edges=w.edges.densified(w.frame),
                                road_points=w.bright)
    w.marking_objects = named_by_lines(w.unnamed, w.lines)
    w.markings = w.marking_objects.to_features(w.frame)


def _driving(w, settings):
    lines, *_ = make_driving_lines(w.lines, w.frame, settings.driving, markings=w.marking_objects,
                                  edges=w.edges.densified(w.frame), road_points=w.bright)
    w.driving = lines.to_features(w.frame)


STAGES = dict(curbs=_curbs, edges=_edges, surface=_surface, intensity=_intensity, image=_image, markings=_markings,
              outliers=_outliers, clusters=_clusters, lines=_lines, driving=_driving)


def run(work, first="curbs", last="driving", settings=RoadMapSettings()):
    """The work with the stages from `first` to `last` run anew; `work` holds what the stages before `first` gave, and is left as it is."""
    names = list(STAGES)
    done = work.copy()
    for name in names[names.index(first):names.index(last) + 1]:
        began = time.perf_counter()
        STAGES[name](done, settings)
        done.seconds[name] = time.perf_counter() - began
    return done


def set_in(settings, stage, **values):
    """RoadMapSettings with some settings of one stage changed."""
    return replace(settings, **{stage: replace(getattr(settings, stage), **values)})
