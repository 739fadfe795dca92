"""Painted lines on streets made here, so that their course is known."""

import json

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import Features
from lanewright.core.common.progress import Progress
from lanewright.core.common.schemas import MARKINGS
from lanewright.core.curves.model_selection import curve_from_params
from lanewright.core.markings.lines.fit import MarkingLineSettings, fit_marking_lines
from lanewright.core.markings.lines.painted_lines import lines_from_features, lines_to_features
from lanewright.core.markings.objects.marking_objects import markings_from_features
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.trajectory.trajectory import Trajectory

RADIUS = 140.0
HALF_WIDTH = 5.0
EAST, NORTH, UP = 500000.0, 5400000.0, 30.0


class Street:
    """A left-hand bend of 140 m radius (or a straight street); paint is laid by station and offset of its axis."""

    def __init__(self, length=120.0, radius=RADIUS, weave=0.0, backwards=False, seed=1):
        self.length, self.radius = length, radius
        self.rng = np.random.default_rng(seed)
        s = np.arange(0.0, length + 0.05, 0.1)
        driven = self.place(s, weave * np.sin(s / 25.0) - 1.6)
        time = np.arange(len(s)) * 0.01
        driven = driven[::-1] if backwards else driven
        angle = np.zeros(len(s))
        self.frame = build_frame(Trajectory(time, driven[:, 0], driven[:, 1], np.full(len(s), UP + 2.0), angle, angle, angle))
        self.points, self.rows = [], []

    def drive_again(self, offset, way):
        """One more pass along the street, at an offset of the axis; `way` is -1 against the first."""
        s = np.arange(0.0, self.length + 0.05, 0.1)[::way]
        places = np.concatenate([self.place(s[::way], -1.6), self.place(s, offset)])
        time = np.concatenate([0.01 * np.arange(len(s)), 1000.0 + 0.01 * np.arange(len(s))])
        self.frame = build_frame(Trajectory(time, places[:, 0], places[:, 1], np.full(len(places), UP + 2.0)))

    def place(self, s, d):
        """(N, 2) map coordinates of stations and offsets of the axis."""
        s, d = np.broadcast_arrays(np.asarray(s, float), np.asarray(d, float))
        if not self.radius:
            return np.c_[EAST + s, NORTH + d]
        turn = s / self.radius
        return np.c_[EAST + (self.radius - d) * np.sin(turn), NORTH + self.radius - (self.radius - d) * np.cos(turn)]

    def paint(self, first, last, offset, width=0.15, kind="lane", use="keep", across=None, density=1500, noise=0.008):
        """One painted patch, its own cluster; `across` makes it reach from `offset` to there."""
        far = offset + width / 2 if across is None else across
        near = offset - width / 2 if across is None else offset
        count = int(density * (last - first) * abs(far - near)) + 20
        s = self.rng.uniform(first, last, count)
        d = self.rng.uniform(near, far, count) + self.rng.normal(0, noise, count)
        self.points.append((np.full(count, len(self.rows) + 1), s, d))
        self.rows.append({"class": kind, "use": use, "length_m": max(last - first, abs(far - near)), "width_m": width})
        return self

    def dashes(self, dash, gap, offset, first=1.0, last=None, missing=(), **kind):
        """Dashes of one line; those whose number is in `missing` are worn away."""
        starts = np.arange(first, (last or self.length) - dash + 1e-9, dash + gap)
        for k, s in enumerate(starts):
            if k not in missing:
                self.paint(s, s + dash, offset, **kind)
        return self

    def lines(self, settings=MarkingLineSettings(), progress=Progress()):
        """The layer of the marking lines found."""
        return lines_to_features(self.painted_lines(settings, progress), self.frame)

    def painted_lines(self, settings=MarkingLineSettings(), progress=Progress()):
        """The marking lines found."""
        points = RoadPoints.empty_like(origin=self.frame.origin)
        points.has_cluster = True
        cluster, s, d = (np.concatenate(parts) for parts in zip(*self.points))
        place = self.place(s, d)
        x, y = self.frame.to_local(place[:, 0], place[:, 1])
        records = np.zeros(len(s), ROAD_POINT)
        station, offset = self.frame.roads[0].locate(x, y)
        inside = np.isfinite(station)
        records["x"], records["y"] = to_units(x), to_units(y)
        records["z"] = to_units(UP + self.rng.normal(0, 0.005, len(s)) - self.frame.origin[2])
        records["time"], records["cluster"] = np.arange(len(s)) * 1e-5, cluster
        records["half_width"] = np.rint((HALF_WIDTH + np.sign(offset) * (offset - d)).clip(0, 20) * 1000)
        records = records[inside]
        records["s"], records["d"] = to_units(station[inside]), to_units(offset[inside])
        points.store.append(0, records)
        markings = Features("PolygonZ", MARKINGS)
        for k, row in enumerate(self.rows):
            mine = inside & (cluster == k + 1)
            outline = shapely.force_3d(shapely.convex_hull(shapely.multipoints(place[mine])), UP)
            markings.add(outline, road=0, cluster=k + 1, station_m=float(station[mine].min()),
                         offset_m=float(np.median(offset[mine])), **row)
        return fit_marking_lines(points, markings_from_features(markings, self.frame), self.frame, settings, progress)

    def distance(self, geometry, offset):
        """(M,) distances in plan of a drawn line's vertices to the axis' parallel."""
        x, y = shapely.get_coordinates(geometry).T
        if not self.radius:
            return np.abs(y - NORTH - offset)
        return np.abs(np.hypot(x - EAST, y - NORTH - self.radius) - (self.radius - offset))


