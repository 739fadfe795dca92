"""Faults put into good files are found and named; good files have none."""

import re

import pytest
from lanewright.products.export.check.findings import FAULTS
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.lanelet_map import node_places, read_lanelet2
from lanewright.products.export.opendrive.xodr import read_opendrive
from map_files import geometry, lanelet_street, opendrive, road, street_section, written

BOTH = '<predecessor id="{0}"/><successor id="{0}"/>'


def link(**ends):
    def one(tag, id, contact=None, junction=False):
        where = f' contactPoint="{contact}"' if contact else ""
        return f'<{tag} elementType="{"junction" if junction else "road"}" elementId="{id}"{where}/>'
    return "".join(one(tag, *given) for tag, given in ends.items())


def good_town():
    """Road 1 in two sections leads by an arc to road 2; a junction joins its end with road 4 through the connecting road 3."""
    links = BOTH.format(1), BOTH.format(-1)
    slope = '<elevation s="0" a="{}" b="0.01" c="0" d="0"/>'.format
    first = road(geometry(0, 0, 0, 0, 30) + geometry(30, 30, 0, 0, 10), 40, "1", profile=slope(10), link=link(successor=("2", "start")),
                 lanes=street_section(0, links).replace("<predecessor", "<none") + street_section(20, links))
    second = road(geometry(0, 40, 0, 0, 60, '<arc curvature="0.02"/>'), 60, "2", profile=slope(10.4), lanes=street_section(0, links),
                  link=link(predecessor=("1", "end"), successor=("9", None, True)))
    x, y, heading = 86.60195429836132, 31.88211227616632, 1.2
    turn = road(geometry(0, x, y, heading, 10), 10, "3", profile=slope(11.0), lanes=street_section(0, links), junction="9",
                link=link(predecessor=("2", "end"), successor=("4", "start")))
    last = road(geometry(0, 90.22553184331805, 41.20250266183858, heading, 30), 30, "4", profile=slope(11.1),
                link=link(predecessor=("9", None, True)), lanes=street_section(0, links))
    junction = ('<junction id="9" name=""><connection id="0" incomingRoad="2" connectingRoad="3" contactPoint="start"><laneLink from="-1" to="-1"/>'
                '</connection><connection id="1" incomingRoad="4" connectingRoad="3" contactPoint="end"><laneLink from="1" to="1"/></connection>'
                '</junction>')
    return opendrive([first, second, turn, last], junction)


def check_text(folder, text):
    return check_opendrive(read_opendrive(written(folder, text)))


def test_a_good_map_has_no_findings_and_its_lanes_are_counted(tmp_path):
    found = check_text(tmp_path, good_town())
    assert not found.found, found.found
    assert (found.lanes, found.successors, found.neighbours) == (10, 8, 5)


def edited(text, old, new, count=1):
    assert old in text, old
    return text.replace(old, new, count)


