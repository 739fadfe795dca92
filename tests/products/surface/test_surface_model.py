"""Surfaces of roads whose shape is known: breaklines where the ground bends, and triangles that keep to a tolerance."""

from functools import cache

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.products.cad import landxml_text, surface_lines, write_dxf
from lanewright.products.export.xml_tree import read_xml
from lanewright.products.inventory.borders import BorderLayers
from lanewright.products.surface.model import SurfaceSettings, make_surface_model, surface_to_features, write_heights
from lanewright.products.surface.triangulation import Triangulation
from map_files import written
from measured_streets import EAST, GROUND, HALF, NORTH, Drive, crossing_roads, edges_of, lanes_of, measured_road, surface

gdal = pytest.importorskip("osgeo.gdal")
GRADE = 0.03


def model_of(tolerance=0.005, lanes=False, reach=2.0, edges=None, **road):
    survey = measured_road(density=road.pop("density", 900.0), grade=GRADE, **road)
    layers = BorderLayers(edges_of() if edges is None else edges, lanes=lanes_of() if lanes else None)
    return make_surface_model(survey, layers, SurfaceSettings(tolerance=tolerance, reach=reach))


@cache
def plain_model():
    """The model of the road as it is by default, made once."""
    return model_of()


def on_road(model, places):
    """(x, y, z) along, left of and above the beginning of the road, of (..., 3) places of the model."""
    return np.moveaxis(places + model.origin - np.array([EAST, NORTH, GROUND]), -1, 0)


def misses(model, across, **road):
    """m by which the triangles lie above the true road at places across it, every 30 cm along it."""
    x, y = np.meshgrid(np.arange(2.0, 58.0, 0.3), across)
    found = model.surface.heights((x + EAST - model.origin[0]).ravel(), (y + NORTH - model.origin[1]).ravel()) + model.origin[2] - GROUND
    return found - (surface(y, **road) + GRADE * x).ravel()


def lines_of(model, kind):
    return [on_road(model, line.places) for line in model.lines if line.kind == kind]


def test_the_triangles_keep_to_five_millimetres_of_the_true_road_with_a_hundredth_of_the_points():
    road = dict(crossfall=0.025, rut=0.012, curb=0.12)
    model = model_of(noise=0.005, **road)
    miss = misses(model, np.r_[np.arange(-3.4, 3.41, 0.1), np.arange(3.7, 5.0, 0.1), -np.arange(3.7, 5.0, 0.1)], **road)
    assert np.isfinite(miss).all() and np.sqrt(np.mean(miss**2)) < 0.005 and model.rmse <= 0.005
    assert model.vertices < 0.01 * model.points


@pytest.mark.parametrize("curb", [0.04, 0.12])
def test_a_curb_breaks_the_surface_along_its_bottom_and_its_top(curb):
    model = model_of(curb=curb, noise=0.004)
    for kind, height in (("edge_bottom", 0.0), ("edge_top", curb)):
        lines = lines_of(model, kind)
        assert sum(np.ptp(x) for x, _, _ in lines) > 2 * 55
        for x, y, z in lines:
            assert np.abs(np.abs(y) - HALF).max() < 0.06
            assert np.sqrt(np.mean((z - GRADE * x + 0.025 * HALF - height) ** 2)) < 0.005
    assert [line.step for line in model.lines if line.kind == "edge_top"] == pytest.approx([curb, curb], abs=0.004)


def test_an_edge_without_a_step_has_no_top():
    assert not lines_of(model_of(curb=0.0), "edge_top")


def test_a_road_that_falls_to_both_sides_has_a_crown_and_one_that_falls_to_one_side_has_none():
    (x, y, z), = lines_of(model_of(crossfall=0.025, noise=0.004), "crown")
    assert np.ptp(x) > 50 and np.abs(y).max() < 0.25
    np.testing.assert_allclose(z, GRADE * x, atol=0.006)
    assert not lines_of(model_of(crossfall=0.025, crown=False, noise=0.004), "crown")


def test_water_runs_along_the_curb_on_the_lower_side_alone():
    (_, y, _), = lines_of(model_of(crossfall=0.025, crown=False, noise=0.004), "gutter_flow_line")
    assert (y > 3.0).all() or (y < -3.0).all()


def test_borders_of_lanes_lie_on_the_road_and_those_at_a_curb_are_its_line():
    lines = lines_of(model_of(lanes=True, noise=0.004), "lane_border")
    assert {round(float(np.median(y)), 1) for _, y, _ in lines} == {-3.0, 0.0}
    for x, y, z in lines:
        np.testing.assert_allclose(z, surface(y) + GRADE * x, atol=0.008)


