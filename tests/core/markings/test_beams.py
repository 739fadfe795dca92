"""A scanner that spins many unequal lasers over a street: asphalt is to be one brightness for all of them."""

import numpy as np
import pytest

from lanewright.core.markings.beams import Beams
from lanewright.core.markings.clusters import cluster_markings
from lanewright.core.markings.extraction import extract_markings
from lanewright.core.markings.image import IntensityImage, write_intensity_image
from lanewright.core.markings.intensity import correct_intensity
from lanewright.core.survey.points import ROAD_POINT, to_units
from lanewright.core.survey.road_frame import build_frame
from lanewright.core.survey.road_points import RoadPoints
from lanewright.core.survey.section_store import SectionStore
from lanewright.core.survey.trajectory import Trajectory

LENGTH, HEIGHT, SPEED, HALF = 45.0, 1.8, 5.0, 7.0
TURN = 0.1      # s
BEAMS = 40
ELEVATIONS = np.radians(np.linspace(-26.0, -7.0, BEAMS))


def drive(rolling=True):
    """A drive to the east in a vehicle that rolls and pitches by a degree."""
    time = np.arange(0.0, LENGTH / SPEED + 0.05, 0.05)
    roll, pitch = (rolling * np.sin(time), rolling * np.cos(1.7 * time))
    return Trajectory(1000 + time, SPEED * time + 500_000, np.full(len(time), 5_400_000.0), np.full(len(time), 100 + HEIGHT),
                      roll, pitch, np.full(len(time), 90.0))


def hatching(x, y):
    """An island beside the lane: bars of 0.3 m across a strip, within a frame of lines of 0.15 m."""
    inside = (x > 20) & (x < 26) & (y > 2.5) & (y < 5.0)
    frame = (np.abs(y - 2.575) < 0.075) | (np.abs(y - 4.925) < 0.075)
    return inside & (frame | ((x + y) % 1.5 < 0.3))


def spun(paint=None, by_turn=False, unequal=True, seed=5, section_length=20.0):
    """Road points of a spinning scanner and its frame; `by_turn` brings each turn to the place of its middle, as clouds of frames do."""
    rng = np.random.default_rng(seed)
    trajectory = drive()
    frame = build_frame(trajectory)
    angle = np.arange(0, 2 * np.pi, np.radians(0.6))
    turns = np.arange(0.0, LENGTH / SPEED - TURN / 2, TURN)
    turn, azimuth, beam = (a.ravel() for a in np.meshgrid(turns, angle, np.arange(BEAMS), indexing="ij"))
    time = turn + TURN * azimuth / (2 * np.pi)
    seen = turn + TURN / 2 if by_turn else time
    roll, pitch = (np.radians(np.interp(1000 + seen, trajectory.time, a)) for a in (trajectory.roll, trajectory.pitch))
    # in the vehicle a beam keeps its elevation; where it meets the road follows from the tilt
    ahead, left = np.cos(azimuth), np.sin(azimuth)
    elevation = ELEVATIONS[beam] + rng.normal(0, np.radians(0.03), len(beam))
    level = np.tan(elevation) + roll * left - pitch * ahead
    x, y = SPEED * seen - HEIGHT / level * ahead, -HEIGHT / level * left
    gain = np.where(unequal, rng.uniform(-14, 8, BEAMS), 0.0)
    value = 28 + gain[beam] + rng.normal(0, 3, len(x)) + (np.where(paint(x, y), 25, 0) if paint else 0)
    kept = (np.abs(y) < HALF) & (x > 0) & (x < LENGTH)
    records = np.zeros(kept.sum(), ROAD_POINT)
    for name, values in (("x", x), ("y", y), ("s", x), ("d", y), ("z", np.full(len(x), 100 - frame.origin[2]))):
        records[name] = to_units(values[kept])
    records["time"] = 1000 + time[kept]
    records["source"] = 1 + np.rint(turn[kept] / TURN)
    records["intensity"] = np.clip(np.rint(value[kept]), 0, 255) * 256
    records["corrected"], records["half_width"] = np.nan, HALF * 1000
    found = RoadPoints(SectionStore(ROAD_POINT, section_length), frame.origin)
    found.store.append(0, records)
    return found, frame


def scatter(values):
    return np.std(values) / np.mean(values)


@pytest.mark.parametrize("by_turn", [False, True])
def test_unequal_beams_are_told_apart_and_made_alike(by_turn):
    points, frame = spun(by_turn=by_turn)
    corrected, report = correct_intensity(points, frame)
    found = corrected.all_points()
    assert BEAMS <= report.beams <= BEAMS + 10 and "beams" in report.lines()[0]
    assert scatter(found.value) < 0.45 * scatter(found.intensity.astype(float))


def test_paint_stays_brighter_than_asphalt_when_beams_are_made_alike():
    points, frame = spun(hatching)
    found = correct_intensity(points, frame)[0].all_points()
    painted = hatching(found.x, found.y)
    assert np.median(found.value[painted]) - np.median(found.value[~painted]) == pytest.approx(25 * 256, rel=0.1)


def test_beams_that_are_alike_already_are_left_alone():
    points, frame = spun(unequal=False)
    assert Beams.of(points, frame, 1) is None


def test_the_beams_do_not_depend_on_the_length_of_sections():
    results = [correct_intensity(*spun(section_length=length))[0].all_points() for length in (20.0, 7.0)]
    by_place = [np.lexsort((p.y, p.x, p.time)) for p in results]
    np.testing.assert_array_equal(results[0].value[by_place[0]], results[1].value[by_place[1]])


@pytest.mark.parametrize("paint", [None, hatching])
def test_a_hatched_island_under_unequal_beams_is_found_and_grey_asphalt_is_not(tmp_path, paint):
    pytest.importorskip("osgeo.gdal")
    points, frame = spun(paint)
    corrected, _ = correct_intensity(points, frame)
    write_intensity_image(corrected, tmp_path / "image.tif")
    marked = extract_markings(corrected, IntensityImage.open(tmp_path / "image.tif"), frame)
    if paint is None:
        assert len(marked) < 20
        return
    found, everything = marked.all_points(), corrected.all_points()
    assert paint(found.x, found.y).mean() > 0.8
    assert paint(found.x, found.y).sum() > 0.6 * paint(everything.x, everything.y).sum()
    markings, _ = cluster_markings(marked, frame)
    assert 3.0 < sum(g.area for g in markings.geometries) < 8.0