def told(lines, *names):
    """The values of fields, one tuple a piece."""
    return [tuple(row[name] for name in names) for row in lines.rows]


def test_a_solid_line_in_a_bend_is_one_circle_on_the_paint():
    street = Street().paint(0, 120, 0.0, kind="centre")
    lines = street.lines()
    assert told(lines, "kind", "pattern", "status", "curve") == [("centre", "solid", "measured", "circle")]
    assert lines.rows[0]["radius_m"] == pytest.approx(RADIUS, rel=0.005)
    assert lines.rows[0]["width_m"] == pytest.approx(0.15, abs=0.03)
    assert lines.rows[0]["length_m"] == pytest.approx(120, abs=0.5)
    assert street.distance(lines.geometries[0], 0.0).max() < 0.01
    assert shapely.get_coordinates(lines.geometries[0], include_z=True)[:, 2] == pytest.approx(UP, abs=0.01)


def test_dashes_of_2_m_with_gaps_of_4_m_are_one_dashed_line_without_bridges():
    street = Street().dashes(2.0, 4.0, 0.0)
    lines = street.lines()
    assert told(lines, "line", "pattern", "status") == [(1, "dashed", "measured")]
    assert street.distance(lines.geometries[0], 0.0).max() < 0.02


@pytest.mark.parametrize("dash, gap", [(3.0, 6.0), (6.0, 9.0), (3.0, 9.0), (6.0, 3.0), (5.0, 5.0), (6.0, 12.0)])
def test_dashes_as_the_countries_paint_them_are_dashed_lines(dash, gap):
    assert told(Street().dashes(dash, gap, 0.0).lines(), "pattern", "status") == [("dashed", "measured")]


def test_the_dashes_of_a_cycle_lane_are_one_dashed_line():
    """A metre of paint, a metre of none."""
    lines = Street().dashes(1.0, 1.0, -2.0, width=0.12).lines()
    assert told(lines, "line", "pattern", "status") == [(1, "dashed", "measured")]
    assert lines.rows[0]["length_m"] == pytest.approx(120 * (RADIUS + 2.0) / RADIUS, abs=2.5)


def test_worn_away_dashes_are_bridged_and_flagged():
    lines = Street().dashes(3.0, 6.0, 0.0, missing=(4, 5)).lines()
    assert told(lines, "line", "status") == [(1, "measured"), (1, "bridged"), (1, "measured")]
    assert lines.rows[1]["length_m"] == pytest.approx(24.0, abs=1.0)
    assert lines.rows[1]["rmse_m"] is None
    ends = [shapely.get_coordinates(g, include_z=True)[[0, -1]] for g in lines.geometries]
    np.testing.assert_allclose(ends[0][1], ends[1][0], atol=1e-9)
    np.testing.assert_allclose(ends[1][1], ends[2][0], atol=1e-9)


def test_a_dashed_line_ends_with_its_gap_but_not_beyond_the_road_s_paint():
    """The neighbour is painted from 0 to 120 m; the dashes from 7 to 109 m, so that a gap of 6 m is left at either end."""
    street = Street().paint(0, 120, 4.0, kind="edge").dashes(3.0, 6.0, 0.0, first=7.0, last=113.0)
    dashed = [row for row in street.lines().rows if row["pattern"] == "dashed"]
    assert len(dashed) == 1
    assert dashed[0]["length_m"] == pytest.approx(109 - 7 + 6 + 6, abs=0.6)
    short = Street().paint(5, 120, 4.0, kind="edge").dashes(3.0, 6.0, 0.0, first=7.0, last=113.0)
    begun = [row for row in short.lines().rows if row["pattern"] == "dashed"]
    assert begun[0]["length_m"] == pytest.approx(109 - 5 + 6, abs=0.6)


