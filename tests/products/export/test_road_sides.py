"""Curbs and edges of the pavement keep apart in every format, and beside a double line the line to drive on stays where it was."""

import numpy as np
import pytest
import shapely
from exported_maps import as_lanelets, as_roads
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.products.cad import dxf_lines
from lanewright.products.export.lanelet_export import draft_lanelets
from lanewright.products.export.lanelet_map import layers_of_lanelets
from lanewright.products.export.opendrive.xodr import layers_of_opendrive
from lanewright.products.export.shared_borders import with_shared_borders
from lanewright.products.export.sources import RoadMapSource, checked
from made_lanes import CRS, Axis, LaneScene, double_line, kinds


def one_side_of_each():
    """A street with a curb on the right; on the left the pavement ends without one, beside an unpainted shoulder."""
    scene, line = LaneScene(), Axis(((40.0, 0.0, 0.0),))
    scene.add(line, 0.0, -3.5, **kinds(outer="curb", pattern=""))
    scene.add(line, 3.5, 0.0, lane=2, direction=-1, **kinds())
    scene.add(line, 5.0, 3.5, lane=3, direction=0, type="shoulder", left_kind="pavement", left_pattern="", right_kind="edge",
              right_pattern="solid")
    return scene.lanes()


@pytest.mark.parametrize("form", ["OpenDRIVE", "Lanelet2"])
def test_an_edge_of_the_pavement_is_no_curb_in_the_file_and_when_it_is_read_again(tmp_path, form):
    source = checked(RoadMapSource(one_side_of_each()))
    if form == "OpenDRIVE":
        draft, whole = as_roads(tmp_path, source)
        lanes = draft.map.roads[0].sections[0].lanes
        assert {id: lane.type for id, lane in lanes.items() if id} == {1: "driving", 2: "shoulder", -1: "driving", -2: "curb"}
        assert (lanes[2].marks[0].type, lanes[1].marks[0].type) == ("edge", "solid")
        found = layers_of_opendrive(whole, CRS)
    else:
        draft, whole = as_lanelets(tmp_path, source)
        types = [way.tags["type"] for way in draft.ways]
        assert types.count("curbstone") == types.count("road_border") == 1
        found = layers_of_lanelets(whole, CRS)
    offsets = {row["edge"]: np.array(geometry.coords)[:, 1].mean() - 5792000.0 for geometry, row in found.road_edges}
    assert offsets == {"curb": pytest.approx(-3.5, abs=0.02), "pavement": pytest.approx(5.0, abs=0.02)}


def test_a_drawing_has_a_layer_for_each_kind_of_edge():
    edges = Features("LineStringZ", ROAD_EDGES)
    for what, height in (("curb", 0.12), ("curb", None), ("dropped", 0.02), ("pavement", None), (None, 0.1), (None, None)):
        edges.add(shapely.linestrings([[0, 0, 0], [1, 0, 0]]), edge=what, height_m=height)
    layers = [line.layer for line in dxf_lines(RoadMapSource(one_side_of_each(), road_edges=edges)) if line.layer.startswith("ROAD_EDGE")]
    assert layers == ["ROAD_EDGE_CURB", "ROAD_EDGE_CURB", "ROAD_EDGE_DROPPED", "ROAD_EDGE_PAVEMENT", "ROAD_EDGE_CURB", "ROAD_EDGE"]


def test_the_line_to_drive_on_stays_between_the_stripes_of_a_double_line():
    lanes = double_line()
    draft = draft_lanelets(with_shared_borders(checked(RoadMapSource(lanes))))
    for made in draft.lanelets:
        k = list(lanes.lane_id).index(made.name)
        np.testing.assert_allclose(draft.nodes[list(draft.ways[made.way("centerline")].nodes)], sum(lanes.borders(k)) / 2, atol=1e-6)
    assert len({made.way("left") for made in draft.lanelets if made.name in ("1.1.1", "1.2.1")}) == 1, \
        "both lanes meet in the middle of the double line"