def test_every_line_that_is_followed_is_made_of_edges_of_triangles():
    model = model_of(lanes=True)
    faces, places = model.surface.faces, model.surface.vertices[:, :2]
    edges = {tuple(sorted(edge)) for face in faces.tolist() for edge in zip(face, face[1:] + face[:1])}
    number = {place.tobytes(): k for k, place in enumerate(places)}
    assert {kind for kind, _ in model.followed} == {"edge_bottom", "edge_top", "crown", "lane_border"}
    for _, line in model.followed:
        for a, b in zip(line[:-1, :2], line[1:, :2]):
            assert tuple(sorted((number[a.tobytes()], number[b.tobytes()]))) in edges


def test_the_surface_is_right_to_the_end_of_the_road():
    """Straight from one sidewalk to the other, its last triangles would lie above the road between them."""
    model = model_of(noise=0.004)
    x, y = (values.ravel() for values in np.meshgrid([0.53, 0.56, 0.8, 1.2, 58.8, 59.2, 59.44, 59.47], np.arange(-3.2, 3.3, 0.2)))
    found = model.surface.heights(x + EAST - model.origin[0], y + NORTH - model.origin[1]) + model.origin[2] - GROUND
    np.testing.assert_allclose(found, surface(y) + GRADE * x, atol=0.03)


def test_a_greater_tolerance_takes_fewer_triangles():
    road = dict(rut=0.02, noise=0.004)
    fine, coarse = model_of(0.003, **road), model_of(0.02, **road)
    assert len(coarse.surface.faces) < 0.5 * len(fine.surface.faces) and fine.rmse < 0.003 < coarse.rmse < 0.02


def test_a_vehicle_on_the_road_is_no_ground():
    def van(rng):
        return rng.uniform(20.0, 25.0, 20_000), rng.uniform(1.0, 3.0, 20_000), rng.uniform(0.3, 2.2, 20_000)

    def beneath(_, x, y, z):
        return (x > 20.0) & (x < 25.0) & (y > 1.0) & (y < 3.0) & (z < 0.25)

    model = model_of(above=van, hides=beneath)
    assert np.abs(misses(model, np.arange(-3.3, 3.4, 0.1))).max() < 0.03


def test_passes_that_lie_above_each_other_make_one_smooth_surface():
    drives = (Drive(1, -1.75, 0.0, 0.01), Drive(-1, 1.75, 0.0, -0.01))
    miss = misses(model_of(drives=drives), np.arange(-3.3, 3.4, 0.1))
    assert np.std(miss) < 0.003


def test_a_road_that_is_driven_the_other_way_has_the_same_surface():
    one, other = (model_of(drives=(Drive(direction, -1.75),), noise=0.0) for direction in (1, -1))
    x, y = (values.ravel() for values in np.meshgrid(np.arange(3.0, 57.0, 0.5), np.arange(-3.3, 3.4, 0.1)))
    heights = [model.surface.heights(x + EAST - model.origin[0], y + NORTH - model.origin[1]) + model.origin[2] for model in (one, other)]
    assert np.sqrt(np.mean((heights[0] - heights[1]) ** 2)) < 0.004


def test_edges_far_from_the_road_and_no_edges_are_refused():
    far = Features("LineStringZ", ROAD_EDGES)
    far.add(shapely.linestrings([(EAST, NORTH + 900.0, 0.0), (EAST + 60.0, NORTH + 900.0, 0.0)]), road=0, side="left", kind="main", part="bottom")
    for edges in (far, Features("LineStringZ", ROAD_EDGES)):
        with pytest.raises(RoadExtractionError, match="road edges"):
            model_of(edges=edges)


def test_a_road_with_an_edge_on_one_side_alone_is_refused_by_saying_so():
    left = Features("LineStringZ", ROAD_EDGES, [shape for shape, _ in edges_of()][:1], [row for _, row in edges_of()][:1])
    with pytest.raises(RoadExtractionError, match="one on either side"):
        model_of(edges=left)


def test_a_road_of_two_metres_is_too_short_for_a_surface():
    with pytest.raises(RoadExtractionError, match="No ground was seen"):
        model_of(length=2.0, edges=edges_of(2.0))


