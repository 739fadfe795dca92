"""The notebook of the first road map runs from its first cell to its last."""

import json
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).resolve().parents[2] / "docs" / "first_map.ipynb"


@pytest.mark.slow
def test_ten_cells_lead_from_points_to_a_map_a_surface_an_hd_map_and_classes(tmp_path, monkeypatch, capsys):
    pytest.importorskip("osgeo")
    monkeypatch.chdir(tmp_path)
    cells, names = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"], {"__name__": "notebook"}
    assert len(cells) == 10
    for number, cell in enumerate(cells):
        if cell["cell_type"] == "code":
            assert not cell["outputs"], "results of an older version are not kept"
            exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
    assert {"street.xodr", "street.osm", "surface.xml", "report.html", "map.gpkg"} < {path.name for path in tmp_path.iterdir()}
    assert (tmp_path / "classified" / "street.laz").exists() and names["cloud"]["ROAD_POINTS"] > 100_000
    lanes = {fields["lane"] for _, fields in names["features"]("driving_lines")}
    assert len(lanes) >= 2 and "confidence 0.9" in capsys.readouterr().out
