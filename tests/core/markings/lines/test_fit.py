"""Painted lines on streets made here, so that their course is known."""

import json

import numpy as np
import pytest
import shapely
from clustered_streets import RADIUS, UP, ClusteredStreet, told
from heard import Heard
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.curves.base import Arc
from lanewright.core.curves.bspline import Spline
from lanewright.core.curves.clothoid import Clothoid
from lanewright.core.curves.simple_curves import Ellipse
from lanewright.core.markings.lines.fit import MarkingLineSettings, fit_marking_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.markings.objects.marking_objects import MarkingObjects
from lanewright.core.survey.store.road_points import RoadPoints


def test_a_solid_line_in_a_bend_is_one_circle_on_the_paint():
    street = ClusteredStreet().paint(0, 120, 0.0, kind="centre")
    lines = street.lines()
    assert told(lines, "kind", "pattern", "status", "curve") == [("centre", "solid", "measured", "circle")]
    assert lines.rows[0]["radius_m"] == pytest.approx(RADIUS, rel=0.005)
    assert lines.rows[0]["width_m"] == pytest.approx(0.15, abs=0.03)
    assert lines.rows[0]["length_m"] == pytest.approx(120, abs=0.5)
    assert street.distance(lines.geometries[0], 0.0).max() < 0.01
    assert shapely.get_coordinates(lines.geometries[0], include_z=True)[:, 2] == pytest.approx(UP, abs=0.01)


def test_dashes_of_2_m_with_gaps_of_4_m_are_one_dashed_line_without_bridges():
    street = ClusteredStreet().dashes(2.0, 4.0, 0.0)
    lines = street.lines()
    assert told(lines, "line", "pattern", "status") == [(1, "dashed", "measured")]
    assert street.distance(lines.geometries[0], 0.0).max() < 0.02


@pytest.mark.parametrize("dash, gap", [(3.0, 6.0), (6.0, 9.0), (3.0, 9.0), (6.0, 3.0), (5.0, 5.0), (6.0, 12.0)])
def test_dashes_as_the_countries_paint_them_are_dashed_lines(dash, gap):
    assert told(ClusteredStreet().dashes(dash, gap, 0.0).lines(), "pattern", "status") == [("dashed", "measured")]


def test_the_dashes_of_a_cycle_lane_are_one_dashed_line():
    """A metre of paint, a metre of none."""
    lines = ClusteredStreet().dashes(1.0, 1.0, -2.0, width=0.12).lines()
    assert told(lines, "line", "pattern", "status") == [(1, "dashed", "measured")]
    assert lines.rows[0]["length_m"] == pytest.approx(120 * (RADIUS + 2.0) / RADIUS, abs=2.5)


def test_worn_away_dashes_are_bridged_and_flagged():
    lines = ClusteredStreet().dashes(3.0, 6.0, 0.0, missing=(4, 5)).lines()
    assert told(lines, "line", "status") == [(1, "measured"), (1, "bridged"), (1, "measured")]
    assert lines.rows[1]["length_m"] == pytest.approx(24.0, abs=1.0)
    assert lines.rows[1]["rmse_m"] is None
    ends = [shapely.get_coordinates(g, include_z=True)[[0, -1]] for g in lines.geometries]
    np.testing.assert_allclose(ends[0][1], ends[1][0], atol=1e-9)
    np.testing.assert_allclose(ends[1][1], ends[2][0], atol=1e-9)


def test_a_dashed_line_ends_with_its_gap_but_not_beyond_the_road_s_paint():
    """The neighbour is painted from 0 to 120 m; the dashes from 7 to 109 m, so that a gap of 6 m is left at either end."""
    street = ClusteredStreet().paint(0, 120, 4.0, kind="edge").dashes(3.0, 6.0, 0.0, first=7.0, last=113.0)
    dashed = [row for row in street.lines().rows if row["pattern"] == "dashed"]
    assert len(dashed) == 1
    assert dashed[0]["length_m"] == pytest.approx(109 - 7 + 6 + 6, abs=0.6)
    short = ClusteredStreet().paint(5, 120, 4.0, kind="edge").dashes(3.0, 6.0, 0.0, first=7.0, last=113.0)
    begun = [row for row in short.lines().rows if row["pattern"] == "dashed"]
    assert begun[0]["length_m"] == pytest.approx(109 - 5 + 6, abs=0.6)


