"""The whole chain in one call, the stages one by one through files, and the model give one road map."""

import laspy
import numpy as np
import pytest
from osgeo import gdal, ogr

pytestmark = pytest.mark.slow

gdal.UseExceptions()
LAYERS = ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "CURVE_ELEMENTS")
FILES = {"ROAD_POINTS": "road_points.laz", "INTENSITY_IMAGE": "image.tif"}


@pytest.fixture(scope="module")
def survey(sample_survey):
    return sample_survey(LENGTH=60, RADIUS=60, PULSE_RATE=40000, ROTATION_RATE=100)


def destinations(folder):
    return {**{name: str(folder / f"{name.lower()}.gpkg") for name in LAYERS}, **{k: str(folder / v) for k, v in FILES.items()}}


@pytest.fixture(scope="module")
def one_call(survey, tmp_path_factory):
    import processing

    folder = tmp_path_factory.mktemp("one_call")
    report = str(folder / "report.html")
    processing.run("lanewright:roadmap", {
        "POINT_CLOUDS": [survey["POINT_CLOUD"]], "TRAJECTORY": survey["TRAJECTORY"], "REPORT": report, **destinations(folder),
    })
    return folder


@pytest.fixture(scope="module")
def stage_by_stage(survey, tmp_path_factory):
    import processing

    folder = tmp_path_factory.mktemp("stages")
    to = destinations(folder)
    drive, clouds = {"TRAJECTORY": survey["TRAJECTORY"]}, {"POINT_CLOUDS": [survey["POINT_CLOUD"]]}

    def run(stage, **values):
        return processing.run(f"lanewright:{stage}", values)

    run("detectboundaries", **clouds, **drive, ROAD_EDGES=to["ROAD_EDGES"])
    run("extractroadsurface", **clouds, **drive, ROAD_EDGES=to["ROAD_EDGES"], ROAD_POINTS=str(folder / "raw.laz"),
        ROAD_SURFACE=to["ROAD_SURFACE"])
    run("correctintensity", ROAD_POINTS=str(folder / "raw.laz"), **drive, OUTPUT=to["ROAD_POINTS"])
    run("intensityimage", ROAD_POINTS=to["ROAD_POINTS"], INTENSITY_IMAGE=to["INTENSITY_IMAGE"])
    run("extractmarkings", ROAD_POINTS=to["ROAD_POINTS"], INTENSITY_IMAGE=to["INTENSITY_IMAGE"], **drive,
        MARKING_POINTS=str(folder / "paint.laz"))
    run("removeoutliers", INPUT=str(folder / "paint.laz"), OUTPUT=str(folder / "kept.laz"))
    run("clustermarkings", MARKING_POINTS=str(folder / "kept.laz"), **drive, MARKINGS=str(folder / "clusters.gpkg"),
        CLUSTERED_POINTS=str(folder / "clustered.laz"))
    run("fitmarkinglines", CLUSTERED_POINTS=str(folder / "clustered.laz"), MARKINGS=str(folder / "clusters.gpkg"), **drive,
        ROAD_EDGES=to["ROAD_EDGES"], ROAD_POINTS=to["ROAD_POINTS"], MARKING_LINES=to["MARKING_LINES"], NAMED_MARKINGS=to["MARKINGS"])
    run("drivinglines", MARKING_LINES=to["MARKING_LINES"], MARKINGS=to["MARKINGS"], ROAD_EDGES=to["ROAD_EDGES"],
        ROAD_POINTS=to["ROAD_POINTS"], **drive, DRIVING_LINES=to["DRIVING_LINES"], CURVE_ELEMENTS=to["CURVE_ELEMENTS"])
    return folder


@pytest.fixture(scope="module")
def model(survey, tmp_path_factory):
    import processing

    folder = tmp_path_factory.mktemp("model")
    processing.run("lanewright:roadmapstages", {
        "POINT_CLOUDS": [survey["POINT_CLOUD"]], "TRAJECTORY": survey["TRAJECTORY"],
        **{name.lower(): path for name, path in destinations(folder).items()},
    })
    return folder


