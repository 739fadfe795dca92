"""Road maps of streets that can be read in two ways: right, or both readings are said."""

import json

import numpy as np
import pytest
import shapely
from lanewright.core.pipeline.road_map import make_road_map

PULSES = {"pulse_rate": 45_000.0, "rotation_rate": 75.0}


def wrong_lengths(lines, truth):
    """m of each driving line that lie more than 15 cm beside a true one of its direction, and its row."""
    true = [shapely.force_2d(line) for line, _ in truth]
    ways = np.array([row["direction"] for _, row in truth])
    for line, row in lines:
        places = shapely.line_interpolate_point(shapely.force_2d(line), np.arange(0.25, line.length, 0.5))
        away = np.array([shapely.distance(one, places) for one in true])[ways == row["direction"]]
        yield 0.5 * float((away.min(axis=0, initial=np.inf) > 0.15).sum()), row


@pytest.mark.slow
@pytest.mark.parametrize("scene, length", [("beside-middle", 60.0), ("solid-centre-line", 60.0), ("one-sided-island", 100.0)])
def test_no_lane_is_wrong_and_sure(made_survey, tmp_path, scene, length):
    sample, cloud = made_survey(scene=scene, length=length, **PULSES)
    found = make_road_map([cloud], sample.trajectory, tmp_path / "intensity.tif")
    found.road_points.close()
    assert len(found.driving_lines)
    for wrong, row in wrong_lengths(found.driving_lines, sample.truth_driving_lines):
        # ends of pieces are known to half a metre
        assert row["confidence"] <= 0.6 and row["other"] or wrong <= 1.0
        if wrong > 1.0:
            assert [lane["direction"] for lane in json.loads(row["other"])["lanes"]] == [1]
