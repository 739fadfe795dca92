"""Lines that no threshold above the usual asphalt finds, since the ground beside them is darker or brighter than usual."""

import numpy as np
import pytest
from lanewright.core.markings.paint.noisy import faint_lines
from lanewright.core.markings.paint.not_paint import rim_distance

ROWS, COLUMNS = 400, 200   # 16 m by 8 m in cells of 4 cm
ASPHALT, NOISE = 1000.0, 60.0


def ground(level=1.0, seed=3):
    """Brightness of asphalt, `level` times as bright as usual."""
    return ASPHALT * level * np.random.default_rng(seed).normal(1.0, NOISE / ASPHALT, (ROWS, COLUMNS)).astype(np.float32)


def painted(brightness, first=50, last=350, column=150, level=1.4, width=3):
    line = np.zeros(brightness.shape, bool)
    line[first:last, column:column + width] = True
    return np.where(line, brightness * np.float32(level), brightness), line


def found_in(brightness, paint=None, refused=None, scanned=None):
    nothing = np.zeros(brightness.shape, bool)
    scanned, paint, refused = (usual if given is None else given for given, usual in ((scanned, ~nothing), (paint, nothing), (refused, nothing)))
    return faint_lines(brightness, scanned, rim_distance(scanned), paint, refused)[0]


@pytest.mark.parametrize("level", [0.6, 1.0, 2.0], ids=["dark strip", "usual asphalt", "bright strip"])
def test_a_line_is_found_by_what_lies_beside_it(level):
    brightness = ground()
    brightness[:, 130:] *= level   # as broad as 2.8 m; the line itself may be darker than the asphalt of the road
    brightness, line = painted(brightness)
    found = found_in(brightness)
    assert found[line].mean() > 0.9
    assert found[~line].sum() < 0.02 * line.sum()


def test_asphalt_between_two_seams_is_no_line():
    brightness = ground()
    brightness[50:350, 147:149] *= 0.5
    brightness[50:350, 153:155] *= 0.5
    assert not found_in(brightness).any()


@pytest.mark.parametrize("length", [20, 40])
def test_a_short_streak_is_no_line(length):
    brightness, _ = painted(ground(), 100, 100 + length)
    assert not found_in(brightness).any()


def test_the_step_from_dark_to_bright_asphalt_is_no_line():
    brightness = ground()
    brightness[:, 150:] *= 1.6
    assert not found_in(brightness).any()


def test_a_line_at_the_end_of_what_was_scanned_is_none():
    """A rim of stone: on its other side there is nothing to compare it with."""
    brightness, line = painted(ground(), width=7)
    scanned = np.ones(line.shape, bool)
    scanned[:, 158:] = False
    assert not found_in(brightness, scanned=scanned).any()


def test_what_a_threshold_found_or_what_was_refused_is_not_found_again():
    brightness, line = painted(ground())
    assert not found_in(brightness, paint=line).any()
    assert not found_in(brightness, refused=line).any()
