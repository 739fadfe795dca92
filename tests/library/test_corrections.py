"""Corrections of an analyst in a road map made without QGIS."""

import fiona
import pytest
from heard import Heard
from lanewright.core.common.errors import RoadExtractionError
from lanewright.library import Progress, run

SCHEMA = {"geometry": "LineString", "properties": {"action": "str", "target": "str", "note": "str"}}


def mapped(street, folder, name, progress=Progress(), **more):
    return run("roadmap", progress=progress, POINT_CLOUDS=[street / "s.laz"], TRAJECTORY=street / "drive.gpkg", BOUNDARY_METHOD="profiles",
               ROAD_EDGES=folder / f"{name}.gpkg", PASSES=folder / f"{name}_passes.gpkg", REPORT=folder / f"{name}.html", **more)


def rows(path):
    with fiona.open(path) as layer:
        return [(feature.geometry["coordinates"], dict(feature.properties)) for feature in layer], layer.crs_wkt


def write(path, crs, *corrections):
    with fiona.open(path, "w", driver="GPKG", schema=SCHEMA, crs_wkt=crs) as layer:
        for places, action, target, note in corrections:
            layer.write({"geometry": {"type": "LineString", "coordinates": [place[:2] for place in places]},
                         "properties": {"action": action, "target": target, "note": note}})
    return path


@pytest.mark.slow
def test_an_edge_is_deleted_another_kept_and_what_matches_nothing_is_listed(street, tmp_path):
    before = mapped(street, tmp_path, "before")
    edges, crs = rows(before["ROAD_EDGES"])
    gone = max((edge for edge in edges if edge[1]["kind"] == "main"), key=lambda edge: edge[1]["length_m"])
    far = [(x, y + 40) for x, y, _ in gone[0]]
    heard = Heard()
    after = mapped(street, tmp_path, "after", heard, CORRECTIONS=write(
        tmp_path / "corrections.gpkg", crs, (gone[0], "delete", "edge", "a wall"), (far, "delete", "edge", "no road here")))
    assert after["EDGE_LENGTH"] == pytest.approx(before["EDGE_LENGTH"] - gone[1]["length_m"], abs=0.01)
    assert (after["CORRECTIONS_MADE"], after["CORRECTIONS_UNMATCHED"]) == (1, 1)
    assert any("no road here" in text for text in heard.warned)
    report = (tmp_path / "after.html").read_text(encoding="utf-8")
    assert "that match nothing in this run and were left out: 1." in report and "a wall" in report
    passes, _ = rows(before["PASSES"])
    assert [row["direction"] for _, row in passes] == [1] and passes[0][1]["length_m"] > 60


def test_a_layer_that_holds_no_corrections_is_refused_by_the_fields_it_lacks(street, tmp_path):
    with pytest.raises(RoadExtractionError, match="Corrections lacks the field.* action, target"):
        mapped(street, tmp_path, "map", CORRECTIONS=street / "drive.gpkg")
