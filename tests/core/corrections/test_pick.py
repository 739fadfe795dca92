"""A curb or a painted line that was missed is found in the points about a click, and a line drawn by hand is laid onto it."""

import numpy as np
import pytest
from lanewright.core.corrections.pick import face_at, pick_line, snap_line

ORIGIN, AZIMUTH, FACE, PAINT, RADIUS = np.array([500_000.0, 5_000_000.0]), 30.0, 3.0, -1.0, 60.0


def street(height=0.12, lean=0.0, density=400, noise=0.004, dash=(), hidden=(), bend=False, seed=1):
    """(N, 4) points of 30 m of a street that falls along and across, with a curb 3 m left of its middle and a line 1 m right of it.

    dash : m of paint and of gap; hidden : stations between which nothing was measured beside the curb; bend : to the left, of 60 m radius
    """
    random = np.random.default_rng(seed)
    flat, face = density * 30 * 8, int(density * 30 * height) * 2 if not lean else 0
    s, d = random.uniform(-15, 15, flat + face), np.r_[random.uniform(-4, 4, flat), np.full(face, FACE)]
    rise = np.r_[height * np.clip((d[:flat] - FACE) / max(lean, 1e-9), 0, 1), random.uniform(0, height, face)]
    painted = (np.abs(d - PAINT) < 0.06) & ((s % sum(dash) < dash[0]) if dash else True)
    z, intensity = 0.03 * s - 0.02 * d + rise, np.where(painted, 220.0, 100.0)
    points = np.c_[on_map(s, d, bend), z + random.normal(0, noise, len(s)), intensity + random.normal(0, 12, len(s))]
    return points[~((d > 2.0) & (s > hidden[0]) & (s < hidden[1]))] if hidden else points


def on_map(s, d, bend=False):
    x, y = (RADIUS - (RADIUS - d) * np.cos(s / RADIUS), (RADIUS - d) * np.sin(s / RADIUS)) if bend else (d, s)
    angle = np.radians(AZIMUTH)
    return ORIGIN + np.stack([y * np.sin(angle) - x * np.cos(angle), y * np.cos(angle) + x * np.sin(angle)], axis=-1)


def on_road(places, bend=False):
    angle = np.radians(AZIMUTH)
    dx, dy = (places - ORIGIN).T
    x, y = dy * np.sin(angle) - dx * np.cos(angle), dy * np.cos(angle) + dx * np.sin(angle)
    return (RADIUS * np.arctan2(y, RADIUS - x), RADIUS - np.hypot(y, RADIUS - x)) if bend else (y, x)


@pytest.mark.parametrize("shape", [dict(), dict(height=0.03), dict(height=0.2), dict(lean=0.15), dict(density=100), dict(bend=True)])
@pytest.mark.parametrize("turned", [0, 40])
def test_a_click_near_a_curb_finds_its_foot_along_the_street(shape, turned):
    """Whether it is a dropped, a high or a mountable curb, in a bend, among few points, and whatever the direction that it is sought from."""
    bend = shape.get("bend", False)
    seen = pick_line(street(**shape), *on_map(2.0, 3.35, bend), AZIMUTH + turned)
    s, d = on_road(seen.places, bend)
    assert seen.target == "edge" and seen.step == pytest.approx(shape.get("height", 0.12), abs=0.01)
    assert s.min() < -13 and s.max() > 13 and seen.length > 26
    assert abs(np.median(d) - FACE) < 0.01 and np.percentile(np.abs(d - FACE), 95) < 0.04
    assert 0 < seen.scatter < 0.02 < 100 < seen.points


def test_a_click_near_paint_finds_the_middle_of_the_line_with_its_width_and_brightness():
    seen = pick_line(street(), *on_map(-3.0, PAINT + 0.3), AZIMUTH)
    _, d = on_road(seen.places)
    assert seen.target == "marking" and not seen.dashed and seen.width == pytest.approx(0.12, abs=0.021)
    assert seen.brightness == pytest.approx(2.2, abs=0.15)
    np.testing.assert_allclose(d, PAINT, atol=0.015)


def test_dashes_are_one_line_that_says_so():
    seen = pick_line(street(dash=(2.0, 4.0)), *on_map(1.0, PAINT), AZIMUTH)
    assert seen.dashed and seen.length > 24 and seen.seen < 0.6 * seen.length
    np.testing.assert_allclose(on_road(seen.places)[1], PAINT, atol=0.03)


