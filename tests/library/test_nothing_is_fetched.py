"""Whatever a file says, no server is asked for it."""

from contextlib import suppress

import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.io.local_files import gdal_exceptions, open_raster
from lanewright.library import run
from lanewright.library.layer_files import LayerFile, first_table
from listening_server import RASTERS, VECTORS, listening, written


@pytest.fixture(autouse=True)
def no_exceptions_from_proxies(monkeypatch):
    for name in ("no_proxy", "NO_PROXY"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.parametrize("kind", VECTORS)
def test_a_layer_that_names_an_address_is_refused(tmp_path, kind):
    with listening() as (url, asked):
        path = written(tmp_path, VECTORS[kind], url)
        first_table(path)
        with pytest.raises(RoadExtractionError, match="nothing is fetched" if kind == "linked CRS" else "cannot be read as a vector layer"):
            LayerFile(str(path), "Lanes")
        assert not asked


@pytest.mark.parametrize("kind", RASTERS)
def test_an_image_that_names_an_address_is_not_fetched(tmp_path, kind):
    pytest.importorskip("osgeo")
    with listening() as (url, asked):
        path = written(tmp_path, RASTERS[kind], url)
        with pytest.raises((RoadExtractionError, RuntimeError)), gdal_exceptions():
            open_raster(path).ReadRaster()
        assert not asked


@pytest.mark.parametrize("kind", RASTERS)
def test_an_algorithm_says_in_one_sentence_that_such_an_image_cannot_be_read(tmp_path, kind):
    pytest.importorskip("osgeo")
    with listening() as (url, asked):
        path = written(tmp_path, RASTERS[kind], url)
        with pytest.raises(RoadExtractionError, match="image\\.(tif|vrt)"):
            run("assessmarkings", INPUT=str(path), REFERENCE=str(path), OUTPUT=str(tmp_path / "out.gpkg"))
        assert not asked


def test_other_threads_may_still_ask(tmp_path):
    """QGIS shows layers of servers meanwhile."""
    gdal = pytest.importorskip("osgeo.gdal")
    with gdal_exceptions():
        pass
    assert gdal.GetThreadLocalConfigOption("GDAL_HTTP_PROXY") is None
    with listening() as (url, asked):
        with suppress(RuntimeError):
            gdal.OpenEx(f"/vsicurl/{url}/image.tif", gdal.OF_RASTER)
        assert asked
