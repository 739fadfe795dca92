"""The command line and the library in another language, without QGIS."""

import pytest
from lanewright import library
from lanewright.core.common.texts import language, told, tr
from lanewright.library import command_line


@pytest.fixture
def german():
    library.speak("de_AT")
    yield
    library.speak("en")


@pytest.mark.parametrize("asked", [["--lang", "de"], ["--lang=de"]])
def test_help_in_german_has_german_words_and_the_names_of_the_parameters(asked, capsys):
    with pytest.raises(SystemExit):
        command_line.main(["detectcurbs", *asked, "--help"])
    said = capsys.readouterr().out
    assert "--POINT_CLOUDS" in said and "Punktwolken." in said and "nötig" in said
    assert language() == "en" and tr("Point clouds") == "Point clouds"


def test_the_list_of_algorithms_is_german_in_german_alone(capsys):
    assert command_line.main(["list", "--lang", "de"]) == command_line.main(["list"]) == 0
    german, english = (line for line in capsys.readouterr().out.splitlines() if line.startswith("detectcurbs"))
    assert "Bordstein" in german and "finds the curb" in english.lower()


@pytest.mark.parametrize("arguments", [["nosuch"], ["detectcurbs", "--CELL=1"], ["detectcurbs"]])
def test_a_refusal_is_german(arguments, capsys):
    assert command_line.main([*arguments, "--lang", "de"]) == 1
    german = capsys.readouterr().err
    assert command_line.main(arguments) == 1
    assert german.strip() and german != capsys.readouterr().err


def test_a_language_that_nobody_translated_is_refused_by_name(capsys):
    assert command_line.main(["list", "--lang", "tlh"]) == 1
    assert "tlh" in capsys.readouterr().err and language() == "en"


def test_a_script_hears_german_once_it_asked_for_it(german):
    assert library.algorithms()["detectcurbs"].title() == "Bordsteine erkennen"
    assert told("Detecting curbs …") == "Bordsteine werden gesucht …"
    assert library.algorithms()["detectcurbs"].parameter("MAX_HEIGHT").label.startswith("Größte Bordsteinhöhe")
