"""In QGIS as well no server is asked for what a file says; of layers that the user has from a server, it is."""

import pytest
from lanewright.processing_provider.call import asks_servers
from listening_server import RASTERS, VECTORS, listening, written
from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsVectorLayer


@pytest.fixture(autouse=True)
def no_exceptions_from_proxies(monkeypatch):
    for name in ("no_proxy", "NO_PROXY"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.parametrize("kind", [*VECTORS.values(), *RASTERS.values()], ids=[*VECTORS, *(f"image, {name}" for name in RASTERS)])
def test_no_server_is_asked(provider, tmp_path, kind):
    with listening() as (url, asked):
        path = str(written(tmp_path, kind, url))
        algorithm, context = provider.algorithm("assessmarkings").create(), QgsProcessingContext()
        given = {"INPUT": path, "REFERENCE": path, "OUTPUT": str(tmp_path / "out.gpkg")}
        algorithm.checkParameterValues(given, context)
        _, done = algorithm.run(given, context, QgsProcessingFeedback())
        assert not done and not asked


def test_a_layer_that_the_user_has_from_a_server_is_read_there(provider, tmp_path):
    (tmp_path / "lanes.geojson").write_text('{"type": "FeatureCollection", "features": []}')
    algorithm, context = provider.algorithm("assessmarkings").create(), QgsProcessingContext()
    with listening() as (url, _):
        there = QgsVectorLayer(f"/vsicurl/{url}/lanes.geojson", "lanes", "ogr")
        assert asks_servers(algorithm, {"INPUT": there}, context)
    assert not asks_servers(algorithm, {"INPUT": str(tmp_path / "lanes.geojson")}, context)
