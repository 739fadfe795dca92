"""German speaks in every dialog, and the way to another language is open."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from lanewright.processing_provider.texts import TRANSLATIONS, chosen_language, install_translator, remove_translator, tr

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))


def messages(language):
    tree = ET.parse(TRANSLATIONS / f"lanewright_{language}.ts")
    return {message.findtext("source"): message.find("translation") for message in tree.getroot().iter("message")}


def test_every_text_of_the_code_is_in_the_translation_and_finished():
    from translations import texts

    german = messages("de")
    assert set(german) == set(texts()), "run make translations"
    unfinished = [source for source, target in german.items() if target.get("type") == "unfinished" or not target.text]
    assert not unfinished


def test_what_qgis_loads_is_what_was_translated(qgis_app):
    german = install_translator("de")
    try:
        stale = [source for source, target in messages("de").items() if tr(source) != target.text]
    finally:
        remove_translator(german)
    assert not stale, "run make translations"


def test_places_for_names_and_numbers_are_kept():
    """A translation that loses {path} would hide what the message is about, and one that invents it would fail."""
    places = re.compile(r"\{[^}]*\}")
    wrong = [source for source, target in messages("de").items() if sorted(places.findall(source)) != sorted(places.findall(target.text or ""))]
    assert not wrong


def test_labels_keep_their_units():
    units = re.compile(r"\((?:m|m²|s|°|%|km/h)\)$")
    wrong = [source for source, target in messages("de").items()
             if units.search(source) and not (target.text or "").endswith(units.search(source).group())]
    assert not wrong


def test_the_language_of_the_command_line_comes_before_that_of_the_system(qgis_app):
    system = chosen_language()
    try:
        qgis_app.setTranslation("de")
        assert chosen_language() == "de"
    finally:
        qgis_app.setTranslation("")
    assert chosen_language() == system


def test_a_german_qgis_shows_german_and_an_unknown_language_english(qgis_app):
    assert install_translator("tlh") is None
    german = install_translator("de_AT")
    try:
        assert tr("Point clouds") == "Punktwolken"
    finally:
        remove_translator(german)
    assert tr("Point clouds") == "Point clouds"


@pytest.mark.slow
def test_a_german_qgis_process_speaks_german(tmp_path):
    """Labels are made when the plugin is imported, so this is asked of a program of its own."""
    settings = tmp_path / "profiles" / "default" / "QGIS" / "QGIS3.ini"
    settings.parent.mkdir(parents=True)
    settings.write_text("[locale]\noverrideFlag=true\nuserLocale=de\n\n[PythonPlugins]\nlanewright=true\n")
    call = f"source tools/env.sh; export QGIS_CUSTOM_CONFIG_PATH='{tmp_path}'; exec qgis_process help lanewright:roadmap"
    run = subprocess.run(["bash", "-c", call], cwd=ROOT, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert "POINT_CLOUDS: Punktwolken" in run.stdout and "Verkehrsseite" in run.stdout, run.stderr
