"""Lanelets come back as lanes, with what follows each."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.export.lanelet_map import layers_of_lanelets, matched, read_lanelet2
from map_files import lanelet_street, written


def read(folder, text):
    return read_lanelet2(written(folder, text, "map.osm"))


def test_lanelets_lie_where_their_nodes_say_and_are_driven_with_left_on_the_left(tmp_path):
    lanes = layers_of_lanelets(read(tmp_path, lanelet_street()), "EPSG:25832").lanes
    left, right = lanes.borders(list(lanes.lane_id).index("101"))
    np.testing.assert_allclose(left, [[602000, 5792000, 70], [602020, 5792000, 70.4]], atol=1e-4)
    np.testing.assert_allclose(right[:, 1], 5792000 - 3.5, atol=1e-4)
    left, right = lanes.borders(list(lanes.lane_id).index("201"))
    np.testing.assert_allclose(left[:, 0], [602020, 602000], atol=1e-4)
    np.testing.assert_allclose(right[:, 1], 5792000 + 3.5, atol=1e-4)


def test_lanelets_that_share_their_end_nodes_follow_each_other(tmp_path):
    lanes = layers_of_lanelets(read(tmp_path, lanelet_street(lengths=(10, 10, 10)))).lanes
    follows = dict(zip(lanes.lane_id, lanes.successors))
    assert follows == {"101": ("102",), "102": ("103",), "103": (), "201": (), "202": ("201",), "203": ("202",)}


def test_lines_and_edges_become_layers_of_their_own(tmp_path):
    found = layers_of_lanelets(read(tmp_path, lanelet_street()))
    assert sorted(found.marking_lines.column("pattern")) == ["dashed", "dashed", "solid", "solid"]
    assert len(found.road_edges) == 2 and len(found.driving_lines) == 4
    assert all(shapely.is_valid(area) for area in found.lane_areas().geometries)
    assert "326" in found.lanes.crs or "UTM zone 32N" in found.lanes.crs


LANELET = """<osm version="0.6">
<node id="{ids[0]}" {places[0]}</node><node id="{ids[1]}" {places[1]}</node>
<node id="{ids[2]}" {places[2]}</node><node id="{ids[3]}" {places[3]}</node>
<way id="{ids[4]}"><nd ref="{ids[2]}"/><nd ref="{ids[3]}"/><tag k="type" v="line_thin"/></way>
<way id="{ids[5]}"><nd ref="{ids[0]}"/><nd ref="{ids[1]}"/><tag k="type" v="line_thin"/></way>
<relation id="{ids[6]}"><member type="way" role="left" ref="{ids[4]}"/><member type="way" role="right" ref="{ids[5]}"/>
<tag k="type" v="lanelet"/><tag k="subtype" v="road"/></relation></osm>"""
CORNERS = (0.0, 0.0), (20.0, 0.0), (0.0, 3.5), (20.0, 3.5)   # m: a lane that heads east


def degrees(lon, lat, x, y, more=""):
    return f'lon="{lon + x / (111320 * np.cos(np.radians(lat))):.12f}" lat="{lat + y / 110574:.12f}">{more}'


@pytest.mark.parametrize("first", [1, 2**62, 2**63 - 7, -2**63 + 1, -7])
def test_ids_of_64_bits_with_a_sign_are_read(tmp_path, first):
    text = LANELET.format(ids=range(first, first + 7), places=[degrees(8.4, 49.0, *place) for place in CORNERS])
    lanes = layers_of_lanelets(read(tmp_path, text)).lanes
    (left, right), ahead = lanes.borders(0), np.diff(lanes.left, axis=0)[0]
    assert list(lanes.lane_id) == [str(first + 6)] and ahead[0] == pytest.approx(20.0, abs=0.1)
    assert left[0, 1] - right[0, 1] == pytest.approx(3.5, abs=0.1)


@pytest.mark.parametrize("first", [2**63 - 3, 2**63, 2**64 - 7])
def test_ids_of_64_bits_without_a_sign_are_read(tmp_path, first):
    text = LANELET.format(ids=range(first, first + 7), places=[degrees(8.4, 49.0, *place) for place in CORNERS])
    lanes = layers_of_lanelets(read(tmp_path, text)).lanes
    assert list(lanes.lane_id) == [str(first + 6 - 2**64)] and len(lanes.borders(0)[0]) > 1


@pytest.mark.parametrize("id", ["18446744073709551616", "-9223372036854775808", "9" * 5000, "1.5", ""])
def test_what_is_no_id_is_named_with_its_line(tmp_path, id):
    text = LANELET.format(ids=[id, *range(2, 8)], places=[degrees(8.4, 49.0, *place) for place in CORNERS])
    with pytest.raises(RoadExtractionError, match="Line 2: id of <node>"):
        read(tmp_path, text)


@pytest.mark.parametrize("kind", ["no degrees", "empty degrees", "all at 0", "about 0 with local", "about 0"])
def test_a_local_map_keeps_its_lengths_and_has_no_crs(tmp_path, kind):
    local = [f'<tag k="local_x" v="{x}"/><tag k="local_y" v="{y}"/>' for x, y in CORNERS]
    places = {"no degrees": [f">{tags}" for tags in local], "empty degrees": [f'lat="" lon="">{tags}' for tags in local],
              "all at 0": [f'lat="0" lon="0.0">{tags}' for tags in local],
              "about 0 with local": [degrees(0.0, 0.0, *place, tags) for place, tags in zip(CORNERS, local)],
              "about 0": [degrees(0.0, 0.0, *place) for place in CORNERS]}[kind]
    found = layers_of_lanelets(read(tmp_path, LANELET.format(ids=range(1, 8), places=places)))
    np.testing.assert_allclose(found.lanes.right[:, :2], CORNERS[:2], atol=0.01)
    np.testing.assert_allclose(found.lanes.left[:, :2], CORNERS[2:], atol=0.01)
    assert found.lanes.crs == "" and "local coordinates" in found.notes[0]


def test_borders_of_different_vertices_are_matched_without_losing_any():
    left = np.array([[0, 0, 0], [4, 0, 0], [10, 0, 1.0]])
    right = np.array([[0, -3, 0], [5, -3, 0], [10, -3, 0.0]])
    for border, given in zip(matched(left, right), (left, right)):
        assert len(border) == 4
        assert all(np.abs(border - vertex).sum(1).min() < 1e-12 for vertex in given)


@pytest.mark.parametrize("text, said", [
    ("<osm><node id='1' lat='10' lon='10'/></osm>", "no relation of type lanelet"),
    (lanelet_street().replace('id="101"', 'id="one"'), "id of <relation> is 'one'"),
    (lanelet_street().replace('lat="5', 'lat="95'), "degrees up to 180 and 90"),
    (lanelet_street().replace('v="70.400"', 'v="high"'), "ele of <tag> is 'high'"),
    (lanelet_street().replace(' lat=', ' breite='), "neither lat and lon nor local_x and local_y")])
def test_what_is_no_map_of_lanelets_is_refused_in_one_sentence(tmp_path, text, said):
    with pytest.raises(RoadExtractionError, match=said):
        layers_of_lanelets(read(tmp_path, text))


def test_local_coordinates_serve_where_there_are_no_degrees(tmp_path):
    text = lanelet_street()
    for row, y in enumerate((0.0, 3.5, 7.0)):
        for k in range(3):
            node = f'<node id="{row * 100 + k + 1000}"'
            text = text.replace(node, f'{node} x="{20.0 * k}" y="{y}"')
    import re
    text = re.sub(r'(<node id="\d+") x="([\d.]+)" y="([\d.]+)" lat="[\d.]+" lon="[\d.]+">',
                  r'\1><tag k="local_x" v="\2"/><tag k="local_y" v="\3"/>', text)
    lanes = layers_of_lanelets(read(tmp_path, text)).lanes
    assert lanes.crs == "" and lanes.width == pytest.approx([3.5] * 4)
