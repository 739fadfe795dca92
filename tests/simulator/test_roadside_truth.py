"""What runs beside the roads of the sample survey: its points lie where its truth says, and *Roadside* finds it."""

import numpy as np
import pytest
import shapely
from lanewright.core.road.detect_boundaries import BoundarySettings
from lanewright.core.survey.open_survey import SurveySettings, open_survey
from lanewright.products.inventory.borders import BorderLayers
from lanewright.products.inventory.roadside.find import find_roadside, roadside_to_features
from lanewright.simulator.parts.materials import LABEL
from lanewright.simulator.survey import SampleSettings, make_sample_survey
from road_layers import drawn_boundaries

LABEL_OF = {"guard_rail": "rail", "wall": "wall", "barrier": "barrier", "fence": "fence", "hedge": "hedge"}
DEEP = {"barrier": 0.60, "hedge": 1.3, "wall": 0.25}  # m behind its face that points of a thing may lie; others are thin


def survey(scene, **settings):
    """A thin survey, quick to make."""
    return make_sample_survey(SampleSettings(scene=scene, pulse_rate=40_000.0, rotation_rate=100.0, **settings))


@pytest.fixture(scope="module")
def outskirts():
    return survey("outskirts")


@pytest.fixture(scope="module")
def true_points(outskirts):
    return outskirts.points(noise=False)


def test_every_kind_runs_beside_the_outskirts_on_the_side_that_the_truth_says(outskirts):
    rows = outskirts.truth_roadside.rows
    assert {row["kind"] for row in rows} == set(LABEL_OF)
    assert {(row["kind"], row["side"]) for row in rows} >= {("wall", "left"), ("hedge", "left"), ("guard_rail", "right"), ("barrier", "right")}
    assert sum(row["length_m"] for row in rows) > 270.0


@pytest.mark.parametrize("kind", LABEL_OF)
def test_points_of_a_thing_lie_at_its_face_and_as_high_as_the_truth_says(outskirts, true_points, kind):
    points = true_points[true_points["label"] == LABEL[LABEL_OF[kind]]]
    things = [(line, row) for line, row in outskirts.truth_roadside if row["kind"] == kind]
    lines = [shapely.force_2d(line) for line, _ in things]
    at = shapely.points(points["x"], points["y"])
    assert shapely.distance(at, shapely.union_all(lines)).max() < DEEP.get(kind, 0.05) + 0.02
    nearest = np.argmin([shapely.distance(at, line) for line in lines], axis=0)
    for k, (line, row) in enumerate(things):
        own = points[nearest == k]
        foot = shapely.get_coordinates(line, include_z=True)
        along = shapely.line_locate_point(lines[k], at[nearest == k])
        z = own["z"] - np.interp(along, shapely.line_locate_point(lines[k], shapely.points(foot[:, :2])), foot[:, 2])
        assert np.quantile(z, 0.995) == pytest.approx(row["height_m"], abs=0.06)
        assert np.quantile(z, 0.005) == pytest.approx(row["foot_m"], abs=0.12)


def test_a_fence_is_seen_through_and_a_wall_is_not(true_points):
    behind = {
        name: true_points[
            (true_points["offset"] > 6.6)
            & (np.abs(true_points["offset"] - 8.0) < 1.4)
            & (true_points["label"] == LABEL["verge"])
            & (true_points["station"] > low)
            & (true_points["station"] < high)
        ]
        for name, low, high in (("wall", 8.0, 26.0), ("fence", 57.0, 80.0))
    }
    assert len(behind["fence"]) > 500 and len(behind["wall"]) < 0.02 * len(behind["fence"])


def test_what_stands_beside_another_street_has_no_truth():
    assert not len(survey("street", length=40.0).truth_roadside)


@pytest.mark.slow
def test_roadside_finds_90_percent_and_95_percent_of_it_are_right(outskirts, tmp_path):
    outskirts.write_cloud(tmp_path / "cloud.las")
    found = open_survey([tmp_path / "cloud.las"], outskirts.trajectory, SurveySettings(above_road=8.0))
    lines, _ = roadside_to_features(find_roadside(found, BorderLayers(edges=drawn_boundaries(found, BoundarySettings("profiles")))))
    found.store.close()
    sums = np.zeros(4)
    for kind in LABEL_OF:
        true, ours = (
            shapely.union_all([shapely.force_2d(line) for line, row in layer if row["kind"] == kind]) for layer in (outskirts.truth_roadside, lines)
        )
        sums += [shapely.intersection(true, ours.buffer(0.3)).length, true.length, shapely.intersection(ours, true.buffer(0.3)).length, ours.length]
    assert sums[0] >= 0.90 * sums[1] and sums[2] >= 0.95 * sums[3]
