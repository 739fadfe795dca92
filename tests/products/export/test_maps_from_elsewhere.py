"""Maps of other programs come in and leave again with their borders where they were, or their fault is named."""

import time

import numpy as np
import pytest
import shapely
from exported_maps import as_lanelets, as_roads
from lanewright.core.common.progress import Progress
from lanewright.core.driving.layers import Lanes
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.lanelet_map import layers_of_lanelets, node_places
from lanewright.products.export.opendrive import geometry as fits
from lanewright.products.export.opendrive.exporter import draft_opendrive
from lanewright.products.export.opendrive.geometry import LineBundle, fit_cubics
from lanewright.products.export.opendrive.model import shape_height
from lanewright.products.export.opendrive.reference_line import fit_reference
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, read_opendrive
from lanewright.products.export.shared_borders import with_inferred_ways, with_shared_borders
from lanewright.products.export.sources import RoadMapSource, border_misses, checked
from map_files import geometry, lane, opendrive, road, street_section, written

TOLERANCE = 0.02   # m
MIDDLE = f'<center>{lane(0, "none", mark="broken")}</center>'


def section(s=0, left="", right=""):
    """A lane section of lanes."""
    return f'<laneSection s="{s}"><left>{left}</left>{MIDDLE}<right>{right}</right></laneSection>'


def widths(*rows):
    return "".join(f'<width sOffset="{s}" a="{a}" b="{b}" c="{c}" d="{d}"/>' for s, a, b, c, d in rows)


ARC, SPIRAL = '<arc curvature="0.04"/>', '<spiral curvStart="0" curvEnd="0.04"/>'
POLYNOMIAL = '<paramPoly3 pRange="normalized" aU="0" bU="40" cU="0" dU="0" aV="0" bV="0" cV="3" dV="-1"/>'
GROWING = widths((0, 0, 0, 0.0105, -0.00021))   # from 0 to 5.6 m along 40 m
LINE = geometry(0, 0, 0, 0, 40)
MAPS = {
    "a street": road(LINE, 40),
    "a lane that begins at width 0": road(LINE, 40, lanes=section(left=lane(1), right=lane(-1) + lane(-2, widths=GROWING))),
    "a lane that is 0 wide for a while": road(LINE, 40, lanes=section(
        right=lane(-1) + lane(-2, widths=widths((0, 0, 0, 0, 0), (20, 0, 0.175, 0, 0), (40, 3.5, 0, 0, 0))))),
    "lanes that begin and end in a point": road(LINE, 40, lanes=section(right=lane(-1, widths=widths((0, 0, 0.2, -0.005, 0))))),
    "a section of 0.1 m": road(LINE, 40, lanes=street_section() + street_section(20.0) + street_section(20.1)),
    "sections of 1 mm": road(LINE, 40, lanes=street_section() + street_section(20.0) + street_section(20.001) + street_section(39.9995)),
    "a spiral": road(geometry(0, 0, 0, 0, 40, SPIRAL), 40),
    "a line, and an arc without a spiral": road(geometry(0, -30, 0, 0, 30) + geometry(30, 0, 0, 0, 25, ARC), 55),
    "a parametric cubic": road(geometry(0, 0, 0, 0, 40.14, POLYNOMIAL), 40.14),
    "a superelevation": road(LINE, 40, lateral='<superelevation s="0" a="0.05" b="0.001" c="0" d="0"/>'),
    "lane 0 beside the line": road(LINE, 40, lanes='<laneOffset s="0" a="1.5" b="0" c="0.003" d="-0.00005"/>' + street_section()),
    "records without order": road(
        geometry(20, 20, 0, 0, 20) + geometry(0, 0, 0, 0, 20), 40, profile='<elevation s="20" a="1" b="0.1" c="0" d="0"/>'
        '<elevation s="0" a="1" b="0" c="0" d="0"/>', lanes=street_section(20) + street_section(0)),
    "a median of 0.3 m": road(LINE, 40, lanes=section(right=lane(-1) + lane(-2, "none", 0.3) + lane(-3))),
    "a border of 0.3 m": road(LINE, 40, lanes=section(right=lane(-1) + lane(-2, "border", 0.3))),
    "left-hand traffic": road(LINE, 40, rule="LHT"),
    "links to roads that are not there": road(LINE, 40, link='<predecessor elementType="road" elementId="77" contactPoint="end"/>'
                                              '<successor elementType="junction" elementId="88"/>', lanes=street_section(
                                                  0, ('<predecessor id="1"/><successor id="1"/>', '<predecessor id="-1"/><successor id="-1"/>'))),
    "a road of a junction with a shoulder": road(geometry(0, 0, 0, 0, 25, ARC), 25, junction="9", lanes=section(
        right=lane(-1) + lane(-2, "shoulder", 1.0))) + road(geometry(0, -40, 0, 0, 40), 40, "2"),
    "roads at one place": road(LINE, 40) + road(geometry(0, 0, 0, 0, 40), 40, "2"),
    "a road without length beside another": road(geometry(0, 0, 0, 0, 0), 0, "7") + road(LINE, 40),
    "a border with a corner between vertices far apart": road(LINE, 40, lanes=section(right=lane(-1) + lane(-2, "shoulder", widths=widths(
        (0, 2, 0, 0, 0), (10.3, 2, 1.7, 0, 0), (12.3, 5.4, 0, 0, 0))))),
    "a width that steps on a curve": road(geometry(0, 0, 0, 0, 40, '<arc curvature="0.01"/>'), 40, lanes=section(
        left=lane(1, widths=widths((0, 3, 0, 0, 0), (25, 5, 0, 0, 0))), right=lane(-1))),
    "heights that step on a curve": road(geometry(0, 0, 0, 0, 40, '<arc curvature="-0.03"/>'), 40, profile=(
        '<elevation s="0" a="0" b="0" c="0" d="0"/><elevation s="13.5" a="0.25" b="0" c="0" d="0"/>')),
    "a slope that begins at once": road(LINE, 40, profile=(
        '<elevation s="0" a="0" b="0" c="0" d="0"/><elevation s="13.3" a="0" b="0.2" c="0" d="0"/>')),
    "lane 0 that leads aside at once": road(LINE, 40, lanes='<laneOffset s="0" a="0" b="0" c="0" d="0"/><laneOffset s="10" a="0" b="0.3" c="0" '
                                            'd="0"/><laneOffset s="20" a="3" b="0" c="0" d="0"/>' + section(right=lane(-1))),
    "gaps and kinks of a reference line": road(geometry(0, 0, 0, 0, 20) + geometry(20, 20.004, 0.004, 0.004, 20), 40),
}