def rows(folder, name):
    """(coordinates, attributes) of every feature of a layer."""
    source = ogr.Open(str(folder / f"{name.lower()}.gpkg"))
    found = []
    for feature in source.GetLayer(0):
        geometry = feature.GetGeometryRef()
        places = []
        if geometry is not None:
            ring = geometry.GetGeometryRef(0) if geometry.GetGeometryCount() else geometry
            places = ring.GetPoints()
        found.append((np.array(places, float), feature.items()))
    return found


@pytest.mark.parametrize("other", ["stage_by_stage", "model"])
@pytest.mark.parametrize("name", LAYERS)
def test_layers_agree_to_the_millimetre(one_call, other, name, request):
    first, second = rows(one_call, name), rows(request.getfixturevalue(other), name)
    assert len(first) == len(second) > 0
    for (places, values), (other_places, other_values) in zip(first, second):
        np.testing.assert_allclose(places, other_places, rtol=0, atol=1e-3)
        for key, value in values.items():
            if isinstance(value, float):
                assert other_values[key] == pytest.approx(value, rel=1e-6, abs=1e-3), key
            elif key != "params":
                assert other_values[key] == value, key


@pytest.mark.parametrize("other", ["stage_by_stage", "model"])
def test_road_points_are_the_same_points(one_call, other, request):
    first, second = (laspy.read(str(folder / "road_points.laz")) for folder in (one_call, request.getfixturevalue(other)))
    assert first.points.array.tobytes() == second.points.array.tobytes()


@pytest.mark.parametrize("other", ["stage_by_stage", "model"])
def test_images_are_the_same_image(one_call, other, request):
    first, second = (gdal.Open(str(folder / "image.tif")) for folder in (one_call, request.getfixturevalue(other)))
    assert first.GetGeoTransform() == second.GetGeoTransform() and first.GetProjection() == second.GetProjection()
    assert first.ReadRaster() == second.ReadRaster()


def test_the_report_shows_the_map_and_how_far_apart_the_methods_of_boundaries_are(one_call):
    text = (one_call / "report.html").read_text(encoding="utf-8")
    assert "<img" in text and "Driving lines" in text and "Agreement of the two methods" in text


def test_curb_points_and_the_edges_through_them_are_the_edges_of_profiles(survey, tmp_path):
    import processing

    (tmp_path / "door").mkdir()
    drive, clouds = {"TRAJECTORY": survey["TRAJECTORY"]}, {"POINT_CLOUDS": [survey["POINT_CLOUD"]]}
    curbs, edges = str(tmp_path / "curbs.gpkg"), str(tmp_path / "road_edges.gpkg")
    processing.run("lanewright:detectcurbs", {**clouds, **drive, "CURB_POINTS": curbs})
    processing.run("lanewright:fitroadedges", {"CURB_POINTS": curbs, **drive, "ROAD_EDGES": edges})
    processing.run("lanewright:detectboundaries", {**clouds, **drive, "BOUNDARY_METHOD": "profiles",
                                                   "ROAD_EDGES": str(tmp_path / "door" / "road_edges.gpkg")})
    first, second = rows(tmp_path, "ROAD_EDGES"), rows(tmp_path / "door", "ROAD_EDGES")
    assert len(first) == len(second) > 0
    for (places, _), (other_places, _) in zip(first, second):
        np.testing.assert_allclose(places, other_places, rtol=0, atol=1e-3)


def test_heights_are_in_every_line(one_call):
    for name in ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES"):
        assert all(places.shape[1] == 3 for places, _ in rows(one_call, name)), name


def test_a_road_map_of_which_nothing_is_kept_is_not_begun(survey):
    import processing
    from qgis.core import QgsProcessingException

    with pytest.raises(QgsProcessingException, match="Name at least one output"):
        processing.run("lanewright:roadmap", {"POINT_CLOUDS": [survey["POINT_CLOUD"]], "TRAJECTORY": survey["TRAJECTORY"]})
