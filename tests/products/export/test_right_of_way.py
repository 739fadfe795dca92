"""Who goes first at a junction is said in one format as it was in the other."""

import pytest
import shapely
from exported_maps import as_lanelets, as_roads
from lanewright.core.common.features import SIGNALS, Features
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.lanelet_map import layers_of_lanelets, node_places
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, read_opendrive
from lanewright.products.export.sources import RoadMapSource
from made_lanes import CRS, crossing
from map_files import written


def place(layers, name):
    """Where a lane begins and ends, to the metre."""
    middle = sum(layers.lanes.borders(list(layers.lanes.lane_id).index(name))) / 2
    return tuple(map(tuple, middle[[0, -1], :2].round(0)))


def waiting(layers):
    """{(lane that waits, lane that goes first)} by their places."""
    return {(place(layers, name), place(layers, first)) for name, known in layers.attributes.items()
            for first in known.get("yields_to", "").split(",") if first}


def turns(lanes):
    return [str(name) for name, kind in zip(lanes.lane_id, lanes.type) if kind == "connector"]


def test_a_way_that_waits_for_another_does_so_in_both_formats(tmp_path):
    lanes = crossing()
    low, high, other, *_ = turns(lanes)
    layers = RoadMapSource(lanes, attributes={low: {"yields_to": f"{high},{other}"}})
    _, whole = as_roads(tmp_path, layers)
    junction, = whole.junctions
    assert len(junction.priorities) == 2 and not [one for one in check_opendrive(whole).found if "riorit" in one.text]
    roads = layers_of_opendrive(whole, CRS)
    _, whole = as_lanelets(tmp_path, layers)
    assert not check_lanelets(whole, *node_places(whole, CRS)).found
    lanelets = layers_of_lanelets(whole, CRS)
    back = layers_of_opendrive(as_roads(tmp_path, lanelets)[1], CRS)
    assert len(waiting(layers)) == 2
    for read in (roads, lanelets, back):
        assert waiting(read) == waiting(layers) and not read.left_out


@pytest.mark.parametrize("by", ["connecting", "incoming"])
def test_priorities_name_ways_through_a_junction_or_the_roads_that_lead_to_them(tmp_path, by):
    _, whole = as_roads(tmp_path, RoadMapSource(crossing()))
    junction, = whole.junctions
    one = junction.connections[0]
    two = next(other for other in junction.connections if other.incoming != one.incoming)
    priority = f'<priority high="{getattr(two, by)}" low="{getattr(one, by)}"/></junction>'
    text = (tmp_path / "out.xodr").read_text(encoding="utf-8").replace("</junction>", priority)
    layers = layers_of_opendrive(read_opendrive(written(tmp_path, text)), CRS)
    roads = [{end.split(".")[0] for end in ends} for ends in (
        [name for name, known in layers.attributes.items() if "yields_to" in known],
        [first for known in layers.attributes.values() for first in known.get("yields_to", "").split(",") if first])]
    assert roads == [{c.connecting for c in junction.connections if getattr(c, by) == getattr(way, by)} for way in (one, two)]


def test_a_priority_of_a_road_that_is_not_of_the_junction_is_a_finding(tmp_path):
    as_roads(tmp_path, RoadMapSource(crossing()))
    text = (tmp_path / "out.xodr").read_text(encoding="utf-8").replace("</junction>", '<priority high="999" low="1"/></junction>')
    found = check_opendrive(read_opendrive(written(tmp_path, text))).found
    assert [one.fault for one in found if "999" in one.text] == ["connection"]


def test_nobody_waits_for_himself(tmp_path):
    lanes = crossing()
    low, high, *_ = turns(lanes)
    layers = RoadMapSource(lanes, attributes={low: {"yields_to": f"{low},{high}"}, high: {"yields_to": high}})
    (junction,) = as_roads(tmp_path, layers)[1].junctions
    assert len(junction.priorities) == 1 and junction.priorities[0][0] != junction.priorities[0][1]
    (pair,) = waiting(layers_of_lanelets(as_lanelets(tmp_path, layers)[1], CRS))
    assert pair == (place(layers, low), place(layers, high))


@pytest.mark.parametrize("kind, rules", [("sign", 1), ("board", 0)])
def test_what_is_no_sign_says_nothing_about_who_goes_first(tmp_path, kind, rules):
    lanes, signals = crossing(), Features("PointZ", SIGNALS)
    before = next(name for name, after in zip(lanes.lane_id, lanes.successors) if {*after} & {*turns(lanes)})
    signals.add(shapely.Point(500_000.0, 5_400_000.0, 100.0), kind=kind, country="DE", code="205", lanes=before)
    _, whole = as_lanelets(tmp_path, RoadMapSource(lanes, signals=signals))
    assert sum(rule.tags.get("subtype") == "right_of_way" for rule in whole.others.values()) == rules
