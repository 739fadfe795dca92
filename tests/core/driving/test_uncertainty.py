"""How uncertain a driving line is said to be."""

import numpy as np
import pytest
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.survey.frame.row_table import SigmaAlong
from lined_streets import HEIGHT, Street
from painted_streets import road_points, street
from shapely.geometry import Polygon

BORDER = np.hypot(0.005, 0.028 * 0.03)   # m, of a painted border whose paint does not scatter, where nothing says how far apart the points lie


def sigmas(lines, **wanted):
    """sigma_m of the pieces with these values."""
    return [row["sigma_m"] for row in lines.rows if all(row[name] == value for name, value in wanted.items())]


def two_lanes(wander=0.0, gap=None, **street):
    """A street of two lanes whose lines wander by so many metres over twelve metres, the lines left out in a gap."""
    found = Street(vehicle=-1.75, **street)
    for k, offset in enumerate((-3.5, 0.0, 3.5)):
        def at(s, offset=offset, k=k):
            return offset + wander * np.sin(2 * np.pi * s / 12.0 + k)
        for first, last in ((5.0, 115.0),) if gap is None else ((5.0, gap[0]), (gap[1], 115.0)):
            found.paint(at, first, last, kind="edge" if k != 1 else "centre", line=k + 1)
        if gap is not None:
            found.paint(at, *gap, kind="edge" if k != 1 else "centre", line=k + 1, status="bridged")
    return found


def test_between_clean_lines_it_is_some_millimetres_and_lines_that_wander_make_it_worse():
    clean, wavy = (sigmas(two_lanes(wander).lanes()[0], status="measured") for wander in (0.0, 0.04))
    assert len(clean) == len(wavy) == 2
    assert 0.002 < max(clean) < 0.005 and min(wavy) > 1.5 * max(clean)


def test_a_bridge_is_worse_than_what_it_joins():
    lines, _ = two_lanes(gap=(50.0, 62.0)).lanes()
    measured, bridged = sigmas(lines, status="measured"), [s for status in ("bridged", "inferred") for s in sigmas(lines, status=status)]
    assert measured and bridged and min(bridged) > max(measured)


def test_beside_one_line_alone_it_is_worse_by_what_may_be_left_over_beside_the_lane():
    lines, _ = Street(vehicle=-1.75).paint(3.5, kind="edge").paint(0.0, kind="centre").lanes()
    assert max(sigmas(lines, source="pair")) < 0.005 and 0.05 < min(sigmas(lines, source="offset")) < 0.07


def test_what_passes_differ_by_is_in_it():
    street = two_lanes(again=(1.75,))
    before = sigmas(street.lanes()[0], status="measured")
    street.frame.pass_sigma[0] = SigmaAlong.everywhere(0.04)
    after = sigmas(street.lanes()[0], status="measured")
    np.testing.assert_allclose(after, np.hypot(before, 0.04), atol=1e-4)
    assert before[0] == pytest.approx(before[1], rel=0.5)


def test_a_driving_line_is_cut_where_its_passes_begin_to_differ_by_centimetres():
    street = two_lanes(again=(1.75,))
    street.frame.pass_sigma[0] = SigmaAlong((0.0, 60.0, 60.1, 120.0), (0.0, 0.0, 0.05, 0.05))
    rows = sorted((row for row in street.lanes()[0].rows if row["lane"] == 1), key=lambda row: row["station_m"])
    assert [row["sigma_m"] for row in rows] == pytest.approx([0.002, 0.05], abs=0.006)
    assert rows[0]["end_m"] == rows[1]["station_m"] == pytest.approx(60.0, abs=5.0)
    assert {row["status"] for row in rows} == {"measured"}


@pytest.mark.parametrize("scatter", [0.005, 0.015, 0.04])
def test_it_grows_with_the_scatter_of_the_paint_about_the_lines_of_the_lane(scatter):
    street = two_lanes()
    usual = sigmas(street.lanes()[0], status="measured")
    for row in street.lines.rows:
        row["rmse_m"] = scatter
    told = sigmas(street.lanes()[0], status="measured")
    assert told[0] == pytest.approx(np.hypot(0.13 * scatter, BORDER) / np.sqrt(2.0), abs=3e-4), "half of the error of each of two borders"
    assert (told[0] > usual[0]) == (scatter > 0.010), "where nothing is known of the paint it is taken to scatter by a centimetre"


