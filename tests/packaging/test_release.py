"""What goes out to users: the zip, its description, and code that runs on Qt 5 and Qt 6."""

import configparser
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# Qt 5 only, or gone from QGIS 4
OLD = re.compile(r"PyQt5|\.exec_\(|\bQVariant\.|resources_rc|QgsProcessing\.Type[A-Z]|QgsWkbTypes\.(Point|LineString|Polygon)Z?\b|QRegExp")


@pytest.fixture(scope="session")
def metadata():
    parser = configparser.ConfigParser()
    parser.read(ROOT / "metadata.txt", encoding="utf-8")
    return parser["general"]


@pytest.fixture(scope="session")
def archive(tmp_path_factory):
    if not (ROOT / ".git").exists():
        pytest.skip("the release is made from the git history")
    path = tmp_path_factory.mktemp("release") / "lanewright.zip"
    subprocess.run([str(ROOT / "tools" / "package.sh"), str(path)], check=True, capture_output=True)
    return zipfile.ZipFile(path)


@pytest.mark.parametrize("key", [
    "name", "qgisMinimumVersion", "description", "about", "version", "author", "email", "repository", "tracker", "homepage",
    "icon", "tags", "category", "hasProcessingProvider", "supportsQt6",
])
def test_the_description_is_complete(metadata, key):
    assert metadata[key].strip()


def test_qgis_process_and_qgis_4_are_told_that_they_may_load_us(metadata):
    # QGIS 4 and the plugin repository read the highest version; builds of QGIS 3.40 to 3.44 on Qt 6 still ask for supportsQt6, in
    # which the repository reads "true" and QGIS "true" and "yes"
    assert metadata["hasProcessingProvider"] == "yes" and metadata["supportsQt6"] == "True"
    assert metadata["qgisMinimumVersion"] == "3.40" and metadata["qgisMaximumVersion"] == "4.99"


def test_nobody_says_that_it_was_tried_in_qgis_4(metadata):
    assert "has not been run in QGIS 4" in metadata["about"] and "has not been run in QGIS 4" in (ROOT / "README.md").read_text()


def test_every_package_one_must_install_is_named_to_the_user_and_installed_by_a_plugin_that_qgis_offers(metadata):
    from lanewright.processing_provider.dependencies import NEEDED

    lines = (ROOT / "requirements.txt").read_text().splitlines()
    required = {re.split(r"[<>=]", line)[0] for line in lines if line and not line.startswith("#")}
    # numpy and GDAL are those that QGIS was built with; MarkupSafe comes with Jinja2
    assert required == set(NEEDED.values()) - {"numpy", "gdal", "markupsafe"}
    assert not {name for name in required if name.removesuffix("-python-headless") not in metadata["about"].lower()}
    assert metadata["plugin_dependencies"] == "qpip"


def test_the_zip_has_one_folder_with_what_qgis_needs(archive):
    names = archive.namelist()
    assert {name.split("/")[0] for name in names} == {"lanewright"}
    needed = {"metadata.txt", "LICENSE", "__init__.py", "plugin.py", "resources/icon.png", "resources/models/road_map.model3", "requirements.txt"}
    assert not {f"lanewright/{name}" for name in needed} - set(names)


def test_the_zip_has_nothing_a_user_has_no_use_for(archive):
    names = [name.removeprefix("lanewright/") for name in archive.namelist()]
    useless = ("tests", "tools", ".", "build", "library", "setup.py", "Makefile")
    assert not [name for name in names if name.startswith(useless) or "__pycache__" in name]
    assert not [name for name in names if name.startswith("requirements-")]
    # the manual's pictures in two languages are most of it; the plugin repository takes 25 MB
    assert sum(entry.compress_size for entry in archive.infolist()) < 8e6


def test_the_plugin_repository_finds_no_file_that_it_refuses_or_doubts(archive):
    """What plugins.qgis.org asks of the files of an upload; `make lint` asks of the code what its Bandit, detect-secrets and flake8 ask."""
    for entry in archive.infolist():
        names = entry.filename.rstrip("/").split("/")
        assert names[0].isidentifier() and ".." not in entry.filename and not [name for name in names if name.startswith((".", "__MACOSX"))], names
        assert not entry.filename.lower().endswith((".pyc", ".exe", ".dll", ".so", ".dylib", ".bat", ".sh", ".ps1", ".cmd")), names
        assert entry.is_dir() or not entry.external_attr >> 16 & 0o111, f"{entry.filename} is a program"


def test_no_address_leads_to_a_stranger(metadata):
    """Until somebody publishes the plugin, its addresses are under a domain that nobody can own (RFC 2606)."""
    for key in ("homepage", "repository", "tracker"):
        assert re.match(r"https://[\w.]*\.example(/|$)", metadata[key]), key
    assert metadata["email"].endswith(".example")


def test_a_release_carries_the_addresses_of_its_publisher(tmp_path, metadata):
    if not (ROOT / ".git").exists():
        pytest.skip("the release is made from the git history")
    path = tmp_path / "lanewright.zip"
    named = {"REPOSITORY": "https://git.roads.test/lane", "EMAIL": "me@roads.test", "HOMEPAGE": "https://roads.test"}
    subprocess.run([str(ROOT / "tools" / "package.sh"), str(path)], check=True, capture_output=True, env={**os.environ, **named})
    parser = configparser.ConfigParser()
    with zipfile.ZipFile(path) as archive:
        parser.read_string(archive.read("lanewright/metadata.txt").decode("utf-8"))
        assert archive.testzip() is None and len(archive.namelist()) > 200
    written = parser["general"]
    assert [written[key] for key in ("repository", "tracker", "homepage", "email")] == [
        "https://git.roads.test/lane", "https://git.roads.test/lane/issues", "https://roads.test", "me@roads.test"]
    assert written["version"] == metadata["version"] and sorted(written) == sorted(metadata)
    assert {file.name for file in tmp_path.iterdir()} == {"lanewright.zip"}


