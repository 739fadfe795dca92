"""Faults thought out from the text of the standards by somebody who had not read the check, put into good exports: each is found and named."""

from copy import deepcopy
from xml.etree import ElementTree

import pytest
from lanewright.products.export.check.lanelets import check_lanelets
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.lanelet_export import draft_lanelets, lanelet2_text, to_degrees
from lanewright.products.export.lanelet_map import node_places, read_lanelet2
from lanewright.products.export.opendrive.exporter import draft_opendrive
from lanewright.products.export.opendrive.xodr import opendrive_text, read_opendrive
from lanewright.products.export.sources import RoadMapSource, checked, reference_of_crs
from made_lanes import CRS, crossing, s_curve, street
from map_files import written

SCENES = {"street": lambda: street(cut=30.0), "crossing": crossing, "arc": lambda: street(((100.0, 1 / 40, 1 / 40),)),
          "crowned": lambda: s_curve(slope=0.02, crown=0.025), "tilted": lambda: s_curve(slope=0.02, crossfall=0.02)}


@pytest.fixture(scope="module")
def roads():
    """Name of a scene -> its OpenDRIVE, made once."""
    made = {}

    def text(scene):
        if scene not in made:
            lanes = SCENES[scene]()
            draft = draft_opendrive(checked(RoadMapSource(lanes)))
            draft.map.reference = reference_of_crs(lanes.crs)
            made[scene] = opendrive_text(draft.map)
        return made[scene]
    return text


def put(path, words=None, **attributes):
    """Other attributes, or another text, of the first element at a path."""
    def change(root):
        one = root.find(path)
        one.attrib.update(attributes)
        one.text = words or one.text
    return change


def add(path, xml):
    """A child more."""
    return lambda root: root.find(path).append(ElementTree.fromstring(xml))


def drop(path, child):
    return lambda root: root.find(path).remove(root.find(f"{path}/{child}"))


def again(path, child):
    return lambda root: root.find(path).append(deepcopy(root.find(f"{path}/{child}")))


def last_first(path):
    """The first of its children goes to the end."""
    def change(root):
        parent = root.find(path)
        first = parent[0]
        parent.remove(first)
        parent.append(first)
    return change


def both(*changes):
    def change(root):
        for one in changes:
            one(root)
    return change


def thing(kind="object", inside="", **attributes):
    given = {"id": "1", "type": "crosswalk", "s": "10", "t": "0", "zOffset": "0", "orientation": "none"} | attributes
    text = " ".join(f'{name}="{value}"' for name, value in given.items() if value is not None)
    return f"<{kind} {text}>{inside}</{kind}>"


def things(*texts, group="objects"):
    return add("road", f"<{group}>{''.join(texts)}</{group}>")