def taken_in(folder, text):
    """Layers of a file, and its lanes as they are read from the layer of areas."""
    found = layers_of_opendrive(read_opendrive(written(folder, opendrive(text if isinstance(text, list) else [text]))), "EPSG:25832")
    return found, Lanes.from_features(found.lane_areas())


def given_out(folder, lanes):
    """Lanes of the maps that are written of others: OpenDRIVE, Lanelet2."""
    source = with_shared_borders(with_inferred_ways(checked(RoadMapSource(lanes))))
    return layers_of_opendrive(as_roads(folder, source)[1]).lanes, layers_of_lanelets(as_lanelets(folder, source)[1], source.lanes.crs).lanes


def apart(lanes, others):
    """Largest metres of the vertices of lanes from the borders of others, in plan."""
    lines = [shapely.linestrings(border[:, :2]) for k in range(len(others)) for border in others.borders(k)]
    places = shapely.points(np.concatenate([lanes.left, lanes.right])[:, :2])
    return float(shapely.STRtree(lines).query_nearest(places, return_distance=True, all_matches=False)[1].max())


@pytest.mark.parametrize("what", MAPS)
def test_borders_of_a_map_from_elsewhere_come_out_where_they_came_in(tmp_path, what):
    found, lanes = taken_in(tmp_path, MAPS[what])
    np.testing.assert_array_equal(lanes.left, found.lanes.left)
    np.testing.assert_array_equal(lanes.right, found.lanes.right)
    for others in given_out(tmp_path, lanes):
        assert apart(lanes, others) < TOLERANCE and apart(others, lanes) < TOLERANCE
        assert border_misses(lanes, others)[1].largest < TOLERANCE