def test_a_double_line_is_two_lines():
    street = Street().paint(0, 120, 0.15, kind="centre").paint(0, 120, -0.15, kind="centre")
    lines = street.lines()
    assert told(lines, "kind", "pattern") == [("centre", "double-solid")] * 2
    offsets = sorted((-0.15, 0.15), key=lambda o: street.distance(lines.geometries[0], o).max())
    for geometry, offset in zip(lines.geometries, offsets):
        assert street.distance(geometry, offset).max() < 0.01


@pytest.mark.parametrize("worn_from", [19, 15.6])
def test_between_two_junctions_a_short_double_line_keeps_both_its_lines_though_only_one_is_linked_with_what_follows(worn_from):
    street = Street().paint(0, 120, 4.0, kind="edge").paint(10, 19, 0.0, kind="centre").paint(45, 110, 0.0, kind="centre")
    lines = street.paint(10, worn_from, 0.31, kind="centre").paint(64, 110, 0.31, kind="centre").lines()
    assert len({row["line"] for row in lines.rows if row["station_m"] < 15 and row["kind"] == "centre"}) == 2
    frayed = Street().paint(10, 110, 0.0, kind="centre").paint(30, 39, 0.31, kind="centre").lines()
    assert len({row["line"] for row in frayed.rows}) == 1


def test_a_double_line_clustered_as_one_stays_two():
    street = Street()
    street.paint(0, 120, 0.15, kind="hatch", use="other")
    street.paint(0, 120, -0.15)
    street.rows.pop()
    street.points[1] = (np.ones_like(street.points[1][0]), *street.points[1][1:])
    assert told(street.lines(), "kind", "pattern") == [("centre", "double-solid")] * 2


def zebra(street, s):
    for offset in np.arange(-4.0, 4.1, 1.0):
        street.paint(s, s + 4.0, offset, width=0.5, kind="zebra", use="other")
    return street


def test_a_zebra_crossing_neither_cuts_a_line_nor_makes_one():
    street = zebra(Street().paint(0, 55, 0.0, kind="centre").paint(65, 120, 0.0, kind="centre"), 58.0)
    lines = street.lines()
    assert told(lines, "line", "status") == [(1, "measured"), (1, "bridged"), (1, "measured")]
    assert street.distance(shapely.union_all(lines.geometries), 0.0).max() < 0.015


def test_the_frame_of_a_hatched_area_is_no_line_and_an_edge_line_beside_one_is():
    street = Street().paint(0, 120, -4.0, kind="edge")
    street.paint(40, 62, 1.0).paint(40, 62, 2.6, kind="centre")
    for s in np.arange(41, 61, 1.5):
        street.paint(s, s + 0.4, 1.15, across=2.45, kind="hatch", use="other")
        street.paint(s, s + 0.4, -3.85, across=-2.9, kind="hatch", use="other")
    lines = street.lines()
    assert told(lines, "kind", "status") == [("edge", "measured")]
    assert street.distance(lines.geometries[0], -4.0).max() < 0.02


def test_a_double_line_that_leads_up_to_a_hatched_area_keeps_both_its_lines_and_goes_on_behind_the_area():
    street = Street(130.0).paint(0, 130, 4.0, kind="edge")
    for left in (0.0, 0.31):
        street.paint(10, 20, left, width=0.12, kind="centre").paint(46, 110, left, width=0.12, kind="centre")
    for s in np.arange(22.0, 43.5, 0.5):
        wide = 0.8 * np.sin(np.pi * (s - 20.5) / 25.0)
        street.paint(s, s + 0.52, 0.31 + wide, width=0.12, kind="centre").paint(s, s + 0.52, -wide, width=0.12, kind="centre")
    for s in np.arange(22.3, 43.5, 1.5):
        wide = 0.8 * np.sin(np.pi * (s - 20.5) / 25.0)
        street.paint(s, s + 0.4, 0.05 - wide, across=0.26 + wide, kind="hatch", use="other")
    lines = street.lines()
    centre = [(geometry, row) for geometry, row in lines if row["kind"] == "centre"]
    assert sorted((row["status"], round(row["station_m"], -1)) for _, row in centre) == [
        ("bridged", 20.0), ("bridged", 20.0), ("measured", 10.0), ("measured", 10.0), ("measured", 50.0), ("measured", 50.0)]
    for geometry, _ in centre:
        assert min(street.distance(geometry, left).max() for left in (0.0, 0.31)) < 0.05