CURB = '<lane id="-2" type="curb"'
OBJECT = '<objects><object id="7" type="crosswalk" s="99" t="0" zOffset="0" orientation="none"/></objects></road>'
IN_A_ROAD = {
    "gap": ('s="30" x="30"', 's="30" x="30.5"'),
    "kink": ('s="30" x="30" y="0" hdg="0"', 's="30" x="30" y="0" hdg="0.1"'),
    "station": ('<geometry s="30"', '<geometry s="31"'),
    "road length": ('length="40" id="1"', 'length="45" id="1"'),
    "height step": ('<elevation s="0" a="10" b="0.01" c="0" d="0"/>',
                    '<elevation s="0" a="10" b="0.01" c="0" d="0"/><elevation s="20" a="13.2" b="-0.14" c="0" d="0"/>'),
    "crossfall step": ('<lateralProfile>', '<lateralProfile><superelevation s="0" a="0" b="0" c="0" d="0"/>'
                                           '<superelevation s="20" a="0.1" b="-0.005" c="0" d="0"/>'),
    "width below zero": ('<width sOffset="0" a="3.5" b="0" c="0" d="0"/>', '<width sOffset="0" a="3.5" b="-0.8" c="0.04" d="0"/>'),
    "width step": ('<width sOffset="0" a="3.5" b="0" c="0" d="0"/>',
                   '<width sOffset="0" a="3.5" b="0" c="0" d="0"/><width sOffset="8" a="3" b="0" c="0" d="0"/>'
                   '<width sOffset="12" a="3.5" b="0" c="0" d="0"/>'),
    "border folds": ('curvature="0.02"', 'curvature="0.4"'),
    "lane order": (CURB, '<lane id="-3" type="curb"'),
    "centre lane": ('<lane id="0" type="none" level="false"><link></link>',
                    '<lane id="0" type="none" level="false"><width sOffset="0" a="1" b="0" c="0" d="0"/>'),
    "section order": ('<laneSection s="20"', '<laneSection s="60"'),
    "lane type": ('type="curb"', 'type="kerb"'),
    "road mark type": ('type="broken"', 'type="dashed"'),
    "traffic rule": ('rule="RHT"', 'rule="right"'),
    "id twice": ('id="2" junction', 'id="1" junction'),
    "unreadable": ('<geometry s="0" x="40"', '<geometry s="0" x="forty"'),
    "object off the road": ("</road>", OBJECT),
}
BETWEEN_ROADS = {
    "lane link": ('<successor id="-1"/>', '<successor id="-5"/>'),
    "one-sided link": ('<predecessor elementType="road" elementId="1" contactPoint="end"/>', ''),
    "road link": ('elementType="road" elementId="2" contactPoint="start"', 'elementType="road" elementId="77" contactPoint="start"'),
    "gap at a link": ('s="0" x="40" y="0"', 's="0" x="40" y="0.5"'),
    "kink at a link": ('<geometry s="0" x="40" y="0" hdg="0"', '<geometry s="0" x="40" y="0" hdg="0.1"'),
    "height step at a link": ('a="10.4"', 'a="13.4"'),
    "connection": ('incomingRoad="2"', 'incomingRoad="88"'),
    "unused junction road": ('connectingRoad="3"', 'connectingRoad="33"'),
    "dead end": (), "no way in": (),
    "two at one place": (),
}


@pytest.mark.parametrize("fault", [*IN_A_ROAD, *BETWEEN_ROADS])
def test_a_fault_put_into_a_good_map_is_found_and_named(tmp_path, fault):
    text, edit = good_town(), (IN_A_ROAD | BETWEEN_ROADS)[fault]
    if fault == "two at one place":
        copy = re.search(r'<road name="" length="40" id="1".*?</road>', text, re.S)[0].replace('id="1" junction', 'id="5" junction')
        text = edited(text, "<junction", copy + "<junction")
    elif fault == "unused junction road":
        text = edited(text, *edit, 2)
    elif fault in ("dead end", "no way in"):   # neither road says that the lane goes on
        first, second = (re.search(rf'<road name="" length="{length}".*?</road>', text, re.S)[0] for length in (40, 60))
        head, last_section = first.rsplit("<laneSection", 1)
        lane_id = {"dead end": "-1", "no way in": "1"}[fault]
        text = text.replace(first, head + "<laneSection" + last_section.replace(f'<successor id="{lane_id}"/>', ""))
        text = text.replace(second, second.replace(f'<predecessor id="{lane_id}"/>', ""))
    else:
        text = edited(text, *edit)
    assert fault in check_text(tmp_path, text).counts()


def test_a_contact_point_at_the_wrong_end_is_a_gap_or_a_way_against_the_traffic(tmp_path):
    text = edited(good_town(), '<successor elementType="road" elementId="2" contactPoint="start"/>',
                  '<successor elementType="road" elementId="2" contactPoint="end"/>')
    counts = check_text(tmp_path, text).counts()
    assert counts["gap at a link"] and counts["direction at a link"]


def street(**more):
    return lanelet_street(lengths=(20.0, 20.0, 20.0), **more)


def check_street(folder, text):
    whole = read_lanelet2(written(folder, text, "map.osm"))
    return check_lanelets(whole, *node_places(whole, "EPSG:25832"))


def test_a_good_street_of_lanelets_has_no_findings_and_its_links_are_counted(tmp_path):
    found = check_street(tmp_path, street())
    assert not found.found, found.found
    assert (found.lanes, found.successors, found.neighbours) == (6, 4, 3)


def swapped(text):
    return edited(text, 'role="left" ref="12"/><member type="way" role="right" ref="2"',
                  'role="right" ref="12"/><member type="way" role="left" ref="2"')


def moved_node(text, id, lat):
    return re.sub(rf'(<node id="{id}" lat=")[\d.]+', rf"\g<1>{lat}", text)


