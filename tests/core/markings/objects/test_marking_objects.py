"""Markings written as a layer and read again."""

import dataclasses

import numpy as np
import pytest
import shapely
import shapely.affinity
from clustered_marks import FRAME, classes
from lanewright.core.common.features import MARKINGS, Features
from lanewright.core.markings.objects.cluster import cluster_markings
from lanewright.core.markings.objects.marking_objects import MarkingObjects, with_kinds_of
from painted_streets import oblique_bar, paint, road_points, strip


def test_a_layer_of_markings_that_is_read_again_gives_the_same_objects_and_with_other_names_the_same_polygons():
    oblique_crossing = [oblique_bar(30, k, 3.0, 0.5) for k in (-1, 0, 1)]
    points = road_points(paint(FRAME, [strip(5, 20, 3.0, 3.15), *oblique_crossing], density=2500), FRAME)
    objects, _ = cluster_markings(points, FRAME)
    layer = objects.to_features(FRAME)
    again = MarkingObjects.from_features(layer, FRAME)
    for name in ("road", "cluster", "kind", "keep", "length", "extent"):
        np.testing.assert_array_equal(getattr(again, name), getattr(objects, name))
    np.testing.assert_allclose(again.outlines.vertices, objects.outlines.vertices, rtol=0, atol=1e-8)
    renamed = with_kinds_of(layer, dataclasses.replace(again, kind=np.where(again.kind == "zebra", "hatch", again.kind)), FRAME)
    assert "zebra" in classes(layer) and classes(renamed) == sorted(name.replace("zebra", "hatch") for name in classes(layer))
    assert renamed.geometries == layer.geometries


def test_a_layer_drawn_by_hand_without_fields_or_with_an_empty_polygon_is_read():
    pole = shapely.box(*np.r_[FRAME.to_map(0, 10.0, 1.0), FRAME.to_map(0, 12.0, 1.2)].tolist())
    drawn = Features("PolygonZ", MARKINGS, [pole, None, shapely.union_all([pole, shapely.affinity.translate(pole, 5.0)])], [{}, {}, {}])
    found = MarkingObjects.from_features(drawn, FRAME)
    assert found.road.tolist() == [-1] * 3 and not found.keep.any()
    shapes = found.outlines.polygons(FRAME.origin)
    assert [shape.area for shape in shapes] == pytest.approx([pole.area, 0.0, 2 * pole.area])