def test_the_stop_line_that_touches_an_edge_line_leaves_the_edge_line_straight():
    street = Street().paint(0, 80, -4.0, kind="hatch", use="other")
    number = len(street.rows)
    street.paint(79.7, 80.0, -4.0, across=0.0)
    street.rows.pop()
    street.points[-1] = (np.full_like(street.points[-1][0], number), *street.points[-1][1:])
    lines = street.lines()
    assert len(lines) == 1
    assert street.distance(lines.geometries[0], -4.0).max() < 0.02
    assert lines.rows[0]["length_m"] == pytest.approx(80 * 144 / 140, abs=3.0)


def test_specks_and_gutter_pieces_are_no_lines():
    street = Street().paint(0, 120, 4.0, kind="edge")
    street.paint(30, 31.5, 1.0).paint(60, 63, 4.6, kind="edge").paint(64, 66, 4.7, kind="edge").paint(90, 91.2, -2.0)
    assert told(street.lines(), "kind", "line") == [("edge", 1)]


def test_a_bright_strip_of_verge_beside_the_edge_line_is_no_second_line():
    street = Street().paint(0, 120, 4.0, kind="edge").paint(40, 58, 4.5, kind="edge")
    assert told(street.lines(), "kind", "pattern", "line") == [("edge", "solid", 1)]


def test_the_outer_line_of_a_lay_by_is_a_line():
    street = Street().paint(0, 120, 2.0, kind="edge").paint(40, 80, 4.7, kind="edge")
    assert sorted(told(street.lines(), "line", "status")) == [(1, "measured"), (2, "measured")]


def test_lines_3_m_apart_are_never_linked_across():
    lines = Street().paint(0, 50, 1.5, kind="centre").paint(52, 120, -1.5, kind="centre").lines()
    assert sorted(told(lines, "line", "status")) == [(1, "measured"), (2, "measured")]


def test_a_turning_lane_s_line_begins_beside_the_line_that_runs_on():
    street = Street().dashes(3.0, 6.0, 1.5).paint(70, 110, -1.8, kind="centre").paint(0, 120, 4.5, kind="edge")
    lines = street.lines()
    assert sorted(set(told(lines, "line", "pattern"))) == [(1, "solid"), (2, "dashed"), (3, "solid")]
    assert lines.rows[-1]["station_m"] == pytest.approx(70.0, abs=1.0)


def test_a_dashed_line_that_becomes_solid_is_cut_where_it_changes():
    lines = Street().dashes(3.0, 6.0, 0.0, last=76.0).paint(79, 115, 0.0, kind="centre").lines()
    assert told(lines, "line", "pattern") == [(1, "dashed"), (1, "solid")]
    assert lines.rows[1]["length_m"] == pytest.approx(36.0, abs=0.7)


def test_the_dashed_part_of_a_centre_line_is_centre_line_too():
    """Beyond a junction, 35 m on, the only line between the edges goes on solid."""
    street = Street(length=200.0).dashes(5.0, 5.0, 0.0, last=90.0).paint(125, 200, 0.0, kind="centre")
    assert set(told(street.lines(), "line", "kind", "pattern")) == {(1, "centre", "dashed"), (2, "centre", "solid")}


def test_dashes_alone_between_two_curbs_are_the_centre_line():
    assert told(Street().dashes(3.0, 6.0, 0.2).lines(), "kind") == [("centre",)]


def test_dashes_alone_that_leave_no_lane_beyond_are_no_centre_line():
    assert "centre" not in told(Street().dashes(3.0, 6.0, 3.2).lines(), "kind")[0]


@pytest.mark.parametrize("way, kind", [(1, "lane"), (-1, "centre")])
def test_dashes_between_edge_lines_part_lanes_of_one_direction_where_it_was_driven_on_both_sides(way, kind):
    street = Street().dashes(3.0, 6.0, 0.0).paint(0, 120, 3.5, kind="edge").paint(0, 120, -3.5, kind="edge")
    street.drive_again(1.8, way)
    assert sorted(told(street.lines(), "kind")) == sorted([("edge",), ("edge",), (kind,)])