MARK, WIDTH, LINE = ".//right/lane/roadMark", ".//right/lane/width", ".//roadMark/type/line"
CORNERS = "".join(f'<cornerLocal u="{u}" v="0" z="0" height="0"/>' for u in (0, 1))
LENGTH_ALONE = {name + axis: "1" if name + axis == "b" + "U" else "0" for axis in "UV" for name in "abcd"}
POLY = f"""<paramPoly3 {' '.join(f'{name}="{value}"' for name, value in LENGTH_ALONE.items())} pRange="metres"/>"""
CUBIC = 's="{}" a="{}" b="0" c="0" d="0"/>'.format
STATED = [
    ("street", "value", "a version that is none", put("header", revMinor="99")),
    ("crowned", "two at once", "two shapes in one geometry", add(".//geometry", '<arc curvature="0.01"/>')),
    ("arc", "value", "an arc without curvature", put(".//arc", curvature="0")),
    ("crowned", "record order", "the first elevation at 5 m", put(".//elevation", s="5")),
    ("street", "record order", "elevations that go back", both(add(".//elevationProfile", "<elevation " + CUBIC(50, 70)),
                                                               last_first(".//elevationProfile"))),
    ("tilted", "value", "a superelevation of 100 degrees", put(".//superelevation", a="1.75")),
    ("tilted", "record order", "a superelevation beyond the road", add(".//lateralProfile", "<superelevation " + CUBIC(9999, 0))),
    ("crowned", "record order", "shapes that go back", last_first(".//lateralProfile")),
    ("street", "value", "lane -1.5", put(".//right/lane", id="-1.5")),
    ("crossing", "value", "a lane whose number is a word", put(".//right/lane", id="outer")),
    ("street", "record order", "the first width at 5 m", put(WIDTH, sOffset="5")),
    ("street", "value", "a lane of 200 m", put(WIDTH, a="200")),
    ("street", "two at once", "width and border", add(".//right/lane", '<border sOffset="0" a="-3" b="0" c="0" d="0"/>')),
    ("street", "record order", "a lane offset that begins at 10 m", put(".//laneOffset", s="10", a="0.5")),
    ("street", "record order", "a road mark beyond its section", put(MARK, sOffset="500")),
    ("street", "value", "a road mark of negative width", put(MARK, width="-0.12")),
    ("street", "value", "a colour that is none", put(MARK, color="weiss")),
    ("street", "value", "dashes of no length", put(LINE, length="0", space="0")),
    ("street", "value", "dashes of negative length", put(LINE, length="-3")),
    ("street", "lane link", "a lane linked to lane 0", put(".//right/lane/link/successor", id="0")),
    ("street", "dead end", "a driving lane that leads to a shoulder", put(".//laneSection[2]/right/lane", type="shoulder")),
    ("crossing", "road link", "a way through that comes from nowhere", drop("road[@junction='17']/link", "predecessor")),
    ("crossing", "connection", "a lane link twice", again(".//connection", "laneLink")),
    ("crossing", "id twice", "a connection twice", put(".//connection[2]", id="0")),
    ("street", "reference", "a CRS that nothing reads", put(".//geoReference", "+proj=nothing +zone=99")),
    ("street", "reference", "a CRS in degrees", put(".//geoReference", "+proj=longlat +datum=WGS84")),
    ("street", "value", "a negative speed", add("road", '<type s="0" type="town"><speed max="-30" unit="km/h"/></type>')),
    ("street", "value", "a speed in knots", add("road", '<type s="0" type="town"><speed max="30" unit="knots"/></type>')),
    ("street", "value", "an avenue", add("road", '<type s="0" type="avenue"/>')),
    ("street", "object off the road", "an object 300 m aside", things(thing(t="300"))),
    ("street", "value", "an object of unknown type", things(thing(type="zebra"))),
    ("street", "value", "an object without s", things(thing(s=None))),
    ("street", "value", "an object of negative length", things(thing(length="-3"))),
    ("street", "value", "an object without length", things(thing(length="0"))),
    ("street", "id twice", "an object twice", things(thing(), thing())),
    ("street", "value", "an outline of two corners", things(thing(inside=f'<outlines><outline id="0">{CORNERS}</outline></outlines>'))),
    ("street", "lane link", "an object on lanes that are not there", things(thing(inside='<validity fromLane="-9" toLane="-7"/>'))),
    ("street", "object off the road", "a signal beyond the road", things(thing("signal", s="99", type="274"), group="signals")),
    ("street", "value", "a signal that faces nowhere", things(thing("signal", orientation="?", type="274"), group="signals")),
    ("street", "value", "a parameter that runs over metres", both(drop(".//geometry", "line"), add(".//geometry", POLY))),
    ("crossing", "bounds", "bounds that are elsewhere", put("header", west="5000", east="6000")),
    ("street", "bounds", "north below south", put("header", north="-50", south="50")),
]