@pytest.mark.parametrize("up", [0.0, 6.0])
def test_where_a_road_crosses_above_another_the_surface_has_the_upper_one(up):
    survey, edges = crossing_roads(up)
    model = make_surface_model(survey, BorderLayers(edges))
    places = model.surface.vertices[model.surface.faces]
    assert np.ptp(places[:, :, 2], axis=1).max() < 0.3 and model.rmse < 0.005   # no wall from one road to the other
    y, x = (values.ravel() for values in np.meshgrid(np.arange(-25.0, 25.1, 0.5), np.arange(-3.2, 3.3, 0.2)))
    heights = model.surface.heights(EAST + x - model.origin[0], NORTH + y - model.origin[1]) + model.origin[2] - GROUND - up
    on_deck = np.abs(y) > 8.0 if up == 0.0 else np.full(len(y), True)   # level roads have each other's shape in between
    np.testing.assert_allclose(heights[on_deck], surface(x[on_deck]), atol=0.03)
    assert [note for note in model.notes if "0 and 1" in note] == model.notes and len(model.notes) == (up > 0.0)


def test_where_a_narrow_road_joins_a_wide_one_the_corners_of_the_wide_one_are_covered():
    survey, edges = crossing_roads(0.0, halves=(5.0, 2.0))
    model = make_surface_model(survey, BorderLayers(edges), SurfaceSettings(reach=0.5))
    x, y = (values.ravel() for values in np.meshgrid(np.arange(-20.0, 20.1, 0.5), np.arange(-4.8, 4.9, 0.2)))
    assert np.isfinite(model.surface.heights(EAST + x - model.origin[0], NORTH + y - model.origin[1])).all()


def test_tops_of_curbs_and_edges_without_length_or_twice_change_nothing():
    """Layers of boundaries have both lines of a curb, 5 cm apart, and neighbouring surveys a line each."""
    edges = edges_of()
    for shape, row in list(edges):
        outward = 0.05 if row["side"] == "left" else -0.05
        edges.add(shapely.transform(shape, lambda places, outward=outward: places + [0.0, outward, 0.12], include_z=True), **{**row, "part": "top"})
        edges.add(shapely.linestrings(shapely.get_coordinates(shape, include_z=True)[[0, 0]]), **row)
        edges.add(shapely.line_merge(shapely.segmentize(shape, 7.0)), **row)
    one, other = plain_model(), model_of(edges=edges)
    assert [line.kind for line in one.lines] == [line.kind for line in other.lines]
    assert len(one.surface.faces) == len(other.surface.faces)


# A triangulation that is made to follow segments.

@pytest.mark.parametrize("seed", range(5))
def test_segments_across_other_triangles_become_edges_and_nothing_is_lost(seed):
    rng = np.random.default_rng(seed)
    x = np.linspace(0.0, 40.0, 5)
    lines = [np.stack([x, np.full(5, y), 0.1 * y + 0 * x], axis=1) for y in (4.0, 4.05, 8.0)]
    places = rng.uniform((-1, -1), (41, 11), (400, 2))
    places = places[np.abs(places[:, 1, None] - [4.0, 4.05, 8.0]).min(axis=1) > 0.2]
    vertices = np.concatenate([*lines, np.c_[places, 0.1 * places[:, 1]]])
    segments = np.array([(5 * line + k, 5 * line + k + 1) for line in range(3) for k in range(4)])
    found = Triangulation(vertices, segments)
    edges = {tuple(sorted(edge)) for face in found.faces.tolist() for edge in zip(face, face[1:] + face[:1])}
    assert {tuple(segment) for segment in segments.tolist()} <= edges
    shapes = shapely.polygons(vertices[found.faces][:, :, :2])
    hull = shapely.convex_hull(shapely.multipoints(vertices[:, :2]))
    assert shapely.area(shapes).sum() == pytest.approx(hull.area) == shapely.union_all(shapes).area
    x, y = rng.uniform((1, 1), (39, 9), (500, 2)).T
    np.testing.assert_allclose(found.heights(x, y), 0.1 * y, atol=1e-9)


@pytest.mark.parametrize("segments, made", [([(0, 10)], set()), ([(0, 10), (0, 8), (2, 24)], {(0, 8)})])
def test_a_segment_through_other_vertices_changes_nothing(segments, made):
    x, y = (values.ravel().astype(float) for values in np.meshgrid(range(5), range(5)))
    faces = Triangulation(np.stack([x, y, 0.0 * x], axis=1), np.array(segments)).faces
    edges = {tuple(sorted(edge)) for face in faces.tolist() for edge in zip(face, face[1:] + face[:1])}
    assert edges & set(segments) == made and len(faces) == 32