def test_a_lane_that_was_measured_nowhere_is_as_sure_as_the_borders_that_hold_it():
    street = Street(vehicle=-1.75)
    for line, offset in ((1, -3.5), (2, 3.5)):
        street.paint(offset, kind="edge", line=line)
    lines, _ = street.lanes()
    assert len(lines.rows) == 2 and {row["status"] for row in lines.rows} == {"inferred"}
    np.testing.assert_allclose(sigmas(lines), np.hypot(0.13 * 0.010, BORDER) * np.hypot(0.75, 0.25), atol=3e-4)


def test_the_farther_the_next_paint_of_a_border_the_less_sure_the_lane():
    of_gap = {}
    for length in (10.0, 20.0):
        lines, _ = two_lanes(gap=(50.0, 50.0 + length)).lanes()
        of_gap[length] = max(s for status in ("bridged", "inferred") for s in sigmas(lines, status=status))
    assert of_gap[20.0] > 1.5 * of_gap[10.0] > 0.005


def test_where_the_line_leaves_the_places_of_its_lane_for_metres_it_is_as_uncertain_as_that():
    """Borders that wind by a centimetre are seen to; the lane is one arc all along, and lies beside its places by half a centimetre and more."""
    street = two_lanes(wander=0.01)
    plain = sigmas(two_lanes().lanes()[0], status="measured")
    assert min(sigmas(street.lanes()[0], status="measured")) > 0.005 > max(plain)


def test_beside_a_hatched_area_without_a_line_it_is_as_sure_as_the_outlines_of_its_bars():
    street = Street(vehicle=-3.5)
    for offset in (5.25, -5.25):
        street.paint(offset, kind="edge")
    bars = Features("PolygonZ", MARKINGS)
    for s in np.arange(6.0, 114.0, 2.0):
        corners = street.places([s, s + 0.5, s + 0.5, s], [-1.6, -1.6, 1.6, 1.6])
        bars.add(Polygon(np.c_[corners, np.full(4, HEIGHT)]), **{"road": 0, "class": "hatch", "use": "other"})
    told = sigmas(street.lanes(markings=bars)[0], status="measured")
    assert len(told) > 1 and told == pytest.approx([0.015] * len(told), abs=2e-3), "half of 3 cm"


def wound(offset):
    """A street whose lines wind: 1 m either side of their way."""
    return lambda s: offset + np.sin(2 * np.pi * s / 45.0)


def test_where_the_curvature_changes_it_is_worse():
    """A sine of 1 m over 45 m changes its curvature by (2 pi / 45)³ per metre at most, 0.7 of that in the mean square: 1.28 m³ times 0.0019."""
    told = []
    for lead in (lambda offset: offset, wound):
        street = Street(vehicle=-1.75)
        for k, offset in enumerate((-3.5, 0.0, 3.5)):
            street.paint(lead(offset), 5.0, 115.0, kind="edge" if k != 1 else "centre", line=k + 1)
        told.append(max(sigmas(street.lanes()[0], status="measured", lane=1)))
    assert (0.8 * 1.28 * 0.0019) ** 2 < told[1] ** 2 - told[0] ** 2 < (2.0 * 1.28 * 0.0019) ** 2


def test_the_farther_apart_the_points_the_less_sure_the_lane():
    told = {}
    for density in (2500, 100, 25):
        lanes = two_lanes()
        points = road_points(street(lanes.frame, length=120.0, left=5.0, right=-5.0, density=density), lanes.frame)
        told[density] = np.array(sigmas(lanes.lanes(road_points=points)[0], status="measured"))
    apart = {density: np.sqrt(values**2 - told[2500]**2) for density, values in told.items()}
    np.testing.assert_allclose(apart[100], 0.028 * np.sqrt(0.10**2 - 0.02**2) / np.sqrt(2.0), rtol=0.15)
    np.testing.assert_allclose(apart[25], 0.028 * np.sqrt(0.20**2 - 0.02**2) / np.sqrt(2.0), rtol=0.15)