@pytest.mark.parametrize("way, kind", [(1, "lane"), (-1, "centre")])
def test_dashes_alone_part_the_directions_unless_one_of_them_was_driven_on_both_sides(way, kind):
    street = Street().dashes(3.0, 6.0, 0.0)
    street.drive_again(1.8, way)
    assert told(street.lines(), "kind") == [(kind,)]


def test_two_solid_lines_with_two_lanes_between_are_edge_lines_however_wide_the_verge(monkeypatch):
    """The verge is smooth, so that the carriageway seems to go on for metres beyond either line."""
    monkeypatch.setitem(globals(), "HALF_WIDTH", 9.0)
    outer = Street().paint(0, 120, 2.8, kind="centre").paint(0, 120, -2.8, kind="centre")
    assert told(outer.lines(), "kind") == [("edge",)] * 2


def test_solid_lane_lines_beside_a_double_line_are_no_centre_lines(monkeypatch):
    monkeypatch.setitem(globals(), "HALF_WIDTH", 7.0)
    street = Street().paint(0, 120, 0.15, kind="centre").paint(0, 120, -0.15, kind="centre")
    street.paint(80, 110, -3.4, kind="centre")
    assert sorted(line for line in told(street.lines(), "kind", "pattern") if line[0] == "centre") == [("centre", "double-solid")] * 2


def test_dashes_behind_a_double_line_part_the_directions_as_it_did(monkeypatch):
    """Up to a crossing the centre line is double, behind it there are dashes: first alone, then with a turning lane beside."""
    monkeypatch.setitem(globals(), "HALF_WIDTH", 7.0)
    street = Street().paint(0, 40, 0.15, kind="centre").paint(0, 40, -0.15, kind="centre")
    street.dashes(4.0, 6.0, 0.0, first=50.0, last=120.0).dashes(4.0, 6.0, -3.2, first=70.0, last=120.0)
    assert sorted(set(told(street.lines(), "kind", "pattern"))) == [("centre", "dashed"), ("centre", "double-solid"), ("lane", "dashed")]
    beside = Street().paint(0, 40, 0.15, kind="centre").paint(0, 40, -0.15, kind="centre").dashes(4.0, 6.0, 3.2, first=50.0, last=120.0)
    assert ("lane", "dashed") in told(beside.lines(), "kind", "pattern")


def test_a_worn_solid_line_is_not_called_dashed():
    street = Street(length=200.0, seed=5)
    for first, last in ((0, 14), (14.9, 22), (24, 31), (32.2, 38), (43, 46), (47.5, 56), (58.1, 75), (77, 83), (84, 90),
                        (93.4, 110), (111, 113), (114, 131), (139, 148), (149, 150.6), (152, 200)):
        street.paint(first, last, -4.0, kind="edge")
    assert {row["pattern"] for row in street.lines().rows} == {"solid"}


def test_three_pieces_of_unlike_lengths_are_no_dashed_line():
    street = Street()
    for first, length in ((20.0, 2.1), (29.0, 3.2), (40.0, 1.9)):
        street.paint(first, first + length, 0.0)
    assert set(told(street.lines(), "pattern")) == {("solid",)}


def test_three_even_dashes_are_a_dashed_line_though_one_has_lost_its_end():
    street = Street()
    for first, last in ((20.0, 23.0), (29.0, 32.0), (38.0, 39.9)):
        street.paint(first, last, 0.0)
    assert told(street.lines(), "pattern", "status") == [("dashed", "measured")]


def test_a_weaving_drive_does_not_bend_the_line():
    """The vehicle weaves by half a metre; the dashes are linked and lie on the axis all the same."""
    street = Street(weave=0.5).dashes(3.0, 9.0, 0.0).paint(0, 120, 4.5, kind="edge")
    lines = street.lines()
    assert sorted(told(lines, "kind", "status")) == [("centre", "measured"), ("edge", "measured")]
    lane = lines.geometries[[row["kind"] for row in lines.rows].index("centre")]
    assert street.distance(lane, 0.0).max() < 0.025


def test_driving_backwards_gives_the_same_lines():
    found = []
    for backwards in (False, True):
        street = Street(backwards=backwards).dashes(3.0, 6.0, 0.0).paint(0, 120, 4.5, kind="edge")
        found.append(street.lines())
    for pattern in ("dashed", "solid"):
        there, back = (shapely.union_all([g for g, row in lines if row["pattern"] == pattern]) for lines in found)
        assert there.length == pytest.approx(back.length, abs=1.0)
        assert np.median(shapely.distance(shapely.points(shapely.get_coordinates(there)), back)) < 0.005


