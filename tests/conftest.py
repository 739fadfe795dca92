"""Loads the checkout under the name QGIS gives it, whatever its folder is called."""

import hashlib
import importlib.util
import os
import shutil
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = "lanewright"

sys.path.insert(0, str(ROOT / "tests" / "streets"))  # streets and surveys that several tests build

if workers := int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "0")):
    own_cores = max(1, (os.cpu_count() or 1) // workers)
    os.cpu_count = lambda: own_cores  # the threads of each process have its share; tests of threads ask for more

if os.environ.get("LANEWRIGHT_WITHOUT_QGIS"):
    sys.modules["qgis"] = None  # every import of it fails

if PACKAGE not in sys.modules:
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)


def pytest_collection_modifyitems(items):
    """Files with the most slow tests begin, so that at the end no worker waits long for another."""
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))
    items.sort(key=lambda item: -slow[item.path])


@pytest.fixture(scope="session")
def made_once(tmp_path_factory):
    """`made_once(name, make)` is a folder that `make(folder)` fills when the first test asks for that name.

    All processes of a run share it, and with `make test` its parts do; tests only read it.
    """
    import fcntl  # there is none on Windows

    base = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent
    base = Path(os.environ.get("LANEWRIGHT_MADE_ONCE", base / "made_once"))
    base.mkdir(parents=True, exist_ok=True)

    def made(name, make):
        folder, unfinished = base / name, base / f"{name}.part"
        with open(base / f"{name}.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not folder.exists():
                shutil.rmtree(unfinished, ignore_errors=True)
                unfinished.mkdir()
                make(unfinished)
                unfinished.rename(folder)
        return folder
    return made


@pytest.fixture(scope="session", autouse=True)
def no_qgis():
    """`make test` runs these tests where qgis cannot be imported; every process of them sees that it is so."""
    if os.environ.get("LANEWRIGHT_WITHOUT_QGIS"):
        for name in ("qgis", "qgis.core"):
            with pytest.raises(ImportError):
                importlib.import_module(name)
        assert not any(name.startswith("qgis.") for name in sys.modules)


@pytest.fixture(scope="session")
def made_survey(made_once):
    """`made_survey(length=60.0, …)` is a sample survey, and its cloud, which is written once for all tests."""
    from lanewright.simulator.survey import SampleSettings, make_sample_survey

    def made(**settings):
        sample = make_sample_survey(SampleSettings(**settings))
        name = hashlib.sha256(repr(sample.settings).encode()).hexdigest()[:16]
        return sample, made_once(name, lambda folder: sample.write_cloud(folder / "survey.las")) / "survey.las"
    return made


@pytest.fixture(scope="session")
def provider(qgis_app, qgis_processing):
    """The provider as the plugin registers it."""
    from lanewright import classFactory

    plugin = classFactory(None)
    plugin.initProcessing()
    yield plugin.provider
    plugin.unload()


@pytest.fixture
def project(qgis_app):
    """The project of QGIS, empty before and after a test.

    A legend looks into the project of its layers once more by a timer, after the test that drew it: a project of the
    test's own would be gone by then, and the process with it.
    """
    from qgis.core import QgsProject

    project = QgsProject.instance()
    project.clear()
    yield project
    project.clear()


@pytest.fixture
def kept_connection(qgis_app):
    """`kept_connection(name, uri, **options)` keeps a connection to PostGIS in QGIS, and takes it away after the test.

    QGIS remembers the connections that it has once listed: removed from its settings alone they would be listed in later tests.
    """
    from qgis.core import QgsProviderRegistry

    postgres, names = QgsProviderRegistry.instance().providerMetadata("postgres"), []

    def keep(name, uri, **options):
        postgres.saveConnection(postgres.createConnection(uri, options), name)
        names.append(name)
        return name
    yield keep
    for name in names:
        postgres.deleteConnection(name)
