"""The print layout of a road map."""

import pytest
from lanewright.desktop.map_layout import MARGIN, road_map_layout
from lanewright.desktop.menu import unused_name
from qgis.core import (
    QgsFeature,
    QgsGeometry,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsProject,
    QgsVectorLayer,
)


@pytest.fixture
def project(qgis_app):
    project = QgsProject()
    yield project
    project.clear()


def street(project, angle=0.0):
    """Two edges of a street of 100 x 10 m, turned clockwise by so many degrees."""
    layer = QgsVectorLayer("LineString?crs=EPSG:32650", "Road edges", "memory")
    for y in (0, 10):
        feature = QgsFeature()
        geometry = QgsGeometry.fromWkt(f"LINESTRING(0 {y}, 100 {y})")
        geometry.rotate(angle, QgsGeometry.fromWkt("POINT(0 0)").asPoint())
        feature.setGeometry(geometry)
        layer.dataProvider().addFeature(feature)
    layer.updateExtents()
    project.addMapLayer(layer)
    return layer


def item(layout, kind):
    return next(found for found in layout.items() if isinstance(found, kind))


@pytest.mark.parametrize("angle", [0, 30, 90, 145])
def test_the_road_lies_along_the_page_whichever_way_it_runs(project, angle):
    layout = road_map_layout(project, [street(project, angle)], "A street")
    chart = item(layout, QgsLayoutItemMap)
    assert abs((chart.mapRotation() + angle + 90) % 180 - 90) < 1
    assert chart.extent().width() == pytest.approx(100 + 2 * MARGIN, rel=0.01)


@pytest.mark.parametrize("angle", [0, 30, 145])
def test_the_north_arrow_points_north_on_the_turned_map(project, angle):
    layout = road_map_layout(project, [street(project, angle)], "A street")
    arrow, chart = item(layout, QgsLayoutItemPicture), item(layout, QgsLayoutItemMap)
    assert not arrow.isMissingImage()
    assert abs((arrow.pictureRotation() - chart.mapRotation() + 180) % 360 - 180) < 0.01


def test_the_scale_bar_is_a_part_of_the_page(project):
    layout = road_map_layout(project, [street(project)], "A street")
    bar, chart = item(layout, QgsLayoutItemScaleBar), item(layout, QgsLayoutItemMap)
    assert 0.05 < bar.rect().width() / chart.rect().width() < 0.35


def test_the_legend_lists_what_is_drawn_as_lines_and_areas(project):
    layout = road_map_layout(project, [street(project)], "A street")
    assert [node.name() for node in item(layout, QgsLayoutItemLegend).model().rootGroup().findLayers()] == ["Road edges"]


def test_a_second_layout_gets_a_name_of_its_own(project):
    for expected in ("Lanewright – B12", "Lanewright – B12 2", "Lanewright – B12 3"):
        name = unused_name(project, "Lanewright – B12")
        assert name == expected
        layout = road_map_layout(project, [street(project)], name)
        assert project.layoutManager().addLayout(layout)