@pytest.mark.parametrize("what, places", [("heights that step on a curve", ((13.4, 0.0), (13.6, 0.25))), ("a slope that begins at once", (
    (13.2, 0.0), (13.4, 0.02)))])
def test_heights_are_those_of_the_map_right_before_and_after_a_step(tmp_path, what, places):
    _, lanes = taken_in(tmp_path, MAPS[what])
    for others in (lanes, *given_out(tmp_path, lanes)):
        middle = min((border for k in range(len(others)) for border in others.borders(k)), key=lambda border: np.hypot(*border[0, :2]))   # lane 0
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(middle[:, :2], axis=0).T)))
        for s, height in places:
            assert np.interp(s, along, middle[:, 2]) == pytest.approx(height, abs=0.01)


def test_steps_of_widths_and_heights_are_named(tmp_path):
    for what, said in (("a width that steps on a curve", "road 1, lane 1, by 2.000 m at s 25.0 m"),
                       ("heights that step on a curve", "road 1, lane 0, by 0.250 m at s 13.5 m")):
        assert said in taken_in(tmp_path, MAPS[what])[0].notes[0]


def test_roads_that_do_not_meet_in_height_are_named(tmp_path):
    links = ("", '<predecessor id="-1"/><successor id="-1"/>')
    first = road(LINE, 40, "1", lanes=street_section(0, links), link='<successor elementType="road" elementId="2" contactPoint="start"/>')
    second = road(geometry(0, 40, 0, 0, 40), 40, "2", lanes=street_section(0, links), profile='<elevation s="0" a="0.2" b="0" c="0" d="0"/>',
                  link='<predecessor elementType="road" elementId="1" contactPoint="end"/>')
    _, lanes = taken_in(tmp_path, [first, second])
    note, = with_shared_borders(checked(RoadMapSource(lanes))).notes
    assert "moved by up to 0.10 m" in note and "near x 40.0, y 0.0" in note


def test_a_miss_between_the_vertices_of_a_border_is_seen_with_its_place_and_what_lies_beyond_its_end_is_not():
    ours, theirs = (Lanes.of_pieces([dict(left=np.array(left), right=np.array(right))]) for left, right in (
        ([[0.0, 0, 0], [10, 0, 0]], [[0.0, -3, 0], [10, -3, 0]]),
        ([[-1.0, 0, 0], [5, 0.05, 0], [12, 0, 0]], [[-1.0, -3, 0], [5, -3, 0], [12, -3, 0]])))
    across, _ = border_misses(ours, theirs)
    assert across.largest == pytest.approx(0.05) and across.worst == pytest.approx([5.0, 0.05, 0.0])


def test_a_lane_that_begins_at_width_0_keeps_both_of_its_borders(tmp_path):
    _, lanes = taken_in(tmp_path, MAPS["a lane that begins at width 0"])
    left, right = lanes.borders(list(lanes.lane_id).index("1.-2.0"))
    np.testing.assert_allclose(left[:, 1], -3.5, atol=1e-9)
    np.testing.assert_allclose(right[[0, -1], 1], [-3.5, -3.5 - 0.0105 * 1600 + 0.00021 * 64000], atol=1e-9)


def test_on_a_spiral_borders_lie_beside_the_integral_of_its_heading(tmp_path):
    _, lanes = taken_in(tmp_path, MAPS["a spiral"])
    u = (np.arange(4000) + 0.5) / 100
    heading = 0.04 * u**2 / 80
    place = np.array([np.cos(heading).sum(), np.sin(heading).sum()]) / 100 + 3.5 * np.array([np.sin(0.8), -np.cos(0.8)])
    np.testing.assert_allclose(lanes.borders(list(lanes.lane_id).index("1.-1.0"))[1][-1, :2], place, atol=1e-4)


