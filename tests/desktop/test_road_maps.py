"""A road map is one by what its layers say of themselves, whoever put them into the project."""

import pytest
from lanewright.algorithms.provenance import Provenance, provenance_now
from lanewright.core.common.features import DRIVING_LINES, MARKING_LINES, ROAD_EDGES, ROAD_SURFACE
from lanewright.desktop.review.doubtful import doubts_of
from lanewright.desktop.review.section import section_at
from lanewright.processing_provider.results.road_maps import clouds_lie_in, clouds_of, place_layer, road_map_of, road_maps, runs_of
from lanewright.processing_provider.styling import embed_style
from qgis.core import QgsRasterLayer, QgsVectorFileWriter, QgsVectorLayer
from road_map_layers import CLOUDS, EAST, NORTH, added, run_at

BRIDGED = ("LINESTRING Z (10 0 100, 30 0 100)", dict(road=0, station_m=10.0, length_m=20.0, side="left", status="bridged"))


@pytest.fixture
def colleagues(project, tmp_path):
    """A GeoPackage of a colleague, whose tables are called as the colleague likes; the survey lay beside it."""
    path = tmp_path / "from a colleague" / "B12 final.gpkg"
    path.parent.mkdir()
    given = {"POINT_CLOUDS": ["/nowhere/B12/a.laz", "/nowhere/B12/b.laz"], "TRAJECTORY": "drive.csv", "MIN_HEIGHT": 0.08}
    provenance = provenance_now("roadmap", given)
    lane = ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0, lane=1, length_m=40.0))
    for table, output, schema, row in (("borders", "ROAD_EDGES", ROAD_EDGES, BRIDGED), ("lanes in the middle", "DRIVING_LINES", DRIVING_LINES, lane)):
        layer = added(project, output, schema, row)
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.layerName = table
        if path.exists():
            options.actionOnExistingFile = QgsVectorFileWriter.ActionOnExistingFile.CreateOrOverwriteLayer
        QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(path), project.transformContext(), options)
        embed_style(output, f"{path}|layername={table}", table, schema, provenance)
    project.clear()
    return path


def dropped(project, path, *tables):
    """Tables as QGIS adds them when a file is dropped into its window."""
    layers = [QgsVectorLayer(f"{path}|layername={table}", table, "ogr") for table in tables]
    project.addMapLayers(layers)
    return layers


def test_a_geopackage_of_a_colleague_is_a_road_map(project, colleagues):
    borders, lanes = dropped(project, colleagues, "borders", "lanes in the middle")
    road_map, = road_maps(project)
    assert road_map.layer("ROAD_EDGES") == borders and road_map.layer("DRIVING_LINES") == lanes
    assert road_map.survey == "B12" and road_map.values["MIN_HEIGHT"] == 0.08 and road_map.name.startswith("B12, 20")
    places = doubts_of(road_map)
    assert [place.station for place in places] == [10.0] and "Road edge, left" in places[0].pieces[0].text
    assert section_at(EAST + 20, NORTH, road_map.vectors).azimuth == pytest.approx(90.0)


def test_other_layers_are_no_road_map(project, colleagues):
    mine = QgsVectorLayer("LineString?crs=EPSG:32650&field=road:integer&field=station_m:double", "Road edges", "memory")
    project.addMapLayer(mine)
    assert road_maps(project) == [] and road_map_of(mine, project) is None


def test_point_clouds_that_lie_beside_the_geopackage_are_found_and_moved_ones_once_their_folder_is_named(project, colleagues, tmp_path):
    dropped(project, colleagues, "borders")
    assert clouds_of(road_maps(project)[0], project) == ([], ["/nowhere/B12/a.laz", "/nowhere/B12/b.laz"])
    beside = colleagues.parent / "a.laz"
    beside.touch()
    assert clouds_of(road_maps(project)[0], project) == ([str(beside)], ["/nowhere/B12/b.laz"])
    moved = tmp_path / "archive" / "2026" / "b.laz"
    moved.parent.mkdir(parents=True)
    moved.touch()
    assert clouds_lie_in(road_maps(project)[0], str(tmp_path / "archive"), project) == []
    assert clouds_of(road_maps(project)[0], project) == ([str(beside), str(moved)], [])


def test_the_road_map_of_the_active_layer_comes_first_and_then_the_newest(project):
    lane = ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0, lane=1))
    by_hour = {hour: added(project, "DRIVING_LINES", DRIVING_LINES, lane, run=run_at(hour)) for hour in (9, 12, 10)}
    order = lambda active: [road_map.provenance.ended.hour for road_map in road_maps(project, active)]  # noqa: E731
    assert order(None) == [12, 10, 9] and order(by_hour[9]) == [9, 12, 10]


