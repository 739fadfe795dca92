"""The drawn image: every field of the chequered ground lies where it is, whatever the image was."""

import numpy as np
import pytest
from flown_images import HEIGHT, WIDTH, chequered, ground, measured
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.products.overlay.control_points import control_points, open_image
from lanewright.products.overlay.georeference import GeoreferenceSettings, draw_image, georeference, output_grid
from osgeo import gdal

RIMS = [(p, q) for p in (0, 150, 300, 450, 600) for q in (0, 130, 270, 400)]


def drawn(tmp_path, order=2, kind=gdal.GDT_Byte, bands=3, driver="GTiff", suffix="tif", distortion=None, settings=None, **more):
    """The drawn dataset and its Georeferencing, of an image with control points all over it."""
    path = tmp_path / f"flown.{suffix}"
    chequered(path, bands, kind, driver, **more)
    points = measured(places=RIMS, **({"bend": 0.03 if order > 1 else 0.0} if distortion is None else distortion))
    found = georeference(open_image(path), points, GeoreferenceSettings(order=order, **(settings or {})))
    result = tmp_path / "drawn.tif"
    off = draw_image(found, result)
    assert off < 0.1
    return gdal.Open(str(result)), found


def fields_lie_where_they_are(dataset, found, light=200.0, field=20):
    """The brightness in the middle of every field, where the polynomial says it lies on the map."""
    pixel, line = np.meshgrid(np.arange(field / 2, WIDTH, field), np.arange(field / 2, HEIGHT, field))
    east, north = found.fit.polynomial.to_map(pixel.ravel(), line.ravel())
    x0, size, _, y0, _, _ = dataset.GetGeoTransform()
    column, row = np.floor((east - x0) / size).astype(int), np.floor((y0 - north) / size).astype(int)
    seen = dataset.GetRasterBand(1).ReadAsArray().astype(float)[row, column]
    expected = np.where((pixel // field + line // field) % 2, light, 0.15 * light).ravel()
    np.testing.assert_allclose(seen, expected, atol=0.12 * light)


@pytest.mark.parametrize("order, distortion", [
    (1, {"bend": 0.0}), (2, {"bend": 0.03}), (2, {"bend": 0.15}), (3, {"bend": 0.03, "twist": 0.02}), (1, {"bend": 0.0, "turn": 2.5})])
def test_every_field_lies_where_the_polynomial_puts_it(order, distortion, tmp_path):
    fields_lie_where_they_are(*drawn(tmp_path, order, distortion=distortion))


@pytest.mark.parametrize("order, bend", [(1, 0.0), (2, 0.03)])
def test_an_image_with_control_points_in_feet_is_drawn_in_feet_where_it_lies_in_metres(order, bend, tmp_path):
    dataset, found = drawn(tmp_path, order, distortion={"bend": bend})
    pixel, line = np.transpose(RIMS)
    foot = 1200 / 3937
    rows = np.c_[pixel, line, np.transpose(ground(pixel, line, bend=bend)) / foot].tolist()
    points = control_points(["pixel", "line", "easting", "northing"], rows, open_image(tmp_path / "flown.tif"), "The table", "EPSG:2263")
    in_feet = georeference(open_image(tmp_path / "flown.tif"), points, GeoreferenceSettings(order=order))
    assert draw_image(in_feet, tmp_path / "feet.tif") < 0.1
    image = gdal.Open(str(tmp_path / "feet.tif"))
    assert "New York" in image.GetProjection() and "US survey foot" in image.GetProjection()
    np.testing.assert_allclose(np.array(image.GetGeoTransform()) * foot, dataset.GetGeoTransform(), atol=1e-6)
    assert (image.RasterXSize, image.RasterYSize) == (dataset.RasterXSize, dataset.RasterYSize)
    np.testing.assert_allclose(image.ReadAsArray().astype(float), dataset.ReadAsArray().astype(float), atol=4)
    assert open_image(tmp_path / "feet.tif").geotransform == pytest.approx(dataset.GetGeoTransform())


def test_edges_stay_sharp_in_a_turned_image_to_its_rim(tmp_path):
    """GDAL guesses a scale from each window's extent and would blur the corners of a turned image."""
    dataset, found = drawn(tmp_path, 1, distortion={"bend": 0.0, "turn": 1.4})
    values, alpha = dataset.GetRasterBand(1).ReadAsArray(), dataset.GetRasterBand(4).ReadAsArray()
    grey = (values > 80) & (values < 150) & (alpha == 255)
    down, across = np.nonzero(alpha == 255)
    for row in np.array_split(np.arange(values.shape[0]), 4):
        for column in np.array_split(np.arange(values.shape[1]), 3):
            inside = alpha[np.ix_(row, column)] == 255
            if inside.sum() > 2000:
                assert grey[np.ix_(row, column)].sum() / inside.sum() < 0.12


@pytest.mark.parametrize("driver, suffix, bands", [("GTiff", "tif", 1), ("PNG", "png", 3), ("JPEG", "jpg", 3), ("JPEG", "jpeg", 1)])
def test_images_of_any_kind_get_an_alpha_band_of_their_own(driver, suffix, bands, tmp_path):
    dataset, found = drawn(tmp_path, 1, driver=driver, suffix=suffix, bands=bands)
    assert dataset.RasterCount == bands + 1
    assert dataset.GetRasterBand(bands + 1).GetColorInterpretation() == gdal.GCI_AlphaBand
    fields_lie_where_they_are(dataset, found)


def test_a_large_image_stored_by_lines_is_drawn_like_any_other(tmp_path, monkeypatch):
    from lanewright.products.overlay import georeference as warping

    before = gdal.GetCacheMax()
    monkeypatch.setattr(warping, "GDAL_CACHE", 500_000)
    dataset, found = drawn(tmp_path, 2, driver="PNG", suffix="png", distortion={"bend": 0.03, "turn": 1.4})
    fields_lie_where_they_are(dataset, found)
    assert gdal.GetCacheMax() == before
    assert {file.name for file in tmp_path.iterdir()} == {"flown.png", "drawn.tif"}


def test_an_alpha_band_that_is_there_is_kept(tmp_path):
    dataset, found = drawn(tmp_path, 1, bands=4, alpha=True, driver="PNG", suffix="png")
    assert dataset.RasterCount == 4
    alpha = dataset.GetRasterBand(4).ReadAsArray()
    assert (alpha > 0).sum() == pytest.approx((WIDTH - 100) * HEIGHT, rel=0.01)


@pytest.mark.parametrize("kind, light, nodata", [(gdal.GDT_UInt16, 40_000.0, 0.0), (gdal.GDT_Float32, 21.5, np.nan)])
def test_values_beyond_bytes_stay_as_they_are(kind, light, nodata, tmp_path):
    dataset, found = drawn(tmp_path, 2, kind=kind, bands=1, settings={"resampling": "nearest"})
    assert dataset.RasterCount == 1 and dataset.GetRasterBand(1).DataType == kind
    np.testing.assert_equal(dataset.GetRasterBand(1).GetNoDataValue(), nodata)
    fields_lie_where_they_are(dataset, found, light)
    values = dataset.GetRasterBand(1).ReadAsArray().astype(float)
    found = np.unique(values[np.isfinite(values) & (values != 0)])
    np.testing.assert_allclose(found, [0.15 * light, light], rtol=1e-3)


def test_a_palette_becomes_colours(tmp_path):
    path = tmp_path / "palette.png"
    memory = gdal.GetDriverByName("MEM").Create("", WIDTH, HEIGHT, 1)
    colours = gdal.ColorTable()
    colours.SetColorEntry(0, (10, 20, 30))
    colours.SetColorEntry(1, (200, 100, 50))
    memory.GetRasterBand(1).SetColorTable(colours)
    memory.GetRasterBand(1).WriteArray(np.where(np.arange(WIDTH) < 300, 0, 1)[None].repeat(HEIGHT, 0))
    gdal.GetDriverByName("PNG").CreateCopy(str(path), memory)
    found = georeference(open_image(path), measured(places=RIMS, bend=0.0), GeoreferenceSettings(order=1))
    draw_image(found, tmp_path / "drawn.tif")
    dataset = gdal.Open(str(tmp_path / "drawn.tif"))
    assert dataset.RasterCount == 4
    assert dataset.GetRasterBand(2).ReadAsArray().max() == 100


def test_the_result_has_crs_tiles_compression_and_overviews(tmp_path):
    dataset, found = drawn(tmp_path, 1)
    assert dataset.GetSpatialRef().GetAuthorityCode(None) == "32650"
    assert dataset.GetRasterBand(1).GetBlockSize() == [512, 512]
    assert dataset.GetMetadata("IMAGE_STRUCTURE")["COMPRESSION"] == "DEFLATE"
    assert dataset.GetRasterBand(1).GetOverviewCount() >= 1


def test_points_without_crs_give_an_image_without_one(tmp_path):
    path = tmp_path / "flown.tif"
    chequered(path)
    found = georeference(open_image(path), measured(places=RIMS, crs=""), GeoreferenceSettings(order=2))
    assert "have no CRS" in found.notes[0]
    draw_image(found, tmp_path / "drawn.tif")
    dataset = gdal.Open(str(tmp_path / "drawn.tif"))
    assert not dataset.GetProjection()
    fields_lie_where_they_are(dataset, found)


def test_pixels_of_an_even_size_lie_on_multiples_of_it(tmp_path):
    dataset, _ = drawn(tmp_path, 2, settings={"pixel_size": 0.25})
    x0, size, _, y0, _, _ = dataset.GetGeoTransform()
    assert size == 0.25 and x0 % 0.25 == 0 and y0 % 0.25 == 0


def test_a_coarse_result_is_averaged_and_not_picked(tmp_path):
    dataset, _ = drawn(tmp_path, 1, field=2, settings={"pixel_size": 0.4})
    values, alpha = (dataset.GetRasterBand(k).ReadAsArray() for k in (1, 4))
    assert values[alpha == 255].std() < 20  # light and dark fields of 2 px are 85 apart from their mean


def test_a_shift_leaves_the_pixels_as_they_are(tmp_path):
    path = tmp_path / "flown.tif"
    values = chequered(path, 1)
    placed = gdal.Open(str(path), gdal.GA_Update)
    placed.SetGeoTransform((1000.0, 0.05, 0.0, 2000.0, 0.0, -0.05))
    placed = None
    image = open_image(path)
    points = measured(places=[(100, 100), (500, 300)], bend=0.0, turn=0.0)
    points.easting[:], points.northing[:] = 1003.123 + 0.05 * points.pixel, 1996.456 - 0.05 * points.line
    draw_image(georeference(image, points, GeoreferenceSettings(order=0)), tmp_path / "drawn.tif")
    dataset = gdal.Open(str(tmp_path / "drawn.tif"))
    np.testing.assert_allclose(dataset.GetGeoTransform(), (1003.123, 0.05, 0.0, 1996.456, 0.0, -0.05), atol=1e-9)
    np.testing.assert_array_equal(dataset.GetRasterBand(1).ReadAsArray(), values.astype(np.uint8))


def test_an_image_that_lies_elsewhere_already_is_drawn_where_the_points_say(tmp_path):
    from pyproj import CRS

    path = tmp_path / "flown.tif"
    chequered(path)
    placed = gdal.Open(str(path), gdal.GA_Update)
    placed.SetGeoTransform((500_000.0, 0.3, 0.0, 6_000_000.0, 0.0, -0.3))
    placed.SetProjection(CRS("EPSG:25832").to_wkt("WKT1_GDAL"))
    placed = None
    for order in (1, 2):
        found = georeference(open_image(path), measured(places=RIMS, bend=0.0), GeoreferenceSettings(order=order))
        draw_image(found, tmp_path / "drawn.tif")
        dataset = gdal.Open(str(tmp_path / "drawn.tif"))
        assert dataset.GetSpatialRef().GetAuthorityCode(None) == "32650"
        fields_lie_where_they_are(dataset, found)
        dataset = None


def test_a_world_file_is_a_rough_position(tmp_path):
    chequered(tmp_path / "flown.png", 3, driver="PNG")
    (tmp_path / "flown.pgw").write_text("0.05\n0\n0\n-0.05\n1000.025\n1999.975\n")
    np.testing.assert_allclose(open_image(tmp_path / "flown.png").geotransform, (1000.0, 0.05, 0.0, 2000.0, 0.0, -0.05))


def test_only_the_hull_is_drawn_where_the_rest_is_left_out(tmp_path):
    path = tmp_path / "flown.tif"
    chequered(path)
    inner = [(p, q) for p in (100, 250, 380, 500) for q in (80, 160, 250, 320)]
    found = georeference(open_image(path), measured(places=inner, twist=0.02), GeoreferenceSettings(order=3))
    draw_image(found, tmp_path / "drawn.tif")
    dataset = gdal.Open(str(tmp_path / "drawn.tif"))
    size = dataset.GetGeoTransform()[1]
    area = (dataset.GetRasterBand(4).ReadAsArray() > 0).sum() * size**2
    assert area == pytest.approx(400 * 240 * 0.05**2, rel=0.06)


class Stop(Progress):
    def report(self, fraction):
        if fraction > 0.02:
            raise Cancelled


def test_cancel_leaves_yesterdays_image_and_nothing_else(tmp_path):
    path = tmp_path / "flown.tif"
    chequered(path)
    found = georeference(open_image(path), measured(places=RIMS), GeoreferenceSettings(order=2))
    (tmp_path / "drawn.tif").write_text("yesterday")
    with pytest.raises(Cancelled):
        draw_image(found, tmp_path / "drawn.tif", Stop())
    assert (tmp_path / "drawn.tif").read_text() == "yesterday"
    assert {file.name for file in tmp_path.iterdir()} == {"flown.tif", "drawn.tif"}


def test_an_absurd_size_is_refused_with_a_way_out(tmp_path):
    path = tmp_path / "flown.tif"
    chequered(path)
    found = georeference(open_image(path), measured(places=RIMS), GeoreferenceSettings(order=2, pixel_size=1e-4))
    with pytest.raises(RoadExtractionError, match="larger pixel size"):
        output_grid(found)


@pytest.mark.parametrize("name, content", [("none.tif", None), ("words.tif", "no image")])
def test_what_is_no_image_is_refused(name, content, tmp_path):
    if content:
        (tmp_path / name).write_text(content)
    with pytest.raises(RoadExtractionError, match=name):
        open_image(tmp_path / name)
