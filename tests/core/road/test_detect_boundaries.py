"""Two methods of finding road boundaries, and how they check each other."""

import numpy as np
import pytest
import shapely
from curbed_streets import NORTH, parked_car, street, survey_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import Features
from lanewright.core.common.schemas import CURB_POINTS
from lanewright.core.road.agreement import measure_agreement, select_curb_points
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from lanewright.core.road.edges.fit import fit_road_edges


def boundaries(points, method):
    surveyed = survey_of(points)
    return draw_boundaries(find_curb_points(surveyed, BoundarySettings(method)), surveyed.frame)


def curb_points(frame, offset, stations=np.arange(1.0, 59.0), side="left", scatter=0.0, chain=0):
    """Curb points of one side at an offset, a number or a function of station, scattered about it."""
    found = Features("PointZ", list(CURB_POINTS))
    offsets = np.broadcast_to(offset(stations) if callable(offset) else offset, stations.shape)
    offsets = offsets + scatter * np.where(np.arange(len(stations)) % 2, 1, -1)
    x, y, z = frame.to_map(0, stations, offsets, np.zeros(len(stations)))
    for point, s, d in zip(shapely.points(np.c_[x, y, z]), stations, offsets):
        found.add(point, road=0, side=side, status="measured", station_m=float(s), offset_m=float(d), height_m=0.12, part="bottom",
                  chain=chain, residual_m=0.0, support=100)
    return found


@pytest.fixture(scope="module")
def frame():
    return survey_of(street()).frame


@pytest.mark.parametrize("method", ["profiles", "scanlines", "both"])
def test_every_method_draws_both_edges_of_a_street(method):
    found = boundaries(street(), method)
    for side, offset in (("left", 3.5), ("right", -3.5)):
        lines = [np.array(line.coords) for line, row in found.edges if row["side"] == side]
        assert sum(np.ptp(line[:, 0]) for line in lines) > 58
        for line in lines:
            np.testing.assert_allclose(line[:, 1] - NORTH, offset, atol=0.01)
    assert (found.differences is not None) == (method == "both")


def test_where_both_see_the_curb_they_agree_to_a_centimetre_and_say_so():
    found = boundaries(parked_car(street(), start=25.0), "both")
    assert all(row["agree_cm"] is not None and row["agree_cm"] < 1.0 for row in found.edges.rows if row["status"] == "measured")
    assert len(found.differences) == 0
    assert min(found.length_by_method.values()) > 100


def test_one_method_alone_says_nothing_of_agreement():
    assert all(row.get("agree_cm") is None for row in boundaries(street(), "scanlines").edges.rows)


def test_a_curb_that_only_one_method_finds_is_drawn_without_agreement():
    # four centimetres: below the least height of profiles
    found = boundaries(street(curb=0.04, noise=0.002), "both")
    assert found.length_by_method["profiles"] == 0
    assert sum(row["length_m"] for row in found.edges.rows) > 110
    assert all(row.get("agree_cm") is None for row in found.edges.rows)


def test_of_two_lines_along_one_curb_the_one_with_less_scatter_is_drawn(frame):
    calm, rough = curb_points(frame, 3.50), curb_points(frame, 3.53, scatter=0.03)
    for first, second in ((calm, rough), (rough, calm)):
        drawn = select_curb_points(first, second, fit_road_edges(first, frame), fit_road_edges(second, frame), frame)
        np.testing.assert_allclose(drawn.column("offset_m"), 3.50, atol=1e-6)


def test_of_two_curbs_that_of_the_first_method_is_drawn_and_its_gaps_are_filled_by_the_other(frame):
    sure, other = curb_points(frame, 3.5, np.arange(1.0, 40.0)), curb_points(frame, 5.0, np.arange(20.0, 55.0))
    drawn = select_curb_points(sure, other, fit_road_edges(sure, frame), fit_road_edges(other, frame), frame)
    s, d = np.array(drawn.column("station_m")), np.array(drawn.column("offset_m"))
    np.testing.assert_allclose(d[s < 39], 3.5)
    np.testing.assert_allclose(d[s > 41], 5.0)


def test_a_stretch_where_the_two_lie_eight_centimetres_apart_is_reported(frame):
    one = fit_road_edges(curb_points(frame, 3.5), frame)
    other = fit_road_edges(curb_points(frame, lambda s: 3.5 + 0.08 * np.exp(-((s - 30) / 6) ** 4)), frame)
    drawn = fit_road_edges(curb_points(frame, 3.5), frame)
    reported = measure_agreement(drawn, one, other, frame)
    row, = reported.rows
    assert 23 < row["station_m"] < 27 and 33 < row["end_m"] < 37
    assert row["agree_cm"] == pytest.approx(8.0, abs=0.5)
    assert drawn.rows[0]["agree_cm"] == pytest.approx(8.0, abs=1.0)
    np.testing.assert_allclose(np.array(reported.geometries[0].coords)[:, 1] - NORTH, 3.5, atol=0.001)


def test_a_method_that_is_not_known_is_refused():
    with pytest.raises(RoadExtractionError, match="boundary method"):
        BoundarySettings("both ways")