def test_an_address_that_is_none_makes_no_release(tmp_path):
    if not (ROOT / ".git").exists():
        pytest.skip("the release is made from the git history")
    call = subprocess.run([str(ROOT / "tools" / "package.sh"), str(tmp_path / "lanewright.zip")], capture_output=True, text=True,
                          env={**os.environ, "REPOSITORY": "git.roads.test", "EMAIL": "me@roads.test"})
    assert call.returncode and "repository is 'git.roads.test'" in call.stderr and not list(tmp_path.iterdir())


def test_the_code_is_written_for_qt_5_and_qt_6_alike():
    """Names that are gone; `make lint` asks PyQt6 itself for every name (tools/qt6_names.py)."""
    folders = [path for folder in ("desktop", "processing_provider", "tools") for path in (ROOT / folder).rglob("*.py")]
    shell = [ROOT / "__init__.py", ROOT / "plugin.py", *folders]
    found = [f"{path.name}: {match.group()}" for path in shell for match in OLD.finditer(path.read_text(encoding="utf-8"))]
    assert not found


def test_no_program_is_started_but_a_python_that_runs_the_worker():
    commands = [re.findall(r"subprocess\.(\w+)\([^\n]*\n\s*(\w+\()", path.read_text(encoding="utf-8")) for path in WORKERS]
    assert commands == [[("run", "command_of(")], [("Popen", "command_of(")], [], [], []]
    from lanewright.core.execution.tasks import WORKER, command_of

    command = command_of("/usr/bin/python3", "--try")
    assert command[:2] == ["/usr/bin/python3", "-I"] and command[-2:] == [str(WORKER), "--try"] and WORKER == WORKERS[2]


def test_the_core_the_declarations_and_the_library_never_import_qgis():
    files = [path for folder in ("core", "products", "simulator", "algorithms", "library") for path in (ROOT / folder).rglob("*.py")]
    found = [path for path in files if re.search(r"^\s*(import|from) qgis", path.read_text(encoding="utf-8"), re.M)]
    assert not found


def test_importing_the_package_loads_nothing():
    code = ("import sys, importlib.util as u; s = u.spec_from_file_location('lanewright', sys.argv[1], "
            "submodule_search_locations=[]); m = u.module_from_spec(s); s.loader.exec_module(m); "
            "sys.exit(bool({'qgis', 'numpy', 'laspy'} & set(sys.modules)))")
    assert subprocess.run([sys.executable, "-S", "-c", code, str(ROOT / "__init__.py")]).returncode == 0


def test_libraries_are_looked_for_after_those_of_qgis(monkeypatch, tmp_path):
    import lanewright

    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setenv("LANEWRIGHT_LIBS", str(tmp_path))
    before = list(sys.path)
    lanewright.add_library_folders()
    lanewright.add_library_folders()
    assert sys.path[: len(before)] == before and sys.path.count(str(tmp_path)) == 1


def shipped():
    """The code users get."""
    folders = [ROOT / folder for folder in ("core", "products", "simulator", "algorithms", "library", "processing_provider", "desktop")]
    return [ROOT / "__init__.py", ROOT / "plugin.py", *(file for folder in folders for file in folder.rglob("*.py"))]


def test_nothing_is_fetched_or_sent():
    network = re.compile(r"^\s*(?:import|from)\s+(?:urllib|requests|http|socket|ftplib|smtplib|aiohttp|dask|distributed)\b"
                         r"|QtNetwork|QgsNetwork|QgsBlockingNetwork", re.M)
    # the scheduler of a cluster that the user names is the one exception
    assert [path.name for path in shipped() if network.search(path.read_text(encoding="utf-8"))] == ["cluster.py"]


WORKERS = [ROOT / "core" / "execution" / name for name in ("tasks.py", "processes.py", "worker.py", "cluster.py", "folder_executor.py")]
# Which remove folders that a run made for itself: its work folder, its shared points, and the hidden ones of results that are not finished
FOLDERS_OF_RUNS = [ROOT / name for name in ("core/execution/work_folder.py", "core/survey/open_survey.py", "core/io/local_files.py",
                                            "algorithms/destinations.py")]


def test_no_input_is_ever_run():
    """Not as Python, not as a program, not unpickled, not unpacked. Worker processes alone are started; the folders of runs alone are removed."""
    acting = re.compile(r"(?<![\w.])(?:eval|exec|compile|__import__)\(|\bpickle\b|\bmarshal\b|\bsubprocess\b|os\.system|os\.popen"
                        r"|\bshelve\b|allow_pickle=True|\bzipfile\b|\btarfile\b|rmtree")
    found = [(path.name, match.group()) for path in shipped() for match in acting.finditer(path.read_text(encoding="utf-8"))
             if not (path in WORKERS and match.group() in ("subprocess", "rmtree")) and not (path in FOLDERS_OF_RUNS and match.group() == "rmtree")
             and not re.match(r"\s*(#|\"\"\")", path.read_text(encoding="utf-8")[:match.start()].rpartition("\n")[2])]
    assert not found


def test_every_test_that_a_promise_names_is_there():
    named = re.findall(r"`(tests/[\w/]+\.py)`", (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8"))
    assert len(named) > 10 and not [name for name in named if not (ROOT / name).exists()]


def test_the_version_stands_in_one_place_and_the_changelog_knows_it(metadata):
    assert f"## {metadata['version']}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    code = [path for path in shipped() if re.search(rf"['\"]{re.escape(metadata['version'])}['\"]", path.read_text(encoding="utf-8"))]
    assert not code