@pytest.mark.parametrize("scene, fault, change", [(scene, fault, change) for scene, fault, _, change in STATED], ids=[name for *_, name, _ in STATED])
def test_what_the_standard_does_not_allow_is_found_in_an_opendrive_map(tmp_path, roads, scene, fault, change):
    root = ElementTree.fromstring(roads(scene))
    assert not check_opendrive(read_opendrive(written(tmp_path, roads(scene)))).found
    change(root)
    found = check_opendrive(read_opendrive(written(tmp_path, ElementTree.tostring(root, encoding="unicode"))))
    assert fault in found.counts(), found.counts()


def test_what_an_earlier_version_allowed_is_no_fault_of_its_files(tmp_path, roads):
    root = ElementTree.fromstring(roads("street"))
    both(put("header", revMinor="4"), things(thing(length="0", width="0")))(root)
    assert not check_opendrive(read_opendrive(written(tmp_path, ElementTree.tostring(root, encoding="unicode")))).found


@pytest.fixture(scope="module")
def lanelets():
    """Two lanelets each way, as our own export has them; with ten more for habits."""
    made = {}
    for name, lanes in (("short", street(cut=30.0)), ("long", crossing())):
        draft = draft_lanelets(checked(RoadMapSource(lanes)))
        made[name] = lanelet2_text(draft, to_degrees(draft.nodes, CRS))
    return made


def lanelet(root, number=0):
    return root.findall("relation")[number]


def member(root, role, number=0):
    return lanelet(root, number).find(f"member[@role='{role}']")


def way(root, role, number=0):
    return root.find(f"way[@id='{member(root, role, number).get('ref')}']")


def node(root, k, role="right", number=0):
    return root.find(f"node[@id='{way(root, role, number).findall('nd')[k].get('ref')}']")


def tagged(one, **tags):
    for key, value in tags.items():
        found = one.find(f"tag[@k='{key}']")
        if found is None:
            found = ElementTree.SubElement(one, "tag", {"k": key})
        found.set("v", value)


def moved(root, north=0.0, up=0.0):
    """One node of the right border aside (metres) or up."""
    one = node(root, 5)
    one.set("lat", f"{float(one.get('lat')) + north / 111e3:.11f}")
    tagged(one, ele=f"{float(one.find('tag').get('v')) + up:.4f}")


def rule(root, subtype, members="", tags="", used=True):
    root.append(ElementTree.fromstring(f'<relation id="90020">{members}<tag k="type" v="regulatory_element"/><tag k="subtype" v="{subtype}"/>'
                                       f'{tags}</relation>'))
    if used:
        lanelet(root).insert(0, ElementTree.fromstring('<member type="relation" role="regulatory_element" ref="90020"/>'))


def reversed_nodes(one):
    nodes = one.findall("nd")
    for nd, ref in zip(nodes, [nd.get("ref") for nd in nodes][::-1]):
        nd.set("ref", ref)


def renumbered(root, id):
    one = way(root, "centerline")
    member(root, "centerline").set("ref", id)
    one.set("id", id)


def repeated(root):
    one = deepcopy(lanelet(root))
    one.set("id", "90003")
    root.append(one)


def area(root):
    ref = member(root, "left").get("ref")
    root.append(ElementTree.fromstring(f'<relation id="90021"><member type="way" role="outer" ref="{ref}"/><tag k="type" v="multipolygon"/>'
                                       '<tag k="subtype" v="parking"/></relation>'))


def exchanged(root):
    for one in root.findall("node"):
        lat, lon = one.get("lat"), one.get("lon")
        one.attrib.update(lat=lon, lon=lat)