def test_the_curb_goes_on_behind_a_wheel_but_not_behind_a_parked_car():
    click = on_map(-8.0, FACE)
    assert pick_line(street(hidden=(0.0, 1.0)), *click, AZIMUTH).length > 25
    s, _ = on_road(pick_line(street(hidden=(0.0, 5.0)), *click, AZIMUTH).places)
    assert s.max() < 0.6, "what was not seen is not invented"


@pytest.mark.parametrize("place", [(0.0, 1.2), (0.0, -2.6)])
def test_where_there_is_neither_step_nor_paint_within_a_metre_nothing_is_found(place):
    assert pick_line(street(), *on_map(*place), AZIMUTH) is None
    assert pick_line(np.empty((0, 4)), *on_map(*place), AZIMUTH) is None


@pytest.mark.parametrize("slope", [0.0, 0.33])
def test_a_slope_of_grass_is_no_curb(slope):
    points = street(height=0.0)
    _, d = on_road(points[:, :2])
    points[:, 2] += slope * np.maximum(d - FACE, 0.0)
    assert pick_line(points, *on_map(0.0, FACE), AZIMUTH, ["edge"]) is None


def test_a_line_drawn_by_hand_is_laid_onto_the_face():
    drawn = on_map(np.array([-10.0, 0.0, 8.0]), FACE + np.array([0.2, -0.15, 0.25]))
    seen = snap_line(street(), drawn, "edge")
    s, d = on_road(seen.places)
    np.testing.assert_allclose(d, FACE, atol=0.04)
    np.testing.assert_allclose((s.min(), s.max()), (-10.0, 8.0), atol=0.3)


def test_a_line_drawn_where_nothing_is_stays_as_it_is():
    assert snap_line(street(), on_map(np.array([-10.0, 8.0]), np.array([1.2, 1.2])), "edge") is None


@pytest.mark.parametrize("shape", [dict(), dict(height=0.03), dict(height=0.2), dict(lean=0.15), dict(density=100), dict(bend=True)])
@pytest.mark.parametrize("turned", [0, 25])
def test_a_click_in_a_section_finds_the_bottom_and_the_top_of_the_face_there(shape, turned):
    """Also where the section lies oblique to the curb."""
    bend, height, lean = shape.get("bend", False), shape.get("height", 0.12), shape.get("lean", 0.0)
    face = face_at(street(**shape), *on_map(2.0, FACE + 0.2, bend), AZIMUTH + turned)
    s, d = on_road(face.places[:, :2], bend)
    assert d == pytest.approx([FACE, FACE + lean], abs=0.03)
    assert face.places[:, 2] == pytest.approx(0.03 * s - 0.02 * d + [0.0, height], abs=0.012)
    assert face.height == pytest.approx(height, abs=0.008) and abs(face.height - height) < 3 * face.sigma_height < 0.04
    assert face.sigma_across < 0.03 and face.points > 100
    assert face.direction == pytest.approx(AZIMUTH - (np.degrees(2.0 / RADIUS) if bend else 0.0), abs=3.0)


def test_a_wheel_beside_the_click_moves_neither_bottom_nor_top():
    points = street()
    s, d = on_road(points[:, :2])
    points[(np.abs(s - 1.0) < 0.3) & (np.abs(d - 2.85) < 0.15), 2] += 0.3
    face, free = face_at(points, *on_map(2.0, 3.1), AZIMUTH), face_at(street(), *on_map(2.0, 3.1), AZIMUTH)
    np.testing.assert_allclose(face.places, free.places, atol=0.01)


@pytest.mark.parametrize("points", [street(height=0.0), street(hidden=(-15, 1.7))[:10], np.empty((0, 4))])
def test_a_click_in_a_section_without_a_step_finds_no_face(points):
    assert face_at(points, *on_map(2.0, FACE), AZIMUTH) is None


def test_a_stone_in_a_section_is_no_curb():
    points = street(height=0.0)
    s, d = on_road(points[:, :2])
    points[(np.abs(s - 2.0) < 0.15) & (np.abs(d - FACE) < 0.15), 2] += 0.1
    assert face_at(points, *on_map(2.0, FACE - 0.1), AZIMUTH) is None
    assert face_at(street(), *on_map(2.0, FACE - 0.5), AZIMUTH) is None, "the curb is half a metre from the click"
