"""Two people who review one survey, each in a project of their own."""

import os
import re
from dataclasses import replace
from datetime import datetime, timedelta, timezone
from types import SimpleNamespace
from uuid import uuid4

import pytest
from doubtful_street import corrections
from lanewright.desktop.review.corrections_layer import add_correction, corrections_of, new_corrections_layer, place_beside
from lanewright.processing_provider.results.road_maps import output_of, place_layer, road_maps
from qgis.core import QgsDataSourceUri, QgsGeometry, QgsPointXY, QgsProject, QgsProviderRegistry
from road_map_layers import EAST, NORTH, run_at


def place_of_colleagues(kind, folder):
    """A new file, or a new table of the server that libpq's variables name."""
    if kind == "file":
        return str(folder / "corrections.gpkg")
    return f"dbname='{os.environ['PGDATABASE']}' key='id' table=\"public\".\"corrections_{uuid4().hex[:8]}\" (geom)"


@pytest.fixture(params=["file", *(["database"] if os.environ.get("PGHOST") else [])])
def colleague(request, at_first, tmp_path):
    """The corrections of the window, which has accepted the first edge, as a colleague has them open: by a connection and project of his own."""
    place = place_of_colleagues(request.param, tmp_path)
    at_first.ask_for_file = lambda: place
    at_first.ask = lambda question: pytest.fail(f"nothing is to be asked: {question}")
    at_first.accept_button.click()
    theirs = QgsProject()
    yield new_corrections_layer(theirs, place, at_first.layer.crs(), "B12")
    if request.param == "database":
        QgsProviderRegistry.instance().providerMetadata("postgres").createConnection(place, {}).dropVectorTable(
            "public", re.search("corrections_[^\"]*", place)[0])


def decides(colleague, piece, action, author="Ada"):
    """What the window of the colleague writes."""
    former = corrections_of(colleague, [piece], colleague.crs()).get(0)
    number = add_correction(colleague, piece.line, colleague.crs(), former, action=action, target=piece.target, road=piece.road,
                            station_m=piece.station)
    colleague.dataProvider().changeAttributeValues({number: {colleague.fields().lookupField("author"): author}})


def test_two_people_decide_about_different_places_and_see_what_the_other_has_done(at_first, colleague):
    decides(colleague, at_first.places[1].pieces[0], "delete")
    at_first.accept_button.click()
    assert [action for action, *_ in corrections()] == ["accept", "delete", "accept"] and "3." in at_first.kept.text()
    assert at_first.place.station == 80 and "2 done" in at_first.where.text()
    assert "→ delete (Ada)" in at_first.list.item(0).text()
    begin, end = QgsPointXY(EAST + 20, NORTH + 4), QgsPointXY(EAST + 31, NORTH + 4)
    add_correction(colleague, QgsGeometry.fromPolylineXY([begin, end]), colleague.crs(), action="draw", target="edge")
    assert len(corrections()) == 4


def test_who_decides_later_about_the_same_piece_is_told_and_chooses(at_first, colleague):
    asked = []
    at_first.ask = lambda question: bool(asked.append(question))
    decides(colleague, at_first.chosen[0], "delete")
    at_first.accept_button.click()
    assert len(asked) == 1 and "→ delete (Ada)" in asked[0] and [action for action, *_ in corrections()] == ["accept", "delete"]
    assert "→ delete (Ada)" in at_first.list.currentItem().text(), "the list shows what holds now"
    at_first.accept_button.click()
    assert len(asked) == 1 and [action for action, *_ in corrections()] == ["accept", "accept"], "seen and decided: theirs makes room"


def test_a_line_that_moves_what_a_colleague_has_decided_meanwhile_is_not_lost(at_first, colleague):
    at_first.move_button.click()
    decides(colleague, at_first.chosen[0], "delete")
    at_first.ask = lambda question: "→ delete (Ada)" in question
    for x in (14, 22):
        at_first.tool.add(QgsPointXY(EAST + x, NORTH + 1))
    at_first.tool.finish()
    assert [action for action, *_ in corrections()] == ["accept", "move"]


def test_a_correction_of_a_colleague_is_not_taken_back(at_first, colleague):
    decides(colleague, at_first.places[1].pieces[0], "delete")
    at_first.undo_button.click()
    assert [action for action, *_ in corrections()] == ["delete"] and not at_first.undo_button.isEnabled()


def test_what_a_colleague_has_corrected_since_is_not_in_the_map(at_first, tmp_path):
    project, other = QgsProject.instance(), QgsProject()
    at_first.accept_button.click()
    at_first.layer.setCustomProperty("lanewright/changes", [])
    run = run_at(9, CORRECTIONS="corrections.gpkg")
    for layer in at_first.road_map.layers:
        place_layer(layer, project, output_of(layer), replace(run, provenance=replace(run.provenance, ended=datetime.now(timezone.utc))))
    at_first.road_map = road_maps(project)[0]
    at_first._tell()
    assert "in this map" in at_first.kept.text()
    theirs = new_corrections_layer(other, str(tmp_path / "corrections.gpkg"), at_first.layer.crs(), "B12")
    number = add_correction(theirs, at_first.places[1].pieces[0].line, theirs.crs(), action="delete", target="edge")
    later = f"{datetime.now(timezone.utc) + timedelta(seconds=5):%Y-%m-%d %H:%M:%S}"
    theirs.dataProvider().changeAttributeValues({number: {theirs.fields().lookupField("decided_at"): later}})
    at_first._tell()
    assert "when it is made again" in at_first.kept.text()


@pytest.mark.parametrize("table, beside", [("b12_road_edges", "b12_corrections"), ("B12_ROAD_EDGES", "B12_corrections"), ("Curbs", "corrections")])
def test_corrections_of_a_map_in_postgis_lie_beside_its_tables(table, beside):
    source = f"dbname='maps' host=server user='ada' key='id' table=\"Road's maps\".\"{table}\" (geom)"
    layer = SimpleNamespace(providerType=lambda: "postgres", source=lambda: source)
    uri = QgsDataSourceUri(place_beside(SimpleNamespace(vectors=[layer], layers=[layer], outputs=["ROAD_EDGES"])))
    assert (uri.schema(), uri.table(), uri.geometryColumn(), uri.keyColumn(), uri.username()) == ("Road's maps", beside, "geom", "id", "ada")