SIGN = '<tag k="sign_type" v="de274"/>'
TAGGED = [
    ("border missing", "a node as border", lambda r: member(r, "right").attrib.update(type="node", ref="1")),
    ("lanelet tag", "a lanelet misspelt", lambda r: tagged(lanelet(r), type="lanlet")),
    ("lanelet tag", "an unknown participant", lambda r: lanelet(r).find("tag[@k='participant:vehicle']").set("k", "participant:vehicles")),
    ("lanelet tag", "nobody may drive", lambda r: tagged(lanelet(r), **{"participant:vehicle": "no"})),
    ("lanelet tag", "vehicles on a zebra crossing", lambda r: tagged(lanelet(r), subtype="crosswalk")),
    ("lanelet tag", "vehicles on a walkway", lambda r: tagged(lanelet(r), subtype="walkway")),
    ("spike", "a node 50 m up", lambda r: moved(r, up=50.0)),
    ("spike", "a node 1 m up", lambda r: moved(r, up=1.0)),
    ("spike", "a node 5 m aside", lambda r: moved(r, north=-5.0)),
    ("spike", "a node 1 m aside", lambda r: moved(r, north=-1.0)),
    ("way tag", "lanes changed sometimes", lambda r: tagged(way(r, "left"), lane_change="sometimes")),
    ("way tag", "a width in words", lambda r: tagged(way(r, "left"), width="wide")),
    ("way type", "a stop line as border", lambda r: tagged(way(r, "left"), type="stop_line")),
    ("centre line", "a centre line against the traffic", lambda r: reversed_nodes(way(r, "centerline"))),
    ("centre line", "two centre lines", lambda r: lanelet(r).append(deepcopy(member(r, "centerline", 1)))),
    ("two at one place", "a lanelet twice", repeated),
    ("regulatory element", "a rule misspelt", lambda r: rule(r, "speed_limt")),
    ("regulatory element", "lights without lights", lambda r: rule(r, "traffic_light")),
    ("regulatory element", "right of way for nobody", lambda r: rule(r, "right_of_way")),
    ("regulatory element", "a limit without a sign", lambda r: rule(r, "speed_limit")),
    ("regulatory element", "a rule that nobody obeys", lambda r: rule(r, "speed_limit", tags=SIGN, used=False)),
    ("regulatory element", "a role misspelt", lambda r: rule(r, "speed_limit", '<member type="way" role="referz" ref="1"/>', SIGN)),
    ("id twice", "a tag twice", lambda r: lanelet(r).append(ElementTree.fromstring('<tag k="subtype" v="walkway"/>'))),
    ("id not positive", "id 0", lambda r: renumbered(r, "0")),
    ("id not positive", "a negative id", lambda r: renumbered(r, "-5")),
    ("local coordinates", "one node with local_x", lambda r: tagged(node(r, 3), local_x="12.0", local_y="3.0")),
    ("open area", "an area that does not close", area),
]


def check_street(folder, text):
    whole = read_lanelet2(written(folder, text, "map.osm"))
    return check_lanelets(whole, *node_places(whole, CRS))


@pytest.mark.parametrize("fault, change", [(fault, change) for fault, _, change in TAGGED], ids=[name for _, name, _ in TAGGED])
def test_what_the_tagging_of_lanelet2_does_not_have_is_found(tmp_path, lanelets, fault, change):
    assert not check_street(tmp_path, lanelets["short"]).found
    root = ElementTree.fromstring(lanelets["short"])
    change(root)
    counts = check_street(tmp_path, ElementTree.tostring(root, encoding="unicode")).counts()
    assert fault in counts, counts


def test_a_rule_that_is_whole_and_obeyed_is_no_finding(tmp_path, lanelets):
    root = ElementTree.fromstring(lanelets["short"])
    rule(root, "speed_limit", tags=SIGN)
    assert not check_street(tmp_path, ElementTree.tostring(root, encoding="unicode")).found


def test_latitude_and_longitude_in_each_others_place_turn_the_sides_of_a_whole_map(tmp_path, lanelets):
    assert not check_street(tmp_path, lanelets["long"]).found
    root = ElementTree.fromstring(lanelets["long"])
    exchanged(root)
    whole = read_lanelet2(written(tmp_path, ElementTree.tostring(root, encoding="unicode"), "map.osm"))
    assert check_lanelets(whole, *node_places(whole, "")).counts()["sides swapped"] == 1