def own_nodes(text):
    """The second lanelet to the east gets nodes of its own where it begins."""
    nodes = "".join(re.search(rf'<node id="{id}".*?</node>', text)[0].replace(f'id="{id}"', f'id="{id + 5000}"') for id in (1001, 1101))
    text = text.replace('<way id="1"', nodes + '<way id="1"')
    for way, id in ((2, 1001), (12, 1101)):
        text = edited(text, f'<way id="{way}"><nd ref="{id}"/>', f'<way id="{way}"><nd ref="{id + 5000}"/>')
    return text


def own_border(text):
    """The lanelet to the west has a middle line of its own."""
    way = re.search(r'<way id="12">.*?</way>', text)[0].replace('id="12"', 'id="512"')
    head, tail = text.split('<relation id="202">')
    return head.replace('<way id="1"', way + '<way id="1"') + '<relation id="202">' + tail.replace('ref="12"', 'ref="512"', 1)


LANELET_FAULTS = {
    "id twice": lambda text: edited(text, '<way id="2">', '<way id="1">'),
    "missing node": lambda text: edited(text, '<nd ref="1001"/>', '<nd ref="9999"/>'),
    "missing member": lambda text: edited(text, 'role="left" ref="11"', 'role="left" ref="999"'),
    "short way": lambda text: edited(text, '<nd ref="1000"/>', ''),
    "repeated node": lambda text: edited(text, '<nd ref="1000"/>', '<nd ref="1000"/><nd ref="1000"/>'),
    "way type": lambda text: edited(text, 'v="line_thin"', 'v="line_thn"'),
    "way subtype": lambda text: edited(text, '<tag k="subtype" v="dashed"/>', ''),
    "lanelet tag": lambda text: edited(text, '<tag k="subtype" v="road"/>', '<tag k="subtype" v="raod"/>'),
    "border missing": lambda text: edited(text, '<member type="way" role="right" ref="1"/>', ''),
    "border crosses": lambda text: moved_node(text, 1001, 52.3),
    "head on": swapped,
    "not joined": own_nodes,
    "border twice": own_border,
    "lane width": lambda text: edited(text, 'role="right" ref="2"', 'role="right" ref="12"'),
    "missing height": lambda text: edited(text, '<tag k="ele" v="70.000"/>', ''),
}


@pytest.mark.parametrize("fault", LANELET_FAULTS)
def test_a_fault_put_into_a_good_street_is_found_and_named(tmp_path, fault):
    assert fault in check_street(tmp_path, LANELET_FAULTS[fault](street())).counts()


def test_a_lanelet_with_swapped_borders_at_the_end_of_a_long_street_is_found_by_the_habit_of_the_map(tmp_path):
    text = lanelet_street(lengths=(10.0,) * 8)
    assert not check_street(tmp_path, text).found
    text = edited(text, '<member type="way" role="left" ref="11"/><member type="way" role="right" ref="1"/>',
                  '<member type="way" role="left" ref="1"/><member type="way" role="right" ref="11"/>')
    assert {"sides swapped", "head on"} <= set(check_street(tmp_path, text).counts())


def test_a_centre_line_that_leaves_its_lanelet_is_found(tmp_path):
    text = edited(street(), '<member type="way" role="left" ref="11"/>', '<member type="way" role="left" ref="11"/>'
                            '<member type="way" role="centerline" ref="21"/>')
    assert "centre line outside" in check_street(tmp_path, text).counts()


@pytest.mark.parametrize("tag, value", [("speed_limit", "fast"), ("speed_limit", "-30"), ("one_way", "maybe"), ("location", "moon"),
                                        ("participant:vehicle", "perhaps")])
def test_a_tag_with_a_value_that_no_reader_knows_is_found(tmp_path, tag, value):
    text = edited(street(), '<tag k="location" v="urban"/><tag k="one_way" v="yes"/><tag k="participant:vehicle" v="yes"/>',
                  f'<tag k="{tag}" v="{value}"/>')
    assert "lanelet tag" in check_street(tmp_path, text).counts()


def test_every_fault_says_what_it_means_and_has_a_test():
    tested = {*IN_A_ROAD, *BETWEEN_ROADS, *LANELET_FAULTS, "sides swapped", "centre line outside", "direction at a link",
              "value", "record order", "two at once", "reference", "bounds", "spike", "centre line", "regulatory element", "way tag",
              "id not positive", "local coordinates", "open area"}   # the last twelve by test_stated_faults.py
    assert set(FAULTS) == tested and all(len(text) > 20 for text in FAULTS.values())
