"""A head of many beams that turns on the roof of a car is found by its turns."""

import numpy as np
import pytest
from drives import EAST, NORTH, write_cloud
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.estimation.estimate import estimate_trajectory, refuse_handheld
from lanewright.core.survey.estimation.poses import HeadTrack
from lanewright.core.survey.estimation.samples import FirstTrack

TURN, SPEED, HEIGHT, HALF, RADIUS = 0.1, 8.0, 1.8, 9.0, 60.0   # s, m/s; m: the head, the walls beside the street, its bend
START = 318_204_000.0
ELEVATIONS = np.radians(np.linspace(-24.0, 4.0, 24))


def place_at(time, speed=SPEED):
    """(N, 2) places and (N,) headings of a vehicle that bends left."""
    angle = speed * time / RADIUS
    return np.column_stack([RADIUS * np.sin(angle), RADIUS * (1 - np.cos(angle))]), angle


def spun_cloud(path, by_turn, seconds=4.0, speed=SPEED, clockwise=True, half=HALF):
    """A cloud of a street between walls; `by_turn` sees each turn from the place of its middle, as clouds of frames are."""
    rng = np.random.default_rng(4)
    step = np.arange(0.0, seconds, TURN / 240)
    time, beam = (a.ravel() for a in np.meshgrid(step, np.arange(len(ELEVATIONS)), indexing="ij"))
    head, yaw = place_at((np.floor(time / TURN) + 0.5) * TURN if by_turn else time, speed)
    bearing = yaw + (-1 if clockwise else 1) * 2 * np.pi * time / TURN
    ahead, left = np.cos(bearing - yaw), np.sin(bearing - yaw)
    wall = half / np.maximum(np.abs(left), 1e-3)
    elevation = ELEVATIONS[beam]
    ground = np.where(elevation < 0, HEIGHT / np.tan(np.maximum(-elevation, 1e-3)), np.inf)
    away = np.minimum(np.minimum(wall, ground), 60.0 + 0 * ahead) + rng.normal(0, 0.01, len(time))
    kept = away < 50.0
    x, y = (head[:, k] + away * side for k, side in enumerate((np.cos(bearing), np.sin(bearing))))
    z = 100.0 + HEIGHT + away * np.tan(elevation)
    return write_cloud(path, x[kept] + EAST, y[kept] + NORTH, z[kept], START + time[kept], crs="EPSG:32632")


@pytest.mark.parametrize(("by_turn", "clockwise"), [(True, True), (False, False)])
def test_the_place_of_the_head_comes_back_within_centimetres(tmp_path, by_turn, clockwise):
    found = estimate_trajectory([spun_cloud(tmp_path / "cloud.las", by_turn, clockwise=clockwise)])
    assert found.method == "turns" and "many-beam head" in found.summary() and any("10.0 times a second" in note for note in found.notes)
    track = found.trajectory
    assert len(track) == pytest.approx(40, abs=2)
    true, yaw = place_at(track.time - START)
    off = np.column_stack([track.x - EAST, track.y - NORTH]) - true
    left = -off[:, 0] * np.sin(yaw) + off[:, 1] * np.cos(yaw)
    ahead = off[:, 0] * np.cos(yaw) + off[:, 1] * np.sin(yaw)
    assert np.sqrt(np.mean(left**2)) < 0.05 and np.abs(left).max() < 0.3 and np.sqrt(np.mean(ahead**2)) < 0.1
    assert np.abs(track.z - 100.0 - HEIGHT).max() < 0.1 and (found.sigma_height < 0.2).all()
    heading = np.radians(90.0 - track.heading)
    assert np.abs(np.angle(np.exp(1j * (heading - yaw)))[2:-2]).max() < np.radians(3.0)


def test_one_carried_at_walking_pace_is_refused_by_name(tmp_path):
    with pytest.raises(RoadExtractionError, match="handheld or backpack"):
        estimate_trajectory([spun_cloud(tmp_path / "cloud.las", False, seconds=12.0, speed=1.2)])


def test_walking_pace_is_told_from_the_places_of_the_head_where_the_density_of_the_points_swings():
    time = np.arange(0.05, 30.0, TURN)
    rng = np.random.default_rng(2)

    def head(speed):
        place = np.column_stack([np.minimum(speed * time, speed * 12.0), 0.02 * rng.standard_normal(len(time))])
        return HeadTrack(time, place, 0 * time, 0 * time, 0 * place, 0.01, 10.0)

    foot = np.column_stack([6.0 * rng.standard_normal((len(time), 2)), 0 * time])
    swinging = [FirstTrack(time, foot, 0 * time, np.full(len(time), 100), np.full(len(time), 5.0))]
    with pytest.raises(RoadExtractionError, match="handheld or backpack"):
        refuse_handheld(swinging, [], [head(1.2)])
    refuse_handheld(swinging, [], [head(6.0)])   # which drives for 12 s and then stands


def test_where_nothing_stands_up_the_height_is_a_usual_one_and_it_says_so(tmp_path):
    found = estimate_trajectory([spun_cloud(tmp_path / "cloud.las", True, half=1000.0)])
    assert any("is a usual one" in note for note in found.notes) and (found.sigma_height == 0.5).all()