def test_lanes_lead_on_over_a_section_too_short_to_be_shown(tmp_path):
    both = ('<predecessor id="1"/><successor id="1"/>', '<predecessor id="-1"/><successor id="-1"/>')
    sections = street_section(0, both) + street_section(20, both) + street_section(20.001, both)
    found, _ = taken_in(tmp_path, road(LINE, 40, lanes=sections))
    assert dict(zip(found.lanes.lane_id, found.lanes.successors)) == {"1.-1.0": ("1.-1.2",), "1.-1.2": (), "1.1.2": ("1.1.0",), "1.1.0": ()}


def test_a_direct_junction_leads_from_road_to_road(tmp_path):
    links = ("", '<predecessor id="-1"/><successor id="-1"/>')
    first = road(LINE, 40, "1", lanes=street_section(0, links), link='<successor elementType="junction" elementId="9"/>')
    second = road(geometry(0, 40, 0, 0, 40), 40, "2", lanes=street_section(0, links), link='<predecessor elementType="junction" elementId="9"/>')
    junction = ('<junction id="9" type="direct"><connection id="0" incomingRoad="1" linkedRoad="2" contactPoint="start">'
                '<laneLink from="-1" to="-1"/></connection></junction>')
    lanes = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive([first, second], junction)))).lanes
    assert dict(zip(lanes.lane_id, lanes.successors))["1.-1.0"] == ("2.-1.0",)


@pytest.mark.parametrize("kind, inner, outer, expected", [("curb", 0, 0.12, 0.12), ("sidewalk", 0.1, 0.15, 0.1), ("sidewalk", 0, 0, None)])
def test_the_heights_of_lanes_are_the_heights_of_curbs(tmp_path, kind, inner, outer, expected):
    raised = lane(-2, kind, 1.5, "none", more=f'<height sOffset="0" inner="{inner}" outer="{outer}"/>')
    found, _ = taken_in(tmp_path, road(LINE, 40, lanes=section(right=lane(-1) + raised)))
    edges = found.road_edges
    assert edges.rows[0]["height_m"] == (expected if expected is None else pytest.approx(expected))
    np.testing.assert_allclose(shapely.get_coordinates(edges.geometries[0], include_z=True)[:, 2], 0.0, atol=1e-12)   # its foot


def test_a_border_that_folds_back_in_a_tight_curve_is_cut_and_named(tmp_path):
    found, lanes = taken_in(tmp_path, road(geometry(0, -20, 0, 0, 20) + geometry(20, 0, 0, 0, 3.0, '<arc curvature="-0.4"/>') + geometry(
        23, 2.5 * np.sin(1.2), 2.5 * np.cos(1.2) - 2.5, -1.2, 20), 43, id="5"))
    assert "road 5, lane -1, near x" in found.notes[0] and "fold back" in found.notes[0]
    assert all(shapely.linestrings(border[:, :2]).is_simple for k in range(len(lanes)) for border in lanes.borders(k))
    for others in given_out(tmp_path, lanes):
        assert apart(lanes, others) < TOLERANCE


def test_a_gap_and_a_kink_of_a_reference_line_are_named(tmp_path):
    found, _ = taken_in(tmp_path, MAPS["gaps and kinks of a reference line"])
    assert "road 1, lane -2, by 0.020 m at s 20.0 m." in found.notes[0]


def test_every_road_with_a_kink_is_named_those_with_the_largest_first(tmp_path):
    kinked = [geometry(0, 0, y, 0, 20) + geometry(20, 20, y, turn, 10) + geometry(30, 20 + 10 * np.cos(turn), y + 10 * np.sin(turn), turn + 0.003, 10)
              for y, turn in ((0, 0.01), (50, 0.03))]
    found, _ = taken_in(tmp_path, [road(lines, 40, id) for lines, id in zip(kinked, ("4", "5"))])
    assert "(2 of the roads)" in found.notes[0]
    assert "road 5, lane -2, by 0.109 m at s 20.0 m and less at 1 more; road 4, lane -2, by 0.036 m at s 20.0 m and less at 1 more." in found.notes[0]


