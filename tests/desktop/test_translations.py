"""German speaks in every dialog, and the way to another language is open."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from lanewright.algorithms.texts import TRANSLATIONS
from lanewright.processing_provider.styling import STYLES, apply_style
from lanewright.processing_provider.texts import chosen_language, numbers, speak, told, tr
from qgis.core import QgsLayerTreeModel, QgsVectorLayer
from qgis.PyQt.QtCore import Qt

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))


@pytest.fixture
def german(qgis_app):
    speak("de")
    yield
    speak("en")


def messages(language):
    return json.loads((TRANSLATIONS / f"lanewright_{language}.json").read_text(encoding="utf-8"))


def test_every_text_of_the_code_is_in_the_translation_and_finished():
    from translations import texts

    german = messages("de")
    assert set(german) == set(texts()), "run make translations"
    assert all(german.values())


def test_numbers_have_a_comma_in_german_and_names_and_versions_stay(german):
    assert tr("{what} {number:.1f} cm").format(what="tile 1.5", number=1.44) == "tile 1.5 1,4 cm"
    assert numbers("±3.5 m (1,042,726.5) of 0.2.0") == "±3,5 m (1.042.726,5) of 0.2.0"
    folder = Path("/data/part 2.5 again/lidar-1.2/drive.kml")
    assert str(folder) in tr("{label} was to be written to {path}, which is a folder. Name a file in it.", label="Report", path=folder)
    assert told("/data/lidar-1.2/drive.kml holds no track. A drive is a track (layer track_points): save it with its track, or choose the layer of "
                "positions.").startswith("/data/lidar-1.2/drive.kml ")
    assert "1,5 m" in told("Minimum curb height is 1.5 m; it must be between 0.01 m and 0.5 m.")


def test_places_for_names_and_numbers_are_kept():
    """A translation that loses {path} would hide what the message is about, and one that invents it would fail."""
    places = re.compile(r"\{[^}]*\}")
    wrong = [source for source, target in messages("de").items() if sorted(places.findall(source)) != sorted(places.findall(target))]
    assert not wrong


def test_labels_keep_their_units():
    units = re.compile(r"\((?:m|m²|s|°|%|km/h)\)$")
    wrong = [source for source, target in messages("de").items()
             if units.search(source) and not target.endswith(units.search(source).group())]
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
    assert not speak("tlh") and tr("Point clouds") == "Point clouds"
    try:
        assert speak("de_AT") and tr("Point clouds") == "Punktwolken"
    finally:
        speak("en")
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


def test_every_choice_of_a_dialog_has_a_word_in_german_or_is_a_name():
    from lanewright.algorithms.catalogue import ALGORITHMS
    from translations import CHOICES, NAMES

    choices = {choice for algorithm in ALGORITHMS for spec in algorithm().parameters for choice in getattr(spec, "choices", ())}
    assert choices <= {*CHOICES, *NAMES}


def test_a_choice_reads_german_and_keeps_its_value(german, provider, monkeypatch):
    from lanewright.algorithms.driving import RoadMap
    from lanewright.desktop.survey_widgets import ChoiceWrapper
    from lanewright.processing_provider.algorithm import qgis_parameter
    from processing.gui import ParametersPanel
    from processing.gui.AlgorithmDialog import AlgorithmDialog
    from qgis.core import QgsApplication

    parameter = qgis_parameter(RoadMap().parameter("BOUNDARY_METHOD"))
    assert parameter.metadata()["widget_wrapper"]["class"].endswith("ChoiceWrapper")
    monkeypatch.setattr(ParametersPanel, "iface", None)  # pytest-qgis has a stand-in that this panel refuses
    dialog = AlgorithmDialog(QgsApplication.processingRegistry().createAlgorithmById("lanewright:roadmap"))
    wrapper = ChoiceWrapper(parameter, dialog)
    assert wrapper.value() == parameter.defaultValue()
    wrapper.setValue("scanlines")
    assert (wrapper.widget.currentText(), wrapper.value()) == ("Scanlinien", "scanlines")


# -- what the core says ---------------------------------------------------------------------------------


def test_the_legend_of_a_layer_that_is_in_the_tree_already_turns_german(german, project):
    """QGIS adds a result to the layer tree first and gives it its style then."""
    layer = QgsVectorLayer("LineStringZ?crs=EPSG:32650&field=role:string", "Residuals", "memory")
    project.addMapLayer(layer)
    model = QgsLayerTreeModel(project.layerTreeRoot())
    apply_style(layer, STYLES / "residuals.qml")
    nodes = model.layerLegendNodes(project.layerTreeRoot().findLayer(layer.id()))
    assert [str(node.data(Qt.ItemDataRole.DisplayRole)) for node in nodes][1:] == ["Prüfpunkt (Restklaffung × 100)", "Abgeschalteter Punkt"]


@pytest.mark.parametrize(("said", "told_in_german"), [
    ("Detecting curbs …", "Bordsteine werden gesucht …"),
    ("Road edges: 1,204 m measured, 18 m bridged.", "Straßenränder: 1.204 m gemessen, 18 m überbrückt."),
    ("Driving lines: 2 lanes, right-hand traffic: 99 m measured", "Fahrlinien: 2 Fahrstreifen, Verkehr auf Seite rechts: 99 m gemessen"),
    ("Driving lines: 2 lanes, right-hand traffic: 99 m measured, 7 m inferred",
     "Fahrlinien: 2 Fahrstreifen, Verkehr auf Seite rechts: 99 m gemessen, 7 m erschlossen"),
    ("There is no file /data/B12/a.laz. Check the path of the point cloud.", "Es gibt keine Datei /data/B12/a.laz. Den Pfad der Punktwolke prüfen."),
    ("The cell size is 0 m; it must be between 0.001 and 10 m.", "Die Zellgröße ist 0 m; erlaubt ist zwischen 0,001 und 10 m."),
    ("CJJ 37-2012: radius allows 60 km/h, length 11 m is below 25 m, the least for 30 km/h",
     "CJJ 37-2012: der Radius erlaubt 60 km/h, die Länge 11 m liegt unter 25 m, der kleinsten für 30 km/h"),
    ("Measure more points. No paint was found on this road, so there are no marking lines and no driving lines.",
     "Mehr Punkte messen. Auf dieser Straße wurde keine Farbe gefunden; es gibt daher keine Markierungslinien und keine Fahrlinien."),
    ("No paint was found on this road, so there are no marking lines: driving lines lead between its borders.",
     "Auf dieser Straße wurde keine Farbe gefunden; es gibt daher keine Markierungslinien: "
     "Die Fahrlinien verlaufen zwischen den Rändern der Straße."),
    ("kink at a link", "Knick an einer Verknüpfung"),
    ("0.12 rad between it and lane -2 of road 7 at its start.", "0,12 rad zwischen ihm und Streifen -2 der Straße 7 an seinem Anfang."),
    ("The column 'Time' of a.csv holds times of a clock such as '1/2/2021 23:46'. GPS seconds are needed, and day and month cannot be distinguished. "
     "Export the trajectory with GPS time in seconds; or write dates as year-month-day.",
     "Die Spalte 'Time' von a.csv enthält Uhrzeiten wie '1/2/2021 23:46'. Nötig sind GPS-Sekunden, und Tag und Monat sind nicht zu "
     "unterscheiden. Die Trajektorie mit GPS-Zeit in Sekunden exportieren; oder Daten als Jahr-Monat-Tag schreiben."),
    ("The column 't' of a.csv goes up by 1.2e-05 from row to row as if it counted days, but 7.5 is no day of a known count (MJD, Julian days, a "
     "spreadsheet). GPS seconds are needed: export the trajectory with these.",
     "Die Spalte 't' von a.csv steigt um 1.2e-05 von Zeile zu Zeile, als würden Tage gezählt, aber 7,5 ist kein Tag einer bekannten Zählung (MJD, "
     "julianisches Datum, Tabellenkalkulation). Nötig sind GPS-Sekunden: die Trajektorie mit diesen exportieren."),
    ("The heights of the cloud alone seem to be in feet where x and y are in metres: the laser beams meet in the scanner only if heights are "
     "multiplied by 0.3048. Convert these heights, and run again.",
     "Die Höhen der Wolke allein sind anscheinend in Fuß, während x und y in Metern sind: Die Laserstrahlen treffen sich nur dann im Scanner, wenn "
     "die Höhen mit 0,3048 multipliziert werden. Diese Höhen umrechnen und neu starten."),
    ("Corrections that match nothing in this run any more (2): road 0, left side, station 260 to 270 m; road 0, right side, station 90 to 100 m.",
     "Korrekturen, die in diesem Lauf zu nichts mehr passen (2): Straße 0, Seite links, Station 260 bis 270 m; "
     "Straße 0, Seite rechts, Station 90 bis 100 m."),
    ("/data/B12/my roads/a 1.laz", "/data/B12/my roads/a 1.laz"),
    ("Something that nobody has translated.", "Something that nobody has translated."),
])
def test_what_the_core_says_is_told_in_german_with_its_numbers_and_names(german, said, told_in_german):
    assert told(said) == told_in_german


def test_a_run_that_fails_says_why_in_german(german, provider, tmp_path):
    import processing
    from qgis.core import QgsProcessingException

    empty = tmp_path / "drive.csv"
    empty.write_text("", encoding="utf-8")
    with pytest.raises(QgsProcessingException, match="Die Trajektorie neu exportieren"):
        processing.run("lanewright:importtrajectory", {"INPUT": str(empty), "OUTPUT": "memory:"})


def test_a_report_of_a_german_qgis_is_german(german):
    from lanewright.products.export.check.findings import Finding, Findings
    from lanewright.products.report.hd_map import map_check_report

    page = map_check_report(Findings([Finding("kink", "road 1, section 2, lane -1", "The rule is XYZ.", (0.0, 0.0, 0.0))]), "map.xodr")
    assert '<html lang="de">' in page and "Prüfung einer HD-Karte" in page
    assert "<td>Knick</td>" in page and "Straße 1, Abschnitt 2, Streifen -1" in page and "Die Regel ist XYZ." in page


def test_nearly_all_that_the_core_says_has_a_translation_with_its_places():
    """Not all: a sentence that was added or changed yesterday is told in English until somebody translates it."""
    from translations import core_messages

    known = json.loads((TRANSLATIONS / "core_de.json").read_text(encoding="utf-8"))
    said = core_messages()
    assert sum(bool(known.get(text)) for text in said) > 0.9 * len(said)
    assert not [text for text, german in known.items() if german and text.count("{}") != german.count("{}")]


def test_the_stages_of_a_model_have_german_names_in_the_designer(german, provider):
    from lanewright.processing_provider.provider import read_model

    model = read_model(ROOT / "resources" / "models" / "road_map.model3")
    stages = [stage.description() for stage in model.childAlgorithms().values()]
    assert "Straßenränder erkennen" in stages and not [stage for stage in stages if stage.startswith(("Extract", "Detect", "Fit"))]