def test_the_side_a_line_is_on_changes_nothing_but_its_side():
    here = Street(radius=0).dashes(3.0, 6.0, 1.5).lines()
    there = Street(radius=0).dashes(3.0, 6.0, -2.5).lines()
    assert told(here, "kind", "pattern", "status", "curve") == told(there, "kind", "pattern", "status", "curve")
    assert here.rows[0]["offset_m"] - there.rows[0]["offset_m"] == pytest.approx(4.0, abs=0.01)
    assert here.rows[0]["length_m"] == pytest.approx(there.rows[0]["length_m"], abs=0.1)


def test_the_order_of_the_points_and_the_sections_change_nothing():
    whole = Street().dashes(3.0, 6.0, 0.0).paint(0, 120, 4.5, kind="edge")
    shuffled = Street().dashes(3.0, 6.0, 0.0).paint(0, 120, 4.5, kind="edge")
    order = shuffled.rng.permutation(len(shuffled.points))
    shuffled.rng = whole.rng.__class__(np.random.PCG64(9))
    whole.rng = whole.rng.__class__(np.random.PCG64(9))
    shuffled.points = [shuffled.points[k] for k in order]
    for a, b in zip(whole.lines(), shuffled.lines()):
        np.testing.assert_allclose(shapely.get_coordinates(a[0]), shapely.get_coordinates(b[0]), atol=1e-9)
        assert {k: v for k, v in a[1].items()} == {k: v for k, v in b[1].items()}


def test_every_piece_lies_on_the_curve_that_its_params_tell():
    street = Street().dashes(3.0, 6.0, 0.0, missing=(4, 5)).paint(0, 120, 4.5, kind="edge")
    for geometry, row in street.lines():
        params = json.loads(row["params"])
        curve = curve_from_params(params)
        assert params["curve"] == row["curve"]
        ends = curve.at(np.array([params["from"], params["to"]]))
        np.testing.assert_allclose(shapely.get_coordinates(geometry)[[0, -1]], ends, atol=1e-3)


@pytest.mark.parametrize("curve", ["line", "circle", "clothoid", "polynomial", "b-spline"])
def test_a_chosen_curve_is_used_for_every_line(curve):
    lines = Street().paint(0, 120, 0.0, kind="centre").paint(0, 120, 4.5, kind="edge").lines(MarkingLineSettings(curve=curve))
    assert told(lines, "curve") == [(curve,)] * 2
    assert all((row["radius_m"] is not None) == (curve == "circle") for row in lines.rows)


def test_where_the_chosen_curve_cannot_be_the_user_is_told():
    class Listener(Progress):
        warnings = []

        def warn(self, text):
            self.warnings.append(text)

    lines = Street().paint(0, 50, 0.0, kind="centre").lines(MarkingLineSettings(curve="ellipse"), Listener())
    assert told(lines, "curve") == [("circle",)]
    assert Listener.warnings == ["1 of 1 lines cannot take the curve “ellipse”; the automatic curve was used for them."]


def test_lines_that_are_written_as_a_layer_and_read_again_lie_at_the_same_stations_and_offsets():
    street = Street().paint(0, 120, 4.0, kind="edge").dashes(3.0, 6.0, 0.0, missing=(4, 5))
    lines = street.painted_lines()
    again = lines_from_features(lines_to_features(lines, street.frame), street.frame)
    for name in ("line", "kind", "pattern", "status"):
        np.testing.assert_array_equal(getattr(again, name), getattr(lines, name))
    for name in ("road", "start", "s", "d", "z"):
        np.testing.assert_array_equal(getattr(again.course, name), getattr(lines.course, name))
    with pytest.raises(ValueError, match="no fitted curves"):
        lines_to_features(again, street.frame)


def test_a_road_without_painted_lines_has_none():
    assert len(zebra(Street(), 50.0).lines()) == 0


def test_points_that_were_not_clustered_are_refused():
    street = Street()
    points = RoadPoints.empty_like(origin=street.frame.origin)
    with pytest.raises(RoadExtractionError, match="Cluster markings"):
        fit_marking_lines(points, markings_from_features(Features("PolygonZ", MARKINGS), street.frame), street.frame)


def test_settings_out_of_range_are_refused():
    for wrong in (dict(curve="sinusoid"), dict(degree=12), dict(max_gap=40.0)):
        with pytest.raises(RoadExtractionError):
            MarkingLineSettings(**wrong)
