"""A survey without a trajectory: estimated by itself, or on the way to the road map."""

import fiona
import numpy as np
import pytest
import shapely
from heard import Heard
from lanewright.library import run
from shapely.geometry import shape


@pytest.fixture(scope="module")
def survey(made_once):
    return made_once("survey_without_trajectory", lambda folder: run(
        "samplesurvey", LENGTH=50, PULSE_RATE=80_000, POINT_CLOUD=folder / "s.laz", TRAJECTORY=folder / "drive.gpkg"))


def rows(path):
    with fiona.open(path) as layer:
        return np.array([(f.properties["time"], *f.geometry.coordinates) for f in layer]), list(layer.schema["properties"])


def test_the_estimate_lies_on_the_drive_and_says_how_sure_it_is(survey, tmp_path):
    results = run("estimatetrajectory", POINT_CLOUDS=[survey / "s.laz"], TRAJECTORY=tmp_path / "estimated.gpkg", REPORT=tmp_path / "report.html")
    assert results["SCANNERS"] == 2 and results["LENGTH"] > 60 and results["SIGMA"] < 0.05
    found, fields = rows(results["TRAJECTORY"])
    assert fields == ["time", "roll", "pitch", "heading", "pass", "road", "station_m", "sigma_m", "sigma_z_m"]
    true, _ = rows(survey / "drive.gpkg")
    away = np.stack([found[:, k] - np.interp(found[:, 0], true[:, 0], true[:, k]) for k in (1, 2, 3)], axis=1)
    # the scanners ride 2.45 m behind the place that the trajectory refers to
    assert np.abs(np.hypot(away[:, 0], away[:, 1]) - 2.45).max() < 0.1 and np.abs(away[:, 2]).max() < 0.1
    assert "one sigma" in (tmp_path / "report.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_road_map_without_a_trajectory_is_that_with_it_and_says_so(survey, tmp_path):
    given = run("roadmap", POINT_CLOUDS=[survey / "s.laz"], TRAJECTORY=survey / "drive.gpkg", ROAD_EDGES=tmp_path / "edges.gpkg",
                MARKINGS=tmp_path / "markings.gpkg", BOUNDARY_METHOD="profiles")
    heard = Heard()
    left_out = run("roadmap", progress=heard, POINT_CLOUDS=[survey / "s.laz"], ROAD_EDGES=tmp_path / "edges_2.gpkg",
                   MARKINGS=tmp_path / "markings_2.gpkg", REPORT=tmp_path / "report.html", BOUNDARY_METHOD="profiles")
    assert heard.says("estimated from the rays")
    assert "Trajectory estimated from the rays" in (tmp_path / "report.html").read_text(encoding="utf-8")
    for name in ("ROAD_EDGES", "MARKINGS"):
        maps = []
        for results in (given, left_out):
            with fiona.open(results[name]) as layer:
                maps.append(shapely.union_all([shapely.force_2d(shape(f.geometry)) for f in layer]))
        shorter, longer = sorted((shapely.boundary(one) if name == "MARKINGS" else one for one in maps), key=shapely.length)
        # the scanners are 2.45 m behind the place that the trajectory refers to, so both ends differ, and what is bridged there
        assert shorter.length > 0.75 * longer.length
        places = shapely.points(shapely.get_coordinates(shapely.segmentize(shorter, 0.5)))
        # a lowered curb, 6 of 80 m, is known to two decimetres alone
        assert np.mean(shapely.distance(places, longer) < 0.1) > 0.9
