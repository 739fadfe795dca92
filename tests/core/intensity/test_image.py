"""The intensity image: what a pixel says of the points around it."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.intensity.image import ImageSettings, _kernels, check_image_shows, make_intensity_image
from lanewright.core.intensity.tiled_image import TiledImage, stored_tiles
from lanewright.core.io.geotiff import IntensityImage, _NewGeoTiff, write_display_image
from lanewright.core.markings.paint.windows import write_mask
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.array_file import SharedArrays
from lanewright.core.survey.store.records import COORDINATE_SCALE, ROAD_POINT, point_dtype, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

gdal = pytest.importorskip("osgeo.gdal")

ORIGIN = np.array([500_000.0, 5_400_000.0, 100.0])
PAINT, ASPHALT = 4000, 1000


def painted_street(length=45.0, density=1500, seed=3):
    """Records on a level street along x, 6 m wide, with a painted line 0.15 m wide at y = 1."""
    rng = np.random.default_rng(seed)
    count = int(length * 6 * density)
    x, y = rng.uniform(0, length, count), rng.uniform(-3, 3, count)
    records = np.zeros(count, ROAD_POINT)
    records["x"], records["y"], records["s"], records["d"] = to_units(x), to_units(y), to_units(x), to_units(y)
    records["time"] = np.sort(rng.uniform(0, 10, count))
    painted = np.abs(y - 1) < 0.075
    records["intensity"] = np.where(painted, PAINT, ASPHALT) + rng.normal(0, 60, count)
    records["corrected"] = np.nan
    return records


def road_points(records, section_length=20.0, origin=ORIGIN, crs="EPSG:32632"):
    from lanewright.core.io.crs import parse_crs

    found = RoadPoints(SectionStore(ROAD_POINT, section_length), np.asarray(origin), parse_crs(crs).to_wkt() if crs else "")
    found.store.append(0, records)
    return found


def image_of(records, path, settings=ImageSettings(), **kind):
    make_intensity_image(road_points(records, **kind), settings, path=path).close()
    return IntensityImage.open(path)


def all_pixels(image):
    return image.read_pixels(0, 0, image.width, image.height)


def test_the_painted_line_is_as_bright_as_its_paint_and_as_wide_within_a_cell(tmp_path):
    image = image_of(painted_street(), tmp_path / "i.tif", ImageSettings(beta=0.0))
    across = np.arange(0.5, 1.5, 0.01)
    profile = np.nanmean([image.sample(np.full(100, x), across, ORIGIN) for x in np.arange(2, 40, 0.37)], axis=0)
    bright = across[profile > (PAINT + ASPHALT) / 2]
    assert abs(np.median(bright) - 1.0) < 0.02
    assert abs(np.ptp(bright) - 0.15) < 0.04
    assert abs(profile[np.abs(across - 1) < 0.02].mean() - PAINT) < 100
    assert abs(profile[np.abs(across - 1) > 0.3].mean() - ASPHALT) < 30


def test_bright_points_count_more_so_paint_grows_by_less_than_a_cell(tmp_path):
    plain = image_of(painted_street(), tmp_path / "a.tif", ImageSettings(beta=0.0))
    bright = image_of(painted_street(), tmp_path / "b.tif", ImageSettings(beta=0.5))
    middle = (PAINT + ASPHALT) / 2
    narrow, wide = (np.mean(all_pixels(image) > middle) * 6.0 for image in (plain, bright))
    assert narrow < wide < narrow + 0.04


def _open_files():
    return {os.path.realpath(f"/proc/self/fd/{number}") for number in os.listdir("/proc/self/fd")}


@pytest.fixture
def as_on_windows(monkeypatch):
    """A file that this process holds open cannot be renamed; returns the list of those that were."""
    if not os.path.isdir("/proc/self/fd"):
        pytest.skip("open files are asked for in /proc")
    rename, renamed = os.replace, []

    def refuse_open_files(source, target):
        if os.path.realpath(source) in _open_files():
            raise PermissionError(f"{source} is open")
        rename(source, target)
        renamed.append(Path(target).name)

    monkeypatch.setattr(os, "replace", refuse_open_files)
    return renamed


def test_an_image_is_closed_before_it_takes_its_name(tmp_path, as_on_windows):
    records, along = painted_street(length=20.0), np.linspace(0, 20, 101)
    image = image_of(records, tmp_path / "image.tif")
    write_display_image(image.path, tmp_path / "display.tif")
    frame = build_frame(Trajectory(along, ORIGIN[0] + along, np.full(101, ORIGIN[1]), np.full(101, 102.0)))
    painted = records[records["intensity"] > (PAINT + ASPHALT) / 2]
    write_mask(tmp_path / "mask.tif", road_points(painted[np.argsort(painted["s"])]), image, frame)
    assert as_on_windows == ["image.tif", "display.tif", "mask.tif"]
    mask = gdal.Open(str(tmp_path / "mask.tif"))
    assert np.frombuffer(mask.ReadRaster(), np.uint8).sum() * image.geotransform[1]**2 == pytest.approx(20 * 0.15, rel=0.2)


def test_without_the_brightness_rule_a_pixel_is_plain_inverse_distance(tmp_path):
    records = painted_street(length=3.0)
    image = image_of(records, tmp_path / "i.tif", ImageSettings(beta=0.0))
    pixels = all_pixels(image)
    px, py = records["x"] * COORDINATE_SCALE + ORIGIN[0], records["y"] * COORDINATE_SCALE + ORIGIN[1]
    left, cell, _, top, _, _ = image.geotransform
    for row, column in [(20, 11), (50, 40), (77, 3), (100, 60), (0, 0)]:
        distance = np.hypot(px - left - (column + 0.5) * cell, py - top + (row + 0.5) * cell)
        near = distance <= 2 * cell
        weight = 1 / (distance[near] + 1e-3) ** 2
        expected = (weight * records["intensity"][near]).sum() / weight.sum() if near.any() else np.nan
        np.testing.assert_allclose(pixels[row, column], expected, rtol=1e-6)


def test_without_the_brightness_rule_it_agrees_with_gdal_grid(tmp_path):
    records = painted_street(length=2.0, density=400)
    image = image_of(records, tmp_path / "i.tif", ImageSettings(beta=0.0))
    left, cell, _, top, _, _ = image.geotransform
    from osgeo import ogr

    ogr.UseExceptions()
    source = gdal.GetDriverByName("Memory").Create("", 0, 0, 0)
    layer = source.CreateLayer("points", geom_type=ogr.wkbPoint25D)
    for x, y, value in zip(records["x"] * COORDINATE_SCALE + ORIGIN[0], records["y"] * COORDINATE_SCALE + ORIGIN[1], records["intensity"]):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POINT ({x:.4f} {y:.4f} {value})"))
        layer.CreateFeature(feature)
    grid = gdal.Grid("", source, format="MEM", width=image.width, height=image.height,
                     outputBounds=[left, top - image.height * cell, left + image.width * cell, top], outputType=gdal.GDT_Float32,
                     algorithm=f"invdistnn:power=2:smoothing=0:radius={2 * cell}:max_points=100000:nodata=-9999")
    theirs = np.frombuffer(grid.ReadRaster(0, 0, image.width, image.height), np.float32).reshape(image.height, image.width)
    theirs = theirs if grid.GetGeoTransform()[5] < 0 else theirs[::-1]
    ours = all_pixels(image)
    both = np.isfinite(ours) & (theirs != -9999)
    # ours adds 1 mm to a distance, so a point right on a centre does not silence the others
    assert both.mean() > 0.9 and (np.isfinite(ours) == (theirs != -9999)).mean() > 0.999
    assert np.median(np.abs(ours - theirs)[both]) < 1.0 and np.percentile(np.abs(ours - theirs)[both], 99) < 40


@pytest.mark.parametrize("section_length", [5.0, 7.3, 60.0])
def test_the_image_does_not_depend_on_the_length_of_sections(tmp_path, section_length):
    records = painted_street()
    usual = all_pixels(image_of(records, tmp_path / "a.tif"))
    other = all_pixels(image_of(records[::-1], tmp_path / "b.tif", section_length=section_length))
    np.testing.assert_array_equal(usual, other)


def test_where_points_are_dense_a_share_of_them_makes_the_same_image(tmp_path):
    """Ten points to a cell, of which each third weighs on all cells, whatever the length of sections."""
    dense = painted_street(length=12.0, density=6300)
    share = all_pixels(image_of(dense, tmp_path / "a.tif"))
    other = all_pixels(image_of(dense[::-1], tmp_path / "b.tif", section_length=7.3))
    np.testing.assert_array_equal(share, other)
    usual = all_pixels(image_of(painted_street(length=12.0, density=2100), tmp_path / "c.tif"))
    for values in (share, usual):
        assert np.isfinite(values).mean() > 0.98
        assert abs(np.nanmedian(values) - ASPHALT) < 10
    middle = (PAINT + ASPHALT) / 2
    assert abs(np.mean(share > middle) - np.mean(usual > middle)) * 6.0 < 0.005


def test_where_points_are_dense_almost_every_pixel_is_as_if_all_points_weighed_on_all_cells(tmp_path, monkeypatch):
    from lanewright.core.intensity import image

    dense = painted_street(length=12.0, density=6300)
    share = all_pixels(image_of(dense, tmp_path / "a.tif", ImageSettings(beta=0.0)))
    monkeypatch.setattr(image, "IMAGE", replace(image.IMAGE, far_points_per_cell=100))
    every = all_pixels(image_of(dense, tmp_path / "b.tif", ImageSettings(beta=0.0)))
    assert share.shape == every.shape and (share != every).mean() > 0.5
    assert (np.abs(share - every) <= 0.02 * (PAINT - ASPHALT)).sum() > 0.97 * np.isfinite(every).sum()


def test_weights_do_not_depend_on_how_many_are_computed_at_a_time():
    kernel, places = _kernels(ImageSettings())[0], np.random.default_rng(3).uniform(-0.5, 0.5, (2, 5000)).astype(np.float32)
    found = kernel.weights(*places).copy()
    away = np.hypot(*(place[:, None] - middle for place, middle in zip(places.astype(float), np.array(kernel.offsets).T))) * 0.04
    expected = np.where(away <= 0.08, 1 / (away + 1e-3) ** 2, 0.0)
    # but for rounding at the radius itself
    clear = np.abs(away - 0.08) > 1e-6
    np.testing.assert_allclose(found[clear], expected[clear], rtol=2e-3)
    kernel.rows_at_once, at_once = 7, kernel.rows_at_once
    again = kernel.weights(*places).copy()
    kernel.rows_at_once = at_once
    np.testing.assert_allclose(again, found, rtol=1e-4)


def test_what_is_interpolated_again_for_a_later_tile_is_the_same(tmp_path, monkeypatch):
    """A diagonal street, whose pieces touch several tiles, each of which is made apart from the others."""
    from lanewright.core.intensity import image

    records = painted_street()
    x, y = records["x"].copy(), records["y"].copy()
    records["x"], records["y"] = np.rint((x - y) * np.sqrt(0.5)), np.rint((x + y) * np.sqrt(0.5))
    usual = all_pixels(image_of(records, tmp_path / "a.tif"))
    monkeypatch.setattr(image, "IMAGE", replace(image.IMAGE, tiles_per_task=1))
    np.testing.assert_array_equal(usual, all_pixels(image_of(records, tmp_path / "b.tif")))


def test_cells_are_multiples_of_the_cell_size_wherever_the_origin_is(tmp_path):
    records = painted_street(length=6.0)
    usual = image_of(records, tmp_path / "a.tif")
    moved = records.copy()
    moved["x"] -= to_units(37.0)
    moved["y"] += to_units(11.0)
    other = image_of(moved, tmp_path / "b.tif", origin=ORIGIN + [37.0, -11.0, 0.0])
    np.testing.assert_allclose(usual.geotransform, other.geotransform)
    assert abs(usual.geotransform[0] / 0.04 - round(usual.geotransform[0] / 0.04)) < 1e-4
    np.testing.assert_allclose(all_pixels(usual), all_pixels(other), rtol=1e-5)


def test_an_image_that_is_not_read_from_its_file_has_the_same_pixels_and_samples(tmp_path):
    """A diagonal street, so that tiles are filled in part."""
    records = painted_street()
    x, y = records["x"].copy(), records["y"].copy()
    records["x"], records["y"] = np.rint((x - y) * np.sqrt(0.5)), np.rint((x + y) * np.sqrt(0.5))
    usual = image_of(records, tmp_path / "a.tif")
    image = make_intensity_image(road_points(records), path=tmp_path / "b.tif")
    assert image.geotransform == usual.geotransform and (image.width, image.height) == (usual.width, usual.height)
    np.testing.assert_array_equal(all_pixels(image), all_pixels(usual))
    np.testing.assert_array_equal(all_pixels(IntensityImage.open(tmp_path / "b.tif")), all_pixels(usual))
    assert set(image.tiles()) == {tile for tile in usual.tiles() if np.isfinite(usual.read_pixels(*tile, 512, 512)).any()}
    for window in [(-20, -30, 100, 80), (500, 400, 700, 650), (511, 511, 2, 2), (10_000, 0, 5, 5)]:
        np.testing.assert_array_equal(image.read_pixels(*window), usual.read_pixels(*window))
    places = np.random.default_rng(5).uniform(-5.0, 40.0, (2, 3000))
    np.testing.assert_array_equal(image.sample(*places, ORIGIN), usual.sample(*places, ORIGIN))


def test_an_image_without_a_file_has_the_pixels_of_one_with_a_file(tmp_path):
    records = painted_street(length=12.0)
    image = make_intensity_image(road_points(records))
    np.testing.assert_array_equal(all_pixels(image), all_pixels(image_of(records, tmp_path / "a.tif")))
    assert [path.name for path in tmp_path.iterdir()] == ["a.tif"]
    image.close()
    assert np.isnan(all_pixels(image)).all() and not image.tiles()


def test_what_a_piece_of_road_depends_on_is_asked_once_however_many_tiles_it_touches(monkeypatch):
    asked, state = [], RoadPoints.state
    monkeypatch.setattr(RoadPoints, "state", lambda self, *where: asked.append(where) or state(self, *where))
    image = make_intensity_image(road_points(painted_street()))
    assert 1 < len(asked) == len(set(asked)) < len(image.pieces) == len(image.places)
    image.close()


def image_of_levels(path, levels, before=None):
    """An image of a row of tiles, each of one value, None without data, in a file too; what did not change is taken over from the one before."""
    image = TiledImage((0.0, 0.04, 0.0, 100.0, 0.0, -0.04), 512 * len(levels), 512, "", SharedArrays(None))
    image.states = {(k, 0): str(level) for k, level in enumerate(levels)}
    if before is not None:
        image.take_over(before)
    with image.new_file(path, before) as file:
        for k, level in enumerate(levels):
            if level is not None and (before is None or before.states[k, 0] != str(level)):
                values = np.full((512, 512), level, np.float32)
                image.add(stored_tiles(image.arrays, [(512 * k, 0, values)]))
                file.write(512 * k, 0, values)
    return image


def test_of_a_changed_image_the_changed_tiles_alone_are_written_where_its_file_is_still_there(tmp_path, monkeypatch):
    written, write = [], _NewGeoTiff.write
    monkeypatch.setattr(_NewGeoTiff, "write", lambda self, *tile, **how: written.append(tile[0] // 512) or write(self, *tile, **how))
    image = image_of_levels(tmp_path / "a.tif", [1.0, 2.0, 3.0, None])
    assert written == [0, 1, 2]
    for name, levels, changed in (("b.tif", [1.0, 5.0, None, 4.0], {1, 2, 3}), ("b.tif", [1.0, 5.0, None, 6.0], {3})):
        written.clear()
        image = image_of_levels(tmp_path / name, levels, image)
        assert set(written) == changed
        np.testing.assert_array_equal(all_pixels(IntensityImage.open(tmp_path / name)), all_pixels(image))
        assert [float(pixel) for pixel in all_pixels(image)[0, ::512]] == pytest.approx([np.nan if v is None else v for v in levels], nan_ok=True)
    (tmp_path / "b.tif").write_bytes(b"of somebody else")
    written.clear()
    image = image_of_levels(tmp_path / "c.tif", [1.0, 5.0, None, 7.0], image)
    assert set(written) == {0, 1, 3}
    np.testing.assert_array_equal(all_pixels(IntensityImage.open(tmp_path / "c.tif")), all_pixels(image))


def test_where_no_point_lies_within_two_cells_there_is_no_data(tmp_path):
    records = painted_street(length=10.0)
    x = records["x"] * COORDINATE_SCALE
    image = image_of(records[(x < 4) | (x > 6)], tmp_path / "i.tif")
    values = image.sample(np.array([2.0, 4.05, 4.2, 5.0, 5.8, 5.95, 8.0]), np.zeros(7), ORIGIN)
    np.testing.assert_array_equal(np.isnan(values), [False, False, True, True, True, False, False])


def test_the_corrected_intensity_is_what_the_image_shows(tmp_path):
    records = painted_street(length=5.0)
    records["corrected"] = 7.0
    assert np.nanmax(np.abs(all_pixels(image_of(records, tmp_path / "i.tif")) - 7.0)) < 1e-4


def test_a_place_is_sampled_from_the_pixel_it_lies_in(tmp_path):
    image = image_of(painted_street(length=5.0), tmp_path / "i.tif")
    cell = image.cell_size
    column, row = (int(np.floor(pixel[0])) for pixel in image.pixel_of([1.0], [1.0], ORIGIN))
    left, top = image.geotransform[0] + column * cell, image.geotransform[3] - row * cell
    pixels = image.read_pixels(column, row, 25, 50)
    x, y = left + (3 + 0.5) * cell, top - (7 + 0.5) * cell
    assert image.sample([x + 0.4 * cell], [y - 0.4 * cell])[0] == pixels[7, 3]
    assert np.isnan(image.sample([x + 1e4], [y])[0])


def test_the_display_image_shows_paint_brighter_than_asphalt_and_nothing_as_nothing(tmp_path):
    image_of(painted_street(length=10.0), tmp_path / "i.tif")
    write_display_image(tmp_path / "i.tif", tmp_path / "d.tif")
    display = gdal.Open(str(tmp_path / "d.tif"))
    assert display.GetRasterBand(1).DataType == gdal.GDT_Byte and display.GetRasterBand(1).GetNoDataValue() == 0
    shown = IntensityImage.open(tmp_path / "d.tif")
    values = shown.sample(np.array([5.0, 5.0, 5.0]), np.array([1.0, 0.0, 20.0]), ORIGIN)
    assert values[0] > values[1] + 100 and np.isnan(values[2])


def test_an_image_of_two_towns_a_thousand_kilometres_apart_is_only_as_large_as_the_towns(tmp_path):
    from lanewright.products.report.page import grey_background

    here = painted_street(length=10.0)
    kind = point_dtype(ROAD_POINT, 1e6)
    points = RoadPoints(SectionStore(kind), ORIGIN, "")
    for road, east in ((0, 0.0), (1, 1e6)):
        records = here.astype(kind)
        records["x"] += int(east / COORDINATE_SCALE)
        points.store.append(road, records)
    make_intensity_image(points, path=tmp_path / "i.tif").close()
    image, alone = IntensityImage.open(tmp_path / "i.tif"), image_of(here, tmp_path / "alone.tif")
    assert image.width > 25_000_000 and len(image.tiles()) <= 4 and (tmp_path / "i.tif").stat().st_size < 5e6
    x, y = np.linspace(1.0, 9.0, 60), np.linspace(-2.5, 2.5, 60)
    for east in (0.0, 1e6):
        np.testing.assert_allclose(image.sample(x + east, y, ORIGIN), alone.sample(x, y, ORIGIN), rtol=1e-4)
    assert np.isnan(image.sample(np.full(3, 5e5), np.array([-1.0, 0.0, 1.0]), ORIGIN)).all()

    write_display_image(tmp_path / "i.tif", tmp_path / "d.tif")
    values = IntensityImage.open(tmp_path / "d.tif").sample(np.array([5.0, 5.0, 1e6 + 5.0, 1e6 + 5.0]), np.array([1.0, 0.0, 1.0, 0.0]), ORIGIN)
    assert values[0] > values[1] + 100 and values[2] > values[3] + 100
    assert grey_background(tmp_path / "i.tif") is None, "in a picture of both no road would be seen"


def test_tiles_with_data_are_listed_row_by_row(tmp_path):
    image = image_of(painted_street(length=45.0), tmp_path / "i.tif")
    every = [(column, row) for row in range(0, image.height, 512) for column in range(0, image.width, 512)]
    assert image.tiles() == every and len(every) > 2


def test_the_file_carries_crs_tiles_and_nodata_and_no_unfinished_one_is_left(tmp_path):
    image_of(painted_street(length=5.0), tmp_path / "i.tif")
    raster = gdal.Open(str(tmp_path / "i.tif"))
    assert raster.GetSpatialRef().GetAuthorityCode(None) == "32632"
    assert raster.GetRasterBand(1).GetBlockSize() == [512, 512] and raster.GetRasterBand(1).DataType == gdal.GDT_Float32
    assert raster.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE") == "DEFLATE"
    assert [path.name for path in tmp_path.iterdir()] == ["i.tif"]


def test_a_cancelled_image_leaves_the_last_one_as_it_was(tmp_path):
    from lanewright.core.common.errors import Cancelled
    from lanewright.core.common.progress import Progress

    class Stop(Progress):
        def report(self, fraction):
            if fraction > 0.6:
                raise Cancelled

    before = all_pixels(image_of(painted_street(length=5.0), tmp_path / "i.tif"))
    with pytest.raises(Cancelled):
        make_intensity_image(road_points(painted_street(length=45.0)), ImageSettings(), Stop(), tmp_path / "i.tif")
    np.testing.assert_array_equal(all_pixels(IntensityImage.open(tmp_path / "i.tif")), before)
    assert [path.name for path in tmp_path.iterdir()] == ["i.tif"]


def test_what_is_no_intensity_image_is_refused_in_words(tmp_path):
    (tmp_path / "text.tif").write_text("no image")
    with pytest.raises(RoadExtractionError, match="cannot be read as an image"):
        IntensityImage.open(tmp_path / "text.tif")
    with pytest.raises(RoadExtractionError, match="There is no file"):
        IntensityImage.open(tmp_path / "missing.tif")
    raster = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "degrees.tif"), 4, 4, 1, gdal.GDT_Float32)
    raster.SetGeoTransform((8.4, 1e-6, 0, 49.0, 0, -1e-6))
    from osgeo import osr

    reference = osr.SpatialReference()
    reference.ImportFromEPSG(4326)
    raster.SetProjection(reference.ExportToWkt())
    raster = None
    with pytest.raises(RoadExtractionError, match="degrees"):
        IntensityImage.open(tmp_path / "degrees.tif")
    raster = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "photo.tif"), 4, 4, 1, gdal.GDT_Float32)
    raster = None
    with pytest.raises(RoadExtractionError, match="without georeferencing"):
        IntensityImage.open(tmp_path / "photo.tif")


def test_no_points_make_no_image(tmp_path):
    with pytest.raises(RoadExtractionError, match="no road points"):
        make_intensity_image(RoadPoints.empty_like(origin=ORIGIN), path=tmp_path / "i.tif")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("wrong", [dict(cell_size=0.0), dict(power=0.0), dict(beta=1.5), dict(radius_cells=0.1)])
def test_settings_that_make_no_image_are_refused(wrong):
    with pytest.raises(RoadExtractionError):
        ImageSettings(**wrong)


def test_an_image_of_another_road_is_refused(tmp_path):
    here = painted_street()
    image = image_of(here, tmp_path / "here.tif")
    check_image_shows(image, road_points(here))
    with pytest.raises(RoadExtractionError, match="does not show these road points, of which 0 % lie on it"):
        check_image_shows(image, road_points(here, origin=ORIGIN + [300.0, 0.0, 0.0]))


def test_the_display_image_is_no_intensity_image(tmp_path):
    image_of(painted_street(), tmp_path / "i.tif")
    write_display_image(tmp_path / "i.tif", tmp_path / "display.tif")
    with pytest.raises(RoadExtractionError, match="8-bit picture for viewing"):
        check_image_shows(IntensityImage.open(tmp_path / "display.tif"), road_points(painted_street()))
