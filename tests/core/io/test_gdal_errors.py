"""GDAL raises errors in our own calls, and is for every other plugin what it was."""

import threading
from contextlib import suppress

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.geotiff import IntensityImage, new_geotiff
from lanewright.core.io.local_files import gdal_exceptions
from lanewright.products.report.page import grey_background

gdal = pytest.importorskip("osgeo.gdal")
ogr = pytest.importorskip("osgeo.ogr")
osr = pytest.importorskip("osgeo.osr")


def states():
    return [module.GetUseExceptions() for module in (gdal, ogr)]


def set_to(wanted):
    while any(states() + [osr.GetUseExceptions()]):
        for module in (gdal, ogr, osr):
            with suppress(RuntimeError):  # GDAL before 3.7 takes the last off first
                module.DontUseExceptions()
    for module, raises in zip((gdal, ogr), wanted):
        if raises:
            module.UseExceptions()


@pytest.fixture(params=[[0, 0], [1, 0], [0, 1], [1, 1]], ids=["codes", "gdal raises", "ogr raises", "both raise"])
def state(request):
    before = states()
    set_to(request.param)
    if states() != request.param:
        set_to(before)
        pytest.skip("this GDAL (3.7 or newer) switches the exceptions of gdal and ogr together")
    yield request.param
    set_to(before)


def test_images_are_written_and_read_and_gdal_stays_as_it_was(tmp_path, state):
    path = tmp_path / "image.tif"
    with new_geotiff(path, 30, 20, (0.0, 1.0, 0.0, 20.0, 0.0, -1.0), "") as image:
        assert states() == state
        image.write(3, 2, np.full((4, 5), 7.0, np.float32), whole=True)
        assert (image.read(3, 2, 5, 4) == 7).all()
    assert states() == state
    assert (IntensityImage.open(path).read_pixels(3, 2, 5, 4) == 7).all()
    grey_background(path)
    assert states() == state


def test_what_gdal_refuses_is_an_error_and_gdal_stays_as_it_was(tmp_path, state):
    (tmp_path / "words.tif").write_text("no image")
    with pytest.raises(RoadExtractionError, match="cannot be read as an image"):
        IntensityImage.open(tmp_path / "words.tif")
    with pytest.raises(RoadExtractionError, match="cannot be written"):
        with new_geotiff(tmp_path / "no folder" / "image.tif", 30, 20, (0.0, 1.0, 0.0, 20.0, 0.0, -1.0), ""):
            pass
    assert states() == state
    if not state[0]:
        assert gdal.OpenEx(str(tmp_path / "nothing.tif"), gdal.OF_RASTER) is None


def test_errors_are_raised_until_the_last_of_two_threads_is_done(state):
    entered, leave, seen = threading.Event(), threading.Event(), []

    def work():
        with gdal_exceptions():
            entered.set()
            leave.wait(10)
            seen.extend(states())

    thread = threading.Thread(target=work)
    with gdal_exceptions():
        thread.start()
        assert entered.wait(10)
        with gdal_exceptions():
            pass
        assert states() == [1, 1]
    leave.set()
    thread.join()
    assert seen == [1, 1]
    assert states() == state
