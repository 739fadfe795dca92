import pytest


@pytest.fixture(scope="session")
def provider(qgis_app, qgis_processing):
    """The provider as the plugin registers it."""
    from lanewright import classFactory

    plugin = classFactory(None)
    plugin.initProcessing()
    yield plugin.provider
    plugin.unload()