def test_a_double_line_is_two_lines():
    street = ClusteredStreet().paint(0, 120, 0.15, kind="centre").paint(0, 120, -0.15, kind="centre")
    lines = street.lines()
    assert told(lines, "kind", "pattern") == [("centre", "double-solid")] * 2
    offsets = sorted((-0.15, 0.15), key=lambda o: street.distance(lines.geometries[0], o).max())
    for geometry, offset in zip(lines.geometries, offsets):
        assert street.distance(geometry, offset).max() < 0.01


@pytest.mark.parametrize("worn_from", [19, 15.6])
def test_between_two_junctions_a_short_double_line_keeps_both_its_lines_though_only_one_is_linked_with_what_follows(worn_from):
    street = ClusteredStreet().paint(0, 120, 4.0, kind="edge").paint(10, 19, 0.0, kind="centre").paint(45, 110, 0.0, kind="centre")
    lines = street.paint(10, worn_from, 0.31, kind="centre").paint(64, 110, 0.31, kind="centre").lines()
    assert len({row["line"] for row in lines.rows if row["station_m"] < 15 and row["kind"] == "centre"}) == 2
    ragged = ClusteredStreet().paint(10, 110, 0.0, kind="centre").paint(30, 39, 0.31, kind="centre").lines()
    assert len({row["line"] for row in ragged.rows}) == 1


def test_where_one_line_of_a_double_goes_on_as_dashes_it_is_no_double_line_any_more():
    street = ClusteredStreet().paint(0, 70, 0.0, kind="centre").paint(0, 70, 0.3, kind="centre").dashes(3.0, 6.0, 0.0, first=76.0)
    lines = street.paint(0, 120, 4.5, kind="edge").lines()
    assert sorted(set(told(lines, "pattern"))) == [("dashed",), ("double-solid",), ("solid",)]
    assert max(row["end_m"] for _, row in lines if row["pattern"] == "double-solid") == pytest.approx(70 * 144 / 140, abs=2.0)


def test_a_double_line_clustered_as_one_stays_two():
    street = ClusteredStreet()
    street.paint(0, 120, 0.15, kind="hatch", use="other")
    street.paint(0, 120, -0.15)
    street.rows.pop()
    street.points[1] = (np.ones_like(street.points[1][0]), *street.points[1][1:])
    assert told(street.lines(), "kind", "pattern") == [("centre", "double-solid")] * 2


def one_marking(*strips):
    """Strips along a street, (first, last, offset), of 10 cm each, taken for one marking."""
    street = ClusteredStreet()
    for strip in strips:
        street.paint(*strip, width=0.10)
    del street.rows[1:]
    street.points = [(np.ones_like(points[0]), *points[1:]) for points in street.points]
    return street


def test_two_lines_of_10_cm_with_10_cm_between_them_are_a_double_line_though_no_broader_than_one_worn_line():
    assert told(one_marking((0, 120, 0.1), (0, 120, -0.1)).lines(), "kind", "pattern") == [("centre", "double-solid")] * 2


def test_a_broad_line_with_its_middle_worn_off_here_and_there_is_one_line():
    middles = [(first, first + 8, 0.0) for first in range(0, 120, 10)]
    assert len(one_marking((0, 120, 0.1), (0, 120, -0.1), *middles).lines().rows) == 1


def test_a_road_whose_only_paint_runs_obliquely_across_it_has_no_line_that_others_follow():
    """0.19 m across for each metre along: more than any line that bounds lanes."""
    street = ClusteredStreet(radius=None)
    for first in np.arange(50.0, 56.0, 0.25):
        street.paint(first, first + 0.25, 0.19 * (first - 53.0))
    assert set(told(street.lines(), "status")) <= {("measured",)}


def zebra(street, s):
    for offset in np.arange(-4.0, 4.1, 1.0):
        street.paint(s, s + 4.0, offset, width=0.5, kind="zebra", use="other")
    return street


def test_a_zebra_crossing_neither_cuts_a_line_nor_makes_one():
    street = zebra(ClusteredStreet().paint(0, 55, 0.0, kind="centre").paint(65, 120, 0.0, kind="centre"), 58.0)
    lines = street.lines()
    assert told(lines, "line", "status") == [(1, "measured"), (1, "bridged"), (1, "measured")]
    assert street.distance(shapely.union_all(lines.geometries), 0.0).max() < 0.015


