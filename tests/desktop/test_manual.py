"""The manual: written from the algorithms themselves, complete and up to date."""

import re
import sys
from pathlib import Path

import pytest
from lanewright.algorithms.catalogue import ALGORITHMS
from lanewright.processing_provider.algorithm import LanewrightAlgorithm

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "docs" / "manual"
sys.path.insert(0, str(ROOT / "tools"))


@pytest.fixture(scope="module")
def made(provider):
    from make_manual import pages

    return pages(ALGORITHMS)


def test_every_page_says_what_the_dialogs_say(made):
    stale = [name for name, text in made.items() if not (PAGES / name).exists() or (PAGES / name).read_text(encoding="utf-8") != text]
    assert not stale, "run make manual"


def test_no_page_is_left_of_an_algorithm_that_is_gone(made):
    from make_manual import WRITTEN_BY_HAND

    assert {page.name for page in PAGES.glob("*.md")} == set(made) | {f"{name}.md" for name in WRITTEN_BY_HAND}


@pytest.mark.parametrize("algorithm", ALGORITHMS, ids=lambda algorithm: algorithm.ID)
def test_the_help_button_opens_the_page_of_the_algorithm(provider, algorithm):
    scheme, _, name = LanewrightAlgorithm(algorithm()).create().helpUrl().partition(":")
    assert scheme == "lanewright" and (PAGES / f"{name}.md").is_file()


def test_links_and_pictures_lead_somewhere():
    for page in PAGES.glob("*.md"):
        for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
            assert target.startswith("http") or (PAGES / target).exists(), f"{page.name}: {target}"


def test_the_troubleshooting_quotes_what_is_really_said():
    """Every message of the page is a sentence of the code, with gaps for the numbers."""
    folders = ("core", "products", "simulator", "algorithms", "processing_provider")
    code = "".join(path.read_text(encoding="utf-8") for folder in folders for path in (ROOT / folder).rglob("*.py"))
    # Sentences in the code are cut into strings, and hold braces where the page has …
    said = re.sub(r'"\s*\n?\s*f?"', "", code)
    for message in re.findall(r"^### (.+)$", (PAGES / "troubleshooting.md").read_text(encoding="utf-8"), re.M):
        for part in (part.strip(" .") for part in message.split("…")):
            assert part in said, f"{message}: {part}"


def test_every_file_a_command_reads_is_written_by_the_command_of_another_page(made):
    """In one folder, from the sample survey on; a trajectory as text, an extract of OpenStreetMap and the template of a client are what
    people bring."""
    read, written = set(), {"trajectory.csv", "template.csv", "streets.osm"}
    for algorithm in ALGORITHMS:
        made_with = LanewrightAlgorithm(algorithm()).create()
        definitions = {d.name(): d for d in made_with.parameterDefinitions()}
        for name, file in re.findall(r"--([A-Z_]+)=(\S+)", made[f"{algorithm.ID}.md"]):
            (written if definitions[name].isDestination() else read).add(file)
    assert read and read <= written, sorted(read - written)


def test_commands_name_the_control_points_and_every_input_that_must_be_given(made):
    from make_manual import optional

    assert "--GCPS=" in made["georeferenceimage.md"].split("## On the command line")[1]
    for algorithm in ALGORITHMS:
        command = made[f"{algorithm.ID}.md"].split("## On the command line")[1]
        made_with = LanewrightAlgorithm(algorithm()).create()
        for d in made_with.parameterDefinitions():
            if d.isDestination() or not optional(d) and d.defaultValue() is None:
                assert f"--{d.name()}=" in command, f"{algorithm.ID}: {d.name()}"
