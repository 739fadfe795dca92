"""Clouds of which little was kept: the sample survey with one scan line in two, four and eight, and with few of its points."""

from types import SimpleNamespace

import laspy
import numpy as np
import pytest
import shapely
from heard import Heard
from lanewright.core.road.detect_boundaries import BoundarySettings
from lanewright.core.road.scanlines.detect import SurveyScanlines
from lanewright.core.survey.open_survey import open_survey
from lanewright.products.assess.lines import assess_boundaries
from road_layers import drawn_boundaries

pytestmark = pytest.mark.slow

ROTATION = 100.0
TOLERANCE = 0.10


@pytest.fixture(scope="module")
def street(made_survey):
    sample, cloud = made_survey(length=40.0, pulse_rate=100_000.0, rotation_rate=ROTATION, speed_kmh=30.0)
    curbs = {dropped: [geometry for geometry, row in sample.truth_boundaries
                       if row.get("part") != "top" and (row["edge"] == "dropped") == dropped] for dropped in (False, True)}
    return SimpleNamespace(cloud=cloud, trajectory=sample.trajectory, curbs=curbs[False], dropped=curbs[True])


def thinned(street, folder, which):
    """The survey of the points that `which` chooses by their times."""
    points = laspy.read(street.cloud)
    points.points = points.points[which(np.asarray(points.gps_time))]
    points.write(folder / "thinned.las")
    return open_survey([str(folder / "thinned.las")], street.trajectory)


def one_line_in(kept):
    # turns are counted from a whole second, which the mirror passes anywhere: a line begins in one of them and ends in the next
    return lambda time: np.floor((time - np.floor(time.min())) * ROTATION) % kept == 0


def drawn(survey, street, method):
    """The edges, and what was said meanwhile."""
    heard = Heard()
    edges = drawn_boundaries(survey, BoundarySettings(method=method), progress=heard)
    return edges.geometries, "\n".join(heard.said + heard.warned)


def right(edges, survey, street):
    """Whether nearly all edges are right within TOLERANCE, and nearly all curbs are found, to a centimetre."""
    found = assess_boundaries(edges, street.curbs, frame=survey.frame, excluded=street.dropped, reasons=["dropped"] * len(street.dropped))
    accuracy = found.total[TOLERANCE]
    return accuracy.rates.precision > 0.9 and accuracy.rates.recall > 0.9 and accuracy.lateral.rmse < 0.01


@pytest.mark.parametrize("kept, method", [(2, "both"), (8, "scanlines"), (8, "both")])
def test_of_a_few_scan_lines_the_curbs_are_drawn_still(street, tmp_path, kept, method):
    survey = thinned(street, tmp_path, one_line_in(kept))
    clocks = SurveyScanlines(survey).lattice.mirror_phases.values()
    assert len(clocks) == len(survey.scanners)
    for clock in clocks:
        assert abs(clock.frequency) / clock.spacing == pytest.approx(ROTATION / kept, rel=1e-3)
    assert right(drawn(survey, street, method)[0], survey, street)


def test_of_an_eighth_of_the_points_no_false_curb_is_drawn_and_the_log_says_that_scanlines_measured_none(street, tmp_path):
    """Points a quarter of a metre apart on the road hit a curb's face once or not at all; profiles add up what many lines saw."""
    curbs, off = shapely.union_all(shapely.force_2d(street.curbs + street.dropped)), []
    for draw in range(3, 7):
        survey = thinned(street, tmp_path, lambda time, draw=draw: np.random.default_rng(draw).random(len(time)) < 1 / 8)
        edges, said = drawn(survey, street, "both")
        assert "Corners of curbs: 0 measured on scanlines" in said and "scanlines 0 m" in said
        assert shapely.length(edges).sum() > 20.0
        off.append(shapely.distance(shapely.points(shapely.get_coordinates(shapely.segmentize(edges, 0.5))), curbs))
    # the last step of a curb may be one of what lies beyond it
    assert np.quantile(np.concatenate(off), 0.98) < TOLERANCE and np.concatenate(off).max() < 0.3


def test_of_a_thinned_cloud_without_times_scanlines_are_made_of_points_and_the_log_says_so(street, tmp_path):
    survey = thinned(street, tmp_path, one_line_in(2))
    survey.has_time = False
    edges, said = drawn(survey, street, "both")
    assert "scanlines are made of the points near each section plane" in said
    assert right(edges, survey, street)