def test_the_frame_of_a_hatched_area_is_no_line_and_an_edge_line_beside_one_is():
    street = ClusteredStreet().paint(0, 120, -4.0, kind="edge")
    street.paint(40, 62, 1.0).paint(40, 62, 2.6, kind="centre")
    for s in np.arange(41, 61, 1.5):
        street.paint(s, s + 0.4, 1.15, across=2.45, kind="hatch", use="other")
        street.paint(s, s + 0.4, -3.85, across=-2.9, kind="hatch", use="other")
    lines = street.lines()
    assert told(lines, "kind", "status") == [("edge", "measured")]
    assert street.distance(lines.geometries[0], -4.0).max() < 0.02


def test_lines_beside_bars_that_lie_far_apart_along_a_tight_bend_are_lines():
    """The bars lie 2.8 m apart on the inside of the bend, but nearly 5 m along the axis, which is farther than those of one area."""
    street = ClusteredStreet(length=60.0, radius=25.0, half_width=16.0)
    for s in np.arange(15.0, 50.0, 5.2):
        street.paint(s, s + 0.5, 7.0, across=9.0, kind="hatch", use="other")
    lines = street.paint(18, 47, -4.0, kind="edge").paint(18, 47, 0.0, kind="centre").lines()
    assert told(lines, "status") == [("measured",), ("measured",)]


@pytest.mark.parametrize("outlined", [False, True])
def test_a_double_line_ends_at_a_hatched_island_though_the_edge_lines_run_on_beside_it_and_it_goes_on_behind(outlined):
    street = ClusteredStreet(radius=None).paint(0, 120, -4.0, kind="edge").paint(0, 120, 4.0, kind="edge")
    for twin in (-0.12, 0.12):
        street.paint(0, 46, twin, kind="centre").paint(74, 120, twin, kind="centre")
    half = lambda s: 1.1 * np.sin(np.pi * (s - 46.0) / 28.0)  # noqa: E731
    for s in np.arange(48.5, 71.0, 1.5):
        street.paint(s, s + 0.5, 0.1 - half(s), across=half(s) - 0.1, kind="hatch", use="other")
        for side in (-1, 1) if outlined else ():
            street.paint(s, s + 1.4, side * half(s + 0.7), kind="centre")
    found = list(street.lines())
    assert {row["status"] for _, row in found} == {"measured"}
    middle = [(line, row["line"]) for line, row in found if np.abs(shapely.get_coordinates(line)[:, 1] - 5_400_000.0).max() < 0.3]
    assert sum(line.length for line, _ in middle) == pytest.approx(184, abs=4) and len({number for _, number in middle}) == 2


def test_the_stop_line_that_touches_an_edge_line_leaves_the_edge_line_straight():
    street = ClusteredStreet().paint(0, 80, -4.0, kind="hatch", use="other")
    number = len(street.rows)
    street.paint(79.7, 80.0, -4.0, across=0.0)
    street.rows.pop()
    street.points[-1] = (np.full_like(street.points[-1][0], number), *street.points[-1][1:])
    lines = street.lines()
    assert len(lines) == 1
    assert street.distance(lines.geometries[0], -4.0).max() < 0.02
    assert lines.rows[0]["length_m"] == pytest.approx(80 * 144 / 140, abs=3.0)


def test_specks_are_no_lines():
    street = ClusteredStreet().paint(0, 120, 4.0, kind="edge").paint(30, 31.5, 1.0).paint(90, 91.2, -2.0)
    assert told(street.lines(), "kind", "line") == [("edge", 1)]


def test_the_line_of_an_exit_lane_that_leaves_the_edge_line_behind_the_gore_is_a_line():
    street = ClusteredStreet(half_width=9.0).paint(0, 120, 4.0, kind="edge").paint(40, 90, 7.6, kind="edge")
    for k in range(40):
        street.paint(60 + k / 2, 60.5 + k / 2, 4.4 + 0.06 * k, kind="edge")
    assert set(told(street.lines(), "line", "status")) == {(1, "measured"), (2, "measured"), (3, "measured")}


def test_the_outer_line_of_a_lay_by_is_a_line():
    street = ClusteredStreet().paint(0, 120, 2.0, kind="edge").paint(40, 80, 4.7, kind="edge")
    assert sorted(told(street.lines(), "line", "status")) == [(1, "measured"), (2, "measured")]


def test_lines_3_m_apart_are_never_linked_across():
    lines = ClusteredStreet().paint(0, 50, 1.5, kind="centre").paint(52, 120, -1.5, kind="centre").lines()
    assert sorted(told(lines, "line", "status")) == [(1, "measured"), (2, "measured")]