def test_a_stage_that_was_run_again_takes_the_place_of_its_result_in_the_map(project):
    lane = ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0, lane=1))
    old = added(project, "DRIVING_LINES", DRIVING_LINES, lane)
    lines = added(project, "MARKING_LINES", MARKING_LINES, lane[:1] + (dict(road=0, line=1),))
    again = run_at(9, [], algorithm="drivinglines")
    new = added(project, "DRIVING_LINES", DRIVING_LINES, lane, run=type(again)(again.provenance, "", "B12, 8:00"))
    road_map, = road_maps(project)
    assert road_map.layer("DRIVING_LINES") == new and road_map.layer("MARKING_LINES") == lines and road_map.older == (old,)
    assert not project.layerTreeRoot().findLayer(old.id()).itemVisibilityChecked()


def test_the_old_map_of_a_survey_is_hidden_when_it_is_made_again_and_maps_of_others_stay(project):
    lane = ("LINESTRING Z (0 0 100, 40 0 100)", dict(road=0, lane=1))
    other = run_at(7, ["/data/B13/a.laz"], "B13")
    for run in (other, run_at(8), run_at(9)):
        added(project, "DRIVING_LINES", DRIVING_LINES, lane, run=run)
    seen = {group.name(): group.itemVisibilityChecked() for group in project.layerTreeRoot().findGroups()}
    assert seen == {"B13, 7:00": True, "B12, 8:00": False, "B12, 9:00": True}


def test_the_image_below_the_asphalt_is_off_until_it_is_wanted(project):
    """Of it the plan would show a dark fringe; alone it is shown."""
    def image(run):
        layer = QgsRasterLayer("MEM:::", "Intensity image")
        project.addMapLayer(layer, False)
        group = project.layerTreeRoot().findGroup(run.group) or project.layerTreeRoot().addGroup(run.group)
        group.addLayer(layer)
        place_layer(layer, project, "INTENSITY_IMAGE", run)
        return project.layerTreeRoot().findLayer(layer.id())

    ground = ("POLYGON Z ((0 0 100, 40 0 100, 40 7 100, 0 7 100, 0 0 100))", dict(road=0))
    alone, before = image(run_at(7, ["/data/B13/a.laz"], "B13")), image(run_at(8))
    added(project, "ROAD_SURFACE", ROAD_SURFACE, ground)
    assert alone.itemVisibilityChecked() and not before.itemVisibilityChecked()
    before.setItemVisibilityChecked(True)
    added(project, "ROAD_EDGES", ROAD_EDGES, BRIDGED)
    assert before.itemVisibilityChecked(), "who has switched it on keeps it"


def test_it_can_be_made_again_from_all_that_it_was_made_from(project):
    added(project, "ROAD_EDGES", ROAD_EDGES, BRIDGED, run=run_at(8, TRAJECTORY="/data/B12/drive.csv", MIN_HEIGHT=0.08, CRS=None))
    assert road_maps(project)[0].values == {"POINT_CLOUDS": CLOUDS, "TRAJECTORY": "/data/B12/drive.csv", "MIN_HEIGHT": 0.08}


def test_a_table_of_an_earlier_version_is_known_by_its_name(project, colleagues):
    layer, = dropped(project, colleagues, "borders")
    metadata = layer.metadata()
    metadata.setHistory([Provenance("roadmap", "0.3", {}, run_at(8).provenance.ended).sentence()])
    layer.setMetadata(metadata)
    assert runs_of(project)[0].outputs == ("",)
    project.removeMapLayer(layer)
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.layerName, options.actionOnExistingFile = "north_road_edges", QgsVectorFileWriter.ActionOnExistingFile.CreateOrOverwriteLayer
    source = QgsVectorLayer(f"{colleagues}|layername=borders", "borders", "ogr")
    QgsVectorFileWriter.writeAsVectorFormatV3(source, str(colleagues), project.transformContext(), options)
    layer, = dropped(project, colleagues, "north_road_edges")
    layer.setMetadata(metadata)
    assert runs_of(project)[0].outputs == ("ROAD_EDGES",)


def test_a_geopackage_that_the_library_wrote_is_a_road_map(project, tmp_path):
    from lanewright.core.common.features import Features
    from lanewright.library.layer_files import write_layer
    from shapely.geometry import LineString

    edges = Features("LineStringZ", ROAD_EDGES)
    edges.add(LineString([(EAST, NORTH, 100.0), (EAST + 20, NORTH, 100.0)]), road=0, station_m=0.0, length_m=20.0, status="bridged")
    edges.description = run_at(8).provenance.sentence("ROAD_EDGES")
    write_layer(str(tmp_path / "north.gpkg"), "", edges, lambda: None)
    layer, = dropped(project, tmp_path / "north.gpkg", "north")
    road_map, = road_maps(project)
    assert road_map.layer("ROAD_EDGES") == layer and road_map.survey == "B12"