def test_a_curb_between_lanes_keeps_its_bottom_and_its_top(tmp_path):
    raised = '<height sOffset="0" inner="0.12" outer="0.12"/>'
    lanes = section(left=lane(1), right=lane(-1) + lane(-2, "biking", 1.5, more=raised) + lane(-3, "shoulder", 1.0))
    _, lanes = taken_in(tmp_path, road(LINE, 40, lanes=lanes, profile='<elevation s="0" a="5" b="0.01" c="0" d="0"/>'))
    for others in given_out(tmp_path, lanes):
        assert len(others) == 4
        for kind, level in (("driving", 5.0), ("bicycle", 5.12), ("shoulder", 5.0)):
            for k in np.flatnonzero(others.type == kind):
                for border in others.borders(k):
                    x = border[:, 0] - lanes.left[:, 0].min()
                    np.testing.assert_allclose(border[:, 2], level + 0.01 * x, atol=0.002)


def test_a_kink_of_a_reference_line_makes_no_node_twice(tmp_path):
    _, lanes = taken_in(tmp_path, road(geometry(0, 0, 0, 0, 20) + geometry(20, 20, 0, 0.0002, 20), 40))
    assert "repeated node" not in _checked_lanelets(tmp_path, lanes)


def test_a_curb_between_lanelets_is_no_border_twice(tmp_path):
    lanes = section(right=lane(-1) + lane(-2, "biking", 1.5, more='<height sOffset="0" inner="0.12" outer="0.12"/>'))
    _, lanes = taken_in(tmp_path, road(LINE, 40, lanes=lanes))
    assert "border twice" not in _checked_lanelets(tmp_path, lanes)


def _checked_lanelets(folder, lanes):
    """What the check counts in the Lanelet2 map of two lanes."""
    _, whole = as_lanelets(folder, with_shared_borders(checked(RoadMapSource(lanes))))
    assert len(whole.lanelets) == 2
    return check_lanelets(whole, *node_places(whole, lanes.crs)).counts()


def test_the_work_for_heights_and_widths_grows_with_their_length():
    """Widths with jumps need hundreds of pieces, shapes hundreds of cross-sections."""
    s = np.linspace(0.0, 300.0, 1200)
    start = time.process_time()
    fit_cubics([LineBundle([s] * 3, [np.floor(s / 3.0) % 2] * 3, 0.0, 300.0, 0.01)])
    shape = np.array([[at, t, 0.1 * t, 0.0, 0.0, 0.0] for at in s for t in (-3.5, 0.0, 3.5)])
    for _ in range(100):
        np.testing.assert_allclose(shape_height(shape, s, np.full(len(s), 3.5)), 0.35)
    assert time.process_time() - start < 3.0


def test_a_width_below_0_is_taken_as_0_and_named(tmp_path):
    found, lanes = taken_in(tmp_path, road(LINE, 40, lanes=section(right=lane(-1) + lane(-2, widths=widths((0, 1, -0.05, 0, 0))))))
    assert "lane -2 of road 1 with -1.00 m at s 40.0 m" in found.notes[0]
    for others in given_out(tmp_path, lanes):
        assert apart(lanes, others) < TOLERANCE


@pytest.mark.parametrize("broken, said", [
    (road("", 40, "8"), "road 8 cannot be read: it has no geometry"),
    (road(geometry(0, "nan", 0, 0, 40), 40, "8"), "road 8 cannot be read: Line 2: x of <geometry> is 'nan'"),
    (road(geometry(0, 0, 0, 0, 40, "<spiral/>"), 40, "8"), "road 8 cannot be read: Line 2: <spiral> has no curvStart"),
    (road(LINE, 40, "8", lanes=section(right=lane(-1, width="inf"))), "road 8 cannot be read: Line 2: a of <width> is 'inf'")])
def test_a_road_that_is_broken_is_named_and_the_others_are_read(tmp_path, broken, said):
    found, lanes = taken_in(tmp_path, broken + road(LINE, 40))
    assert said in found.notes[0] and set(lanes.road) == {1}