def test_a_turning_lane_s_line_begins_beside_the_line_that_runs_on():
    street = ClusteredStreet().dashes(3.0, 6.0, 1.5).paint(70, 110, -1.8, kind="centre").paint(0, 120, 4.5, kind="edge")
    lines = street.lines()
    assert sorted(set(told(lines, "line", "pattern"))) == [(1, "solid"), (2, "dashed"), (3, "solid")]
    assert lines.rows[-1]["station_m"] == pytest.approx(70.0, abs=1.0)


def test_a_dashed_line_that_becomes_solid_is_cut_where_it_changes():
    lines = ClusteredStreet().dashes(3.0, 6.0, 0.0, last=76.0).paint(79, 115, 0.0, kind="centre").lines()
    assert told(lines, "line", "pattern") == [(1, "dashed"), (1, "solid")]
    assert lines.rows[1]["length_m"] == pytest.approx(36.0, abs=0.7)


def test_a_worn_solid_line_is_not_called_dashed():
    street = ClusteredStreet(length=200.0, seed=5)
    for first, last in ((0, 14), (14.9, 22), (24, 31), (32.2, 38), (43, 46), (47.5, 56), (58.1, 75), (77, 83), (84, 90),
                        (93.4, 110), (111, 113), (114, 131), (139, 148), (149, 150.6), (152, 200)):
        street.paint(first, last, -4.0, kind="edge")
    assert {row["pattern"] for row in street.lines().rows} == {"solid"}


def test_three_pieces_of_unlike_lengths_are_no_dashed_line():
    street = ClusteredStreet()
    for first, length in ((20.0, 2.1), (29.0, 3.2), (40.0, 1.9)):
        street.paint(first, first + length, 0.0)
    assert set(told(street.lines(), "pattern")) == {("solid",)}


def test_dashes_that_begin_anew_where_roads_join_are_dashes():
    """Dashes of 3 m with gaps of 9 m along three stretches, each of which begins and ends with a dash wherever it may."""
    street = ClusteredStreet()
    for first in (10.0, 22.0, 29.3, 38.6, 50.6, 62.6):
        street.paint(first, first + 3.0, 0.0)
    assert {pattern for pattern, in told(street.lines(), "pattern")} == {"dashed"}


def test_three_even_dashes_are_a_dashed_line_though_one_has_lost_its_end():
    street = ClusteredStreet()
    for first, last in ((20.0, 23.0), (29.0, 32.0), (38.0, 39.9)):
        street.paint(first, last, 0.0)
    assert told(street.lines(), "pattern", "status") == [("dashed", "measured")]


def test_a_weaving_drive_does_not_bend_the_line():
    """The vehicle weaves by half a metre; the dashes are linked and lie on the axis all the same."""
    street = ClusteredStreet(weave=0.5).dashes(3.0, 9.0, 0.0).paint(0, 120, 4.5, kind="edge")
    lines = street.lines()
    assert sorted(told(lines, "kind", "status")) == [("centre", "measured"), ("edge", "measured")]
    lane = lines.geometries[[row["kind"] for row in lines.rows].index("centre")]
    assert street.distance(lane, 0.0).max() < 0.025


def test_driving_backwards_gives_the_same_lines():
    found = []
    for backwards in (False, True):
        street = ClusteredStreet(backwards=backwards).dashes(3.0, 6.0, 0.0).paint(0, 120, 4.5, kind="edge")
        found.append(street.lines())
    for pattern in ("dashed", "solid"):
        there, back = (shapely.union_all([g for g, row in lines if row["pattern"] == pattern]) for lines in found)
        assert there.length == pytest.approx(back.length, abs=1.0)
        assert np.median(shapely.distance(shapely.points(shapely.get_coordinates(there)), back)) < 0.005


def test_the_side_a_line_is_on_changes_nothing_but_its_side():
    here = ClusteredStreet(radius=0).dashes(3.0, 6.0, 1.5).lines()
    there = ClusteredStreet(radius=0).dashes(3.0, 6.0, -2.5).lines()
    assert told(here, "kind", "pattern", "status", "curve") == told(there, "kind", "pattern", "status", "curve")
    assert here.rows[0]["offset_m"] - there.rows[0]["offset_m"] == pytest.approx(4.0, abs=0.01)
    assert here.rows[0]["length_m"] == pytest.approx(there.rows[0]["length_m"], abs=0.1)


