"""The boundary methods through Processing: every one draws edges, both say how far apart they are."""

import pytest
from osgeo import ogr
from qgis.core import QgsProcessingFeedback

pytestmark = pytest.mark.slow

ogr.UseExceptions()


def edges_of(path):
    source = ogr.Open(str(path))
    return [feature.items() for feature in source.GetLayer(0)]


def assert_both_sides_of(method, edges):
    rows = edges_of(edges)
    assert {row["side"] for row in rows} == {"left", "right"}
    told = [row["agree_cm"] for row in rows if row["agree_cm"] is not None]
    assert bool(told) == (method == "both") and all(cm < 5 for cm in told)


@pytest.mark.parametrize("method", ["profiles", "scanlines"])
def test_one_method_draws_both_sides(street, tmp_path, method):
    import processing

    edges = tmp_path / "edges.gpkg"
    processing.run("lanewright:detectboundaries", {
        "POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"], "BOUNDARY_METHOD": method, "ROAD_EDGES": str(edges),
    })
    assert_both_sides_of(method, edges)


def test_both_methods_draw_both_sides_and_worker_processes_draw_the_same_edges(street, tmp_path):
    """To the last bit, started from inside QGIS."""
    import processing

    drawn = []
    for workers in (0, 2):
        edges, heard = tmp_path / f"edges{workers}.gpkg", QgsProcessingFeedback(False)
        processing.run("lanewright:detectboundaries", {
            "POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"], "BOUNDARY_METHOD": "both", "WORKERS": workers,
            "ROAD_EDGES": str(edges),
        }, feedback=heard)
        assert ("worker process" in heard.textLog()) == bool(workers)
        source = ogr.Open(str(edges))
        drawn.append([(bytes(feature.geometry().ExportToWkb()), feature.items()) for feature in source.GetLayer(0)])
        assert_both_sides_of("both", edges)
    assert drawn[0] == drawn[1]


def test_scanlines_of_a_layer_give_corners_and_boundaries(street, tmp_path):
    import processing

    scanlines, corners, boundaries = (str(tmp_path / f"{name}.gpkg") for name in ("scanlines", "corners", "boundaries"))
    processing.run("lanewright:normalizedscanlines", {
        "POINT_CLOUDS": [street["POINT_CLOUD"]], "TRAJECTORY": street["TRAJECTORY"], "SCANLINES": scanlines,
    })
    processing.run("lanewright:boundariesfromscanlines", {
        "SCANLINES": scanlines, "TRAJECTORY": street["TRAJECTORY"], "CORNERS": corners, "BOUNDARIES": boundaries,
    })
    assert {(row["side"], row["part"]) for row in edges_of(boundaries)} == {(s, p) for s in ("left", "right") for p in ("bottom", "top")}
    measured = [row for row in edges_of(corners) if row["status"] == "measured"]
    assert len(measured) > 100 and {row["part"] for row in measured} == {"bottom", "top"}
    assert all(row["height_m"] > 0.03 and row["support"] >= 30 for row in measured)
