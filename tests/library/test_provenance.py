"""What a result tells about where it comes from, with the folders of its inputs and without."""

import json

import fiona
import pytest
from lanewright.algorithms.destinations import table_of
from lanewright.algorithms.provenance import provenance_now
from lanewright.library import run

VALUES = {"POINT_CLOUDS": ["/home/anna/Kunde Müller/a.laz", r"C:\Users\anna\b.laz", "c.laz"], "COUNTRY": "germany", "MAX_GAP": 2.5,
          "MARKINGS": "ogr:dbname='/home/anna/map.gpkg' table=\"markings\" (geom)", "ROAD_EDGES": "data/map.gpkg|layername=edges",
          "CRS": 'PROJCRS["WGS 84 / UTM zone 50N"]', "WHERE": "\"use\" = 'a/b'"}


def test_names_of_files_stay_and_their_folders_go():
    told = json.loads(provenance_now("roadmap", VALUES, ["/home/anna/Kunde Müller/a.laz is dark."], names_only=True).parameters)
    assert told["POINT_CLOUDS"] == ["a.laz", "b.laz", "c.laz"] and told["ROAD_EDGES"] == "map.gpkg|layername=edges"
    assert "dbname='map.gpkg'" in told["MARKINGS"] and told["CRS"].endswith("UTM zone 50N']") and told["WHERE"] == "'use' = 'a/b'"
    quoted = {"A": "/home/O'Neil/x/a.laz", "B": table_of("/home/O'Neil/map.gpkg", "a")}
    assert json.loads(provenance_now("roadmap", quoted, names_only=True).parameters) == {"A": "a.laz", "B": "ogr:dbname='map.gpkg' table='a' (geom)"}
    assert (told["COUNTRY"], told["MAX_GAP"]) == ("germany", 2.5)
    assert provenance_now("roadmap", VALUES, ["/home/anna/Kunde Müller/a.laz is dark."], names_only=True).warnings == ("a.laz is dark.",)
    assert "/home/anna" in provenance_now("roadmap", VALUES).parameters


@pytest.mark.parametrize("names_only", ["", "1"])
def test_a_user_who_says_so_gives_no_folder_away(tmp_path, monkeypatch, names_only):
    monkeypatch.setenv("LANEWRIGHT_NAMES_ONLY", names_only)
    (tmp_path / "drive.csv").write_text("time,x,y,z\n" + "".join(f"{k},{500000 + k},4000000,10\n" for k in range(20)))
    run("importtrajectory", INPUT=tmp_path / "drive.csv", INPUT_CRS="EPSG:32650", OUTPUT=tmp_path / "drive.gpkg")
    content = (tmp_path / "drive.gpkg").read_bytes()
    assert b"drive.csv" in content and (str(tmp_path).encode() in content) is (not names_only)
    with fiona.open(tmp_path / "drive.gpkg") as layer:
        assert len(layer) == 20