def test_the_order_of_the_points_and_the_sections_change_nothing():
    whole = ClusteredStreet().dashes(3.0, 6.0, 0.0).paint(0, 120, 4.5, kind="edge")
    shuffled = ClusteredStreet().dashes(3.0, 6.0, 0.0).paint(0, 120, 4.5, kind="edge")
    order = shuffled.rng.permutation(len(shuffled.points))
    shuffled.rng = whole.rng.__class__(np.random.PCG64(9))
    whole.rng = whole.rng.__class__(np.random.PCG64(9))
    shuffled.points = [shuffled.points[k] for k in order]
    lines, again = whole.lines(), shuffled.lines()
    assert len(lines) == len(again) == 2
    for a, b in zip(lines, again):
        np.testing.assert_allclose(shapely.get_coordinates(a[0]), shapely.get_coordinates(b[0]), atol=1e-9)
        assert {k: v for k, v in a[1].items()} == {k: v for k, v in b[1].items()}


def curve_of(params):
    kind = {"line": Arc, "circle": Arc, "ellipse": Ellipse, "clothoid": Clothoid, "b-spline": Spline}[params["curve"]]
    values = [params[name] for name in kind.__dataclass_fields__ if name in params]
    return kind(*(tuple(value) if isinstance(value, list) else value for value in values))


def test_every_piece_lies_on_the_curve_that_its_params_tell():
    street = ClusteredStreet().dashes(3.0, 6.0, 0.0, missing=(4, 5)).paint(0, 120, 4.5, kind="edge")
    lines = street.lines()
    assert {row["status"] for _, row in lines} == {"measured", "bridged"}
    for geometry, row in lines:
        params = json.loads(row["params"])
        curve = curve_of(params)
        assert params["curve"] == row["curve"]
        ends = curve.at(np.array([params["from"], params["to"]]))
        np.testing.assert_allclose(shapely.get_coordinates(geometry)[[0, -1]], ends, atol=1e-3)


@pytest.mark.parametrize("curve", ["line", "circle", "clothoid", "polynomial", "b-spline"])
def test_a_chosen_curve_is_used_for_every_line(curve):
    lines = ClusteredStreet().paint(0, 120, 0.0, kind="centre").paint(0, 120, 4.5, kind="edge").lines(MarkingLineSettings(curve=curve))
    assert told(lines, "curve") == [(curve,)] * 2
    assert all((row["radius_m"] is not None) == (curve == "circle") for row in lines.rows)


def test_where_the_chosen_curve_cannot_be_the_user_is_told():
    heard = Heard()
    lines = ClusteredStreet().paint(0, 50, 0.0, kind="centre").lines(MarkingLineSettings(curve="ellipse"), heard)
    assert told(lines, "curve") == [("circle",)]
    assert heard.warned == ["1 of 1 lines cannot take the curve “ellipse”; the automatic curve was used for them."]


def test_lines_that_are_written_as_a_layer_and_read_again_lie_at_the_same_stations_and_offsets():
    street = ClusteredStreet().paint(0, 120, 4.0, kind="edge").dashes(3.0, 6.0, 0.0, missing=(4, 5))
    lines = street.painted_lines()
    again = PaintedLines.from_features(lines.to_features(street.frame), street.frame)
    for name in ("line", "kind", "pattern", "status"):
        np.testing.assert_array_equal(getattr(again, name), getattr(lines, name))
    for name in ("road", "start", "s", "d", "z"):
        np.testing.assert_array_equal(getattr(again.course, name), getattr(lines.course, name))
    with pytest.raises(ValueError, match="no fitted curves"):
        again.to_features(street.frame)


def test_three_worn_pieces_between_solid_stretches_are_no_dashes_though_they_lie_evenly():
    street = ClusteredStreet().paint(0, 40, 3.5, kind="edge").paint(80, 120, 3.5, kind="edge")
    for first, last in ((46.0, 47.0), (53.6, 55.9), (61.5, 64.4)):
        street.paint(first, last, 3.5, kind="edge")
    assert {row["pattern"] for row in street.lines().rows} == {"solid"}


def test_a_road_without_painted_lines_has_none():
    assert len(zebra(ClusteredStreet(), 50.0).lines()) == 0


def test_points_that_were_not_clustered_are_refused():
    street = ClusteredStreet()
    points = RoadPoints.empty_like(origin=street.frame.origin)
    with pytest.raises(RoadExtractionError, match="Cluster markings"):
        fit_marking_lines(points, MarkingObjects.from_features(Features("PolygonZ", MARKINGS), street.frame), street.frame)


def test_settings_out_of_range_are_refused():
    for wrong in (dict(curve="sinusoid"), dict(degree=12), dict(max_gap=40.0)):
        with pytest.raises(RoadExtractionError):
            MarkingLineSettings(**wrong)