# Files.

def test_a_landxml_surface_has_the_triangles_and_breaklines_of_the_model(tmp_path):
    model = plain_model()
    root = read_xml(written(tmp_path, landxml_text((), surface=model), "surface.xml"), "LandXML", "a LandXML file")
    assert [child.tag for child in root.children] == ["Units", "Project", "Application", "Surfaces"]
    element = root.find("Surfaces", "Surface")
    assert [child.tag for child in element.children] == ["SourceData", "Definition"]
    assert [child.tag for child in element.find("Definition").children] == ["Pnts", "Faces"]
    points = {int(point.get("id")): np.array(point.text.split(), float) for point in element.find("Definition", "Pnts").all("P")}
    faces = [[points[int(number)] for number in face.text.split()] for face in element.find("Definition", "Faces").all("F")]
    assert len(faces) == len(model.surface.faces) and len(points) == model.vertices
    north, east, height = np.array(faces).reshape(-1, 3).T
    assert NORTH - 7 < north.min() and north.max() < NORTH + 7 and EAST - 1 < east.min() and east.max() < EAST + 61
    np.testing.assert_allclose(height - GROUND - GRADE * (east - EAST), surface(north - NORTH), atol=0.13)
    lines = list(element.find("SourceData", "Breaklines").all("Breakline"))
    assert {line.get("brkType") for line in lines} == {"standard"} and {line.get("name") for line in lines} >= {"edge_bottom", "edge_top", "crown"}
    assert {tuple(np.round(places.reshape(-1, 3)[0], 3)) for places in (np.array(line.find("PntList3D").text.split(), float) for line in lines)} <= {
        tuple(np.round(point, 3)) for point in points.values()}


def test_a_dxf_surface_has_faces_and_lines_in_their_layers(tmp_path):
    model, path = plain_model(), str(tmp_path / "surface.dxf")
    write_dxf(surface_lines(model), path, faces=model.places[model.surface.faces])
    found = {}
    dataset = gdal.OpenEx(path)
    for feature in dataset.GetLayer(0):
        found.setdefault(feature.GetField("Layer"), []).append(shapely.from_wkb(bytes(feature.GetGeometryRef().ExportToWkb())))
    assert set(found) == {"SURFACE", "BREAKLINE_EDGE_BOTTOM", "BREAKLINE_EDGE_TOP", "BREAKLINE_CROWN"}
    assert len(found["SURFACE"]) == len(model.surface.faces)
    covered = shapely.area(shapely.polygons(model.surface.vertices[model.surface.faces])).sum()
    assert shapely.area(found["SURFACE"]).sum() == pytest.approx(covered, rel=1e-4)
    assert all(shape.has_z for shapes in found.values() for shape in shapes)


def test_the_raster_has_the_heights_of_the_road_and_none_beside_it(tmp_path):
    model = model_of(reach=1.0)
    write_heights(model, tmp_path / "heights.tif", 0.2)
    dataset = gdal.Open(str(tmp_path / "heights.tif"))
    left, size, _, top, _, _ = dataset.GetGeoTransform()
    heights = np.frombuffer(dataset.GetRasterBand(1).ReadRaster(buf_type=gdal.GDT_Float32), np.float32).reshape(dataset.RasterYSize, -1)
    x, y = np.meshgrid(left + (np.arange(dataset.RasterXSize) + 0.5) * size - EAST, top - (np.arange(dataset.RasterYSize) + 0.5) * size - NORTH)
    road = (np.abs(y) < HALF - 0.1) & (x > 1) & (x < 59)
    np.testing.assert_allclose(heights[road] - GROUND, (surface(y) + GRADE * x)[road], atol=0.015)
    assert (heights[np.abs(y) > HALF + 1.2] == dataset.GetRasterBand(1).GetNoDataValue()).all()


def test_the_layers_say_what_every_line_and_triangle_is():
    lines, faces = surface_to_features(plain_model())
    assert {row["kind"] for row in lines.rows} == {"edge_bottom", "edge_top", "gutter_flow_line", "crown"}
    assert all(0 < row["sigma_z_m"] < 0.01 and row["length_m"] > 5 for row in lines.rows)
    assert {row["status"] for row in faces.rows} == {"measured"}
    assert sum(row["area_m2"] for row in faces.rows) == pytest.approx(60 * (2 * HALF + 4), rel=0.05)