def test_ways_of_a_map_from_elsewhere_are_all_that_there_are(tmp_path):
    arms = "".join(road(geometry(0, x, y, heading, 30), 30, id, lanes=street_section(0, ("", '<successor id="-1"/>')),
                        link='<successor elementType="junction" elementId="9"/>')
                   for id, x, y, heading in (("1", -40, 0, 0), ("2", 0, 40, -np.pi / 2)))
    ways = "".join(road(geometry(0, x, y, heading, 20), 20, id, junction="9", lanes=section(right=lane(-1, link='<successor id="-1"/>')),
                        link=f'<successor elementType="road" elementId="{out}" contactPoint="start"/>')
                   for id, x, y, heading, out in (("3", -10, 0, 0, "5"), ("4", 0, 10, -np.pi / 2, "6")))
    outs = "".join(road(geometry(0, x, y, heading, 30), 30, id) for id, x, y, heading in (("5", 10, 0, 0), ("6", 0, -10, -np.pi / 2)))
    junction = "".join(f'<connection id="{way}" incomingRoad="{arm}" connectingRoad="{way}" contactPoint="start"><laneLink from="-1" to="-1"/>'
                       '</connection>' for arm, way in (("1", "3"), ("2", "4")))
    text = opendrive([arms, ways, outs], f'<junction id="9">{junction}</junction>')
    lanes = layers_of_opendrive(read_opendrive(written(tmp_path, text)), "EPSG:25832").lanes
    assert len(with_inferred_ways(checked(RoadMapSource(lanes))).lanes) == len(lanes)


def test_the_steps_of_an_export_do_not_grow_with_the_number_of_roads(tmp_path, monkeypatch):
    """What is fitted, is fitted for all roads at once: a map of many short roads would take many times as long as its import."""
    steps = []
    for solve, name in ((np.linalg, "solve"), (fits, "solve_banded")):
        monkeypatch.setattr(solve, name, lambda *given, compute=getattr(solve, name): steps.append(given) or compute(*given))
    counts = []
    for count in (1, 12):
        _, lanes = taken_in(tmp_path, "".join(road(geometry(0, 0, 20 * k, 0, 40, SPIRAL), 40, str(k), lanes=section(
            left=lane(1), right=lane(-1, widths=GROWING))) for k in range(count)))
        steps.clear()
        draft_opendrive(with_shared_borders(checked(RoadMapSource(lanes))))
        counts.append(len(steps))
    assert counts[0] == counts[1] > 2


def test_an_export_that_takes_longer_since_borders_have_corners_says_so(tmp_path):
    """As maps do whose reference lines are made of chords, with a kink at the end of each."""
    turns, places = np.tile([0.2, -0.2], 5), [(0.0, 0.0)]
    for turn in turns:
        places.append((places[-1][0] + 4 * np.cos(turn), places[-1][1] + 4 * np.sin(turn)))
    kinked = road("".join(geometry(4 * k, *places[k], turn, 4) for k, turn in enumerate(turns)), 40)
    for roads, said in ((kinked + road(geometry(0, 0, 50, 0, 40), 40, "2"), "1 of 2 roads have corners"), (road(LINE, 40), "")):
        told, progress = [], Progress()
        progress.info = told.append
        draft_opendrive(with_shared_borders(checked(RoadMapSource(taken_in(tmp_path, roads)[1]))), progress=progress)
        assert said in "".join(told) and bool(told) == bool(said)


def test_a_map_without_crs_leaves_as_a_local_map(tmp_path):
    found = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive([road(LINE, 40)], reference="")))).lanes
    _, lanelets = given_out(tmp_path, found)
    assert apart(found, lanelets) < 1e-3 and lanelets.crs == ""


def test_the_work_for_a_reference_line_grows_with_its_length():
    s = np.arange(0, 2000, 0.5)
    heading = 0.8 * np.sin(s / 40)
    points = np.c_[np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading))] / 2
    start = time.process_time()
    plan = fit_reference(points, 0.01)
    assert time.process_time() - start < 8 and len(plan.elements) < 150
    turns = [(one.heading - before.end()[2] + np.pi) % (2 * np.pi) - np.pi for before, one in zip(plan.elements[:-1], plan.elements[1:])]
    assert np.abs(turns).max() < 1e-9
