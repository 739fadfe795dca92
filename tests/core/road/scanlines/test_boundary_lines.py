"""Boundary lines from scanlines that were made before, and where their pieces end."""

import numpy as np
import pytest
import shapely
from curbed_streets import LENGTH, NORTH, SENSOR, parked_car, street, survey_of
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CURB_POINTS, Features
from lanewright.core.road.scanlines.candidates import ScanlineBoundarySettings
from lanewright.core.road.scanlines.detect import LayerScanlines, SurveyScanlines
from lanewright.core.road.scanlines.grid import Scanlines
from lanewright.core.road.scanlines.section_planes import ScanlineSettings, scanlines_of
from road_layers import boundary_lines, curbs_from_scanlines


def layer_of(surveyed, **options):
    """The scanlines of a survey as a layer holds them."""
    return LayerScanlines({0: scanlines_of(surveyed, 0, *surveyed.store.span(0))}, surveyed.frame, ScanlineSettings.interval, "", **options)


@pytest.fixture(scope="module")
def surveyed():
    return survey_of(street(noise=0.002))


@pytest.fixture(scope="module")
def frame(surveyed):
    return surveyed.frame


def corner_points(frame, stations, hidden=(), offset=3.5):
    found = Features("PointZ", list(CURB_POINTS))
    for status, at in (("measured", stations), ("occluded", hidden)):
        for s in at:
            x, y, z = frame.to_map(0, s, offset, 0.0)
            for part in ("bottom", "top") if status == "measured" else ("bottom",):
                found.add(shapely.Point(x, y, z + (0.12 if part == "top" else 0.0)), road=0, side="left", status=status, station_m=float(s),
                          offset_m=offset, height_m=0.12, part=part, chain=0)
    return found


def test_bottom_and_top_lines_run_along_both_curbs(surveyed):
    lines = boundary_lines(curbs_from_scanlines(layer_of(surveyed), block_length=0.5), surveyed.frame, 2.5)
    for side, offset in (("left", 3.5), ("right", -3.5)):
        heights = {}
        for part in ("bottom", "top"):
            own = [np.array(line.coords) for line, row in lines if row["side"] == side and row["part"] == part]
            assert sum(np.ptp(line[:, 0]) for line in own) > LENGTH - 2
            for line in own:
                np.testing.assert_allclose(line[:, 1] - NORTH, offset, atol=0.004)
            heights[part] = np.median(own[0][:, 2])
        assert heights["top"] - heights["bottom"] == pytest.approx(0.12, abs=0.004)


def test_a_layer_gives_the_corners_of_its_survey(surveyed):
    direct, layer = curbs_from_scanlines(SurveyScanlines(surveyed)), curbs_from_scanlines(layer_of(surveyed))
    assert len(direct) == pytest.approx(len(layer), abs=4)
    np.testing.assert_allclose([g.y for g, r in layer if r["side"] == "left" and r["part"] == "bottom"], NORTH + 3.5, atol=0.004)


def test_the_height_of_the_sensor_comes_from_the_scanlines_or_from_the_user(surveyed):
    assert layer_of(surveyed).heights[0] == pytest.approx(SENSOR, abs=0.01)
    assert layer_of(surveyed, sensor_height=2.2).heights[0] == 2.2


def test_with_a_sensor_height_far_off_nothing_lies_below_the_clipping_height(surveyed):
    assert len(curbs_from_scanlines(layer_of(surveyed, sensor_height=3.5), ScanlineBoundarySettings())) == 0


def test_a_gap_is_joined_up_to_the_longest_and_left_open_beyond(frame):
    before, after, far = np.arange(5.0, 20.0, 0.5), np.arange(21.5, 30.0, 0.5), np.arange(33.0, 50.0, 0.5)
    lines = boundary_lines(corner_points(frame, np.r_[before, after, far]), frame, 2.5)
    bottoms = [row for row in lines.rows if row["part"] == "bottom"]
    assert [row["status"] for row in bottoms] == ["measured", "bridged", "measured", "measured"]
    assert bottoms[1]["station_m"] == pytest.approx(19.5) and bottoms[1]["end_m"] == pytest.approx(21.5)
    assert bottoms[2]["end_m"] == pytest.approx(29.5) and bottoms[3]["station_m"] == pytest.approx(33.0)
    assert len({row["chain"] for row in bottoms}) == 2


def test_a_gap_that_something_hides_is_called_occluded(frame):
    stations = np.r_[np.arange(5.0, 20.0, 0.5), np.arange(24.5, 40.0, 0.5)]
    lines = boundary_lines(corner_points(frame, stations, hidden=np.arange(20.0, 24.5, 0.5)), frame, 6.0)
    assert [row["status"] for row in lines.rows if row["part"] == "bottom"] == ["measured", "occluded", "measured"]


def test_behind_a_parked_car_nothing_is_measured():
    surveyed = survey_of(parked_car(street(), start=25.0))
    lines = boundary_lines(curbs_from_scanlines(layer_of(surveyed), block_length=0.5), surveyed.frame, 8.0)
    for _line, row in lines:
        if row["side"] == "left" and row["status"] == "measured":
            assert row["end_m"] < 26.5 or row["station_m"] > 28.0
    assert "occluded" in {row["status"] for row in lines.rows if row["side"] == "left"}


def test_a_layer_without_neighbouring_scanlines_is_refused(frame):
    with pytest.raises(RoadExtractionError, match="section planes"):
        LayerScanlines({0: Scanlines.none()}, frame, 0.1, "")
