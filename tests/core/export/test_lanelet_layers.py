"""Lanelets come back as lanes, with what follows each."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.export.lanelet.layers import layers_of_lanelets, matched
from lanewright.core.export.lanelet.reader import read_lanelet2
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
    assert sorted(found.marking_lines().column("pattern")) == ["dashed", "dashed", "solid", "solid"]
    assert len(found.road_edges()) == 2 and len(found.driving_lines()) == 4
    assert all(shapely.is_valid(area) for area in found.lane_areas().geometries)
    assert "326" in found.lanes.crs or "UTM zone 32N" in found.lanes.crs


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
