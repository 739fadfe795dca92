"""Scanners of one vehicle against each other: what one sees lies where the other sees it, or its mounting is not what the files were made with.

As passes are laid on each other, so are scanners: the strips of both within one pass are correlated (see adjustment/register.py), on either side
of the vehicle apart. An error of the lever moves all points of a scanner alike. An error of the boresight turns them about it: on the ground
of one scan plane that is a move that grows evenly from the right to the left. So moves of both sides tell both.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..frame.road_frame import RoadFrame
from ..store.columns import Columns
from ..store.records import COORDINATE_SCALE
from ..weights import ADJUST, REGISTER
from .adjust import replace_points
from .register import CHANNELS, WINDOW_LENGTH, MovedPoints, best_offsets, correlation_sums, height_offset, points_on_strip, strips_of
from .trajectory_fit import LOOK_WINDOWS, MAX_SCANNER_OFFSETS, SCANNER_WINDOWS, SIGNIFICANT

SIDES = "right", "left"
MOVE_WORDS = ("ahead", "behind"), ("left", "right"), ("above", "below")


@dataclass(frozen=True)
class _ScannerOffsets:
    """Moves of a scanner onto the first one, on the right and the left of the vehicle."""

    scanner: int   # its number
    beside: np.ndarray   # (2, 3) m left of the track at which each move was measured, negative on the right
    moves: np.ndarray   # (2, 3) m ahead, left and up that bring its points onto those of the first scanner; NaN where nothing shows it
    sigma: np.ndarray   # (2, 3) m, of the moves: how far they differ between windows, of which all show one mounting; infinite of one window
    far: bool   # whether they lie farther apart than could be measured


def lay_scanners(survey: Any, progress: Progress = Progress()) -> float:
    """Lay the scanners of a survey on each other where they measurably lie apart; each is moved by its share, as nothing shows which is right.

    survey : Survey with times; its store is replaced where points are moved, and progress hears a warning

    Returns m across, one sigma that stays open: how far the middle of the scanners may be off; 0 where they agree.
    """
    if len(survey.scanners) < 2 or _agree_at_a_look(survey):
        return 0.0
    offsets = _scanner_offsets(survey)
    if not any(map(_apart, offsets)):
        return 0.0
    moves = _shares(offsets)
    across = np.array([[0.0, 0.0], *(np.nan_to_num(offset.moves[:, 1]) for offset in offsets)])
    # independent errors of one sigma s in n scanners, whose middle is off by s / sqrt(n)
    sigma = float((across.std(axis=0, ddof=1) / np.sqrt(len(across))).max())
    for offset in offsets:
        if _apart(offset):
            progress.warn(_said(survey, offset, sigma))
    replace_points(survey, _ScannerMoves(survey.frame, moves), progress)
    return sigma


def _agree_at_a_look(survey):
    """Whether scanners agree in the first windows that show all of their moves, or in all LOOK_WINDOWS together.

    An error of a mounting is the same all along a survey, so that one window clears a scanner.
    """
    by_scanner: dict[int, list] = {}
    for window in _windows(survey, LOOK_WINDOWS):
        for number, evidence in _window_evidence(survey, window).items():
            by_scanner.setdefault(number, []).append(evidence)
        if len(by_scanner) == len(survey.scanners) - 1 and all(map(_clear, by_scanner.values())):
            return True
    return not any(_apart(_offsets(number, evidence)) for number, evidence in by_scanner.items())


def _clear(evidence):
    """Whether windows show all moves of a scanner, on both sides those across and up, on one that along the way, and none that matters."""
    moves, _, far = zip(*(_moves_of(side) for side in zip(*evidence)))
    measured = np.isfinite(moves)
    return bool(measured[:, 1:].all() and measured[:, 0].any() and not any(far) and not (np.abs(moves) > MAX_SCANNER_OFFSETS).any())


def _apart(one):
    """Whether a scanner lies measurably beside the first: by more than is harmless, and than windows of road differ by."""
    moved = np.nan_to_num(np.abs(one.moves))
    return one.far or bool((moved > MAX_SCANNER_OFFSETS + SIGNIFICANT * one.sigma).any())


def _said(survey, one, sigma):
    """The warning about a scanner that lies beside the first."""
    names = f"Scanner {survey.scanners[one.scanner]} and scanner {survey.scanners[0]}"
    if one.far:
        return (f"{names} lie more than {100 * REGISTER.max_offset:.0f} cm apart, too far to lay them on each other. Calibrate their mounting anew, "
                "or process the points of one scanner alone.")
    right, left = (", ".join(f"{100 * abs(metres):.1f} cm {words[int(metres < 0)]}" for metres, words in zip(side, MOVE_WORDS)
                             if abs(metres) > ADJUST.least_told_move)
                   or "nothing that is measurable" for side in np.nan_to_num(-one.moves))
    return (f"{names} differ all along: points of the first are displaced by {left} on the left, by {right} on the right. Each was moved by its "
            f"share, which leaves {100 * sigma:.1f} cm (one sigma). Calibrate their mounting anew.")


def _shares(offsets):
    """{scanner: (2, 3) m on the right and the left, and (2, 3) m beside} by which each is moved to the middle of all."""
    middle = np.mean([np.zeros((2, 3)), *(_filled(offset) for offset in offsets)], axis=0)
    positions = np.mean([offset.beside for offset in offsets], axis=0)
    return {0: (-middle, positions), **{offset.scanner: (_filled(offset) - middle, offset.beside) for offset in offsets}}


def _filled(one):
    """(2, 3) m of moves: where one side shows nothing, the other's; where both are alike, their mean."""
    right, left = one.moves
    right, left = (np.where(np.isnan(a), np.nan_to_num(b), a) for a, b in ((right, left), (left, right)))
    alike = np.abs(left - right) < np.array([ADJUST.agreement_plan, ADJUST.agreement_plan, ADJUST.agreement_height])
    return np.where(alike, 0.5 * (left + right), [right, left])


@dataclass(frozen=True)
class _ScannerMoves:
    """What moves the points of each scanner: {scanner: what `_shares` gives}."""

    frame: RoadFrame
    by_scanner: dict[int, tuple[np.ndarray, np.ndarray]]

    @property
    def reach(self) -> float:
        """m, how far any point is moved in plan at most."""
        ends = np.array([-1.0, 1.0]) * REGISTER.strip_half_width
        return max(float(np.hypot(*np.abs([self._at(scanner, ends)[:2]]).max(axis=-1)[0])) for scanner in self.by_scanner)

    def _at(self, scanner, left):
        """(N,) m ahead, aside and up of points of a scanner that lie (N,) m left of the track."""
        values, positions = self.by_scanner[scanner]
        return [a + (left - first) / (last - first) * (b - a) for (a, b), (first, last) in zip(values.T, positions.T)]

    def of_points(self, records: Columns) -> Iterator[MovedPoints]:
        """Yield the moves of points, by pass and scanner."""
        number, scanners = records["pass_number"], records["scanner"]
        for p, scanner in itertools.product(np.unique(number).tolist(), self.by_scanner):
            rows = np.flatnonzero((number == p) & (scanners == scanner))
            if not len(rows):
                continue
            driven = self.frame.passes[p]
            station, x, y = driven.at(records["time"].take(rows), "s", "x", "y")
            yaw = self.frame.road(driven.road).heading(station) + (0.0 if driven.direction > 0 else np.pi)
            cos, sin = np.cos(yaw), np.sin(yaw)
            left = (records["y"].take(rows) * COORDINATE_SCALE - y) * cos - (records["x"].take(rows) * COORDINATE_SCALE - x) * sin
            ahead, aside, up = self._at(scanner, np.clip(left, -REGISTER.strip_half_width, REGISTER.strip_half_width))
            yield p, rows, (ahead * cos - aside * sin, ahead * sin + aside * cos, up)


def _scanner_offsets(survey):
    """[_ScannerOffsets], how far the scanners of a survey lie beside the first one."""
    by_scanner: dict[int, list] = {}
    for of_window in ordered_map(partial(_window_evidence, survey), _windows(survey, SCANNER_WINDOWS)):
        for number, evidence in of_window.items():
            by_scanner.setdefault(number, []).append(evidence)
    return [_offsets(number, evidence) for number, evidence in sorted(by_scanner.items())]


def _windows(survey, count):
    """[(pass, station of the beginning, m of length)] of so many windows evenly along all passes, without the first and the last."""
    passes = survey.frame.passes
    # in short surveys windows are shorter; three are not looked at: the first, the last, and what is left over at the end of a drive
    length = min(WINDOW_LENGTH, sum(np.ptp(p.span) for p in passes) / (LOOK_WINDOWS + 3))
    every = [(p, start, length) for p in passes for start in np.arange(p.span[0], p.span[1] - length, length)]
    return [every[k] for k in np.unique(np.linspace(0, len(every) - 1, count + 2).astype(int))[1:-1]] if every else []


def _window_evidence(survey, window):
    """{scanner: [of each side (sums across, sums along, m up, m beside, weight of it)]} of a window, each scanner against the first."""
    p, start, long = window
    points = survey.window(p.road, start, start + long)
    points = points[points.pass_number == p.number]
    near, ahead, left, h = points_on_strip(survey, p.road, start, long, points, p)
    scanner, intensity = points.scanner[near], points.intensity[near].astype(float)

    def strips(number):
        rows = np.flatnonzero(scanner == number)
        return None if len(rows) < REGISTER.min_shared_cells else strips_of(ahead[rows], left[rows], h[rows], intensity[rows], long)

    first, evidence = strips(0), {}
    for number in range(1, len(survey.scanners)):
        second = strips(number) if first is not None else None
        if second is not None:
            evidence[number] = [_side_evidence(first, second, side) for side in range(len(SIDES))]
    return evidence


def _side_evidence(first, other, side):
    """(sums across, sums along, m up, {what shows it: (weight, m beside times weight)}) of the right or the left side of a window."""
    half = [slice(size // 2) if side == 0 else slice(size // 2, None) for size in (first[0].heights.shape[1], first[1].heights.shape[0])]
    a, b = (strips[0].part(slice(None), half[0]) for strips in (first, other))
    along = correlation_sums(*(strips[1].part(half[1], slice(None)) for strips in (first, other)))
    left = (np.arange(a.heights.shape[1]) + 0.5) * REGISTER.lag_cell - (REGISTER.strip_half_width if side == 0 else 0.0)
    # unknown cells are NaN, and nothing is less than that
    shown = {name: np.nansum(np.square(getattr(a, name)) * np.isfinite(getattr(b, name)), axis=0) for name in CHANNELS}
    shown["heights"] = np.count_nonzero(np.maximum(np.abs(a.steps), np.abs(b.steps)) < REGISTER.flat_step, axis=0)
    weights = {name: (float(weight.sum()), float(weight @ left)) for name, weight in shown.items()}
    return correlation_sums(a, b), along, height_offset(a, b, 0), weights


def _offsets(number, evidence):
    """_ScannerOffsets of the evidence of windows."""
    positions, moves, sigma, far = np.zeros((len(SIDES), 3)), np.full((len(SIDES), 3), np.nan), np.full((len(SIDES), 3), np.inf), False
    for side in range(len(SIDES)):
        of_side = [window[side] for window in evidence]
        moves[side], channel, at_limit = _moves_of(of_side)
        for axis, name in enumerate((channel, channel, "heights")):
            total, moment = (sum(weights[name][k] for *_, weights in of_side) for k in (0, 1))
            positions[side, axis] = moment / total if total else REGISTER.strip_half_width * (side - 0.5)
        if len(of_side) > 1:
            left_out, _, still = zip(*(_moves_of(of_side[:k] + of_side[k + 1:]) for k in range(len(of_side))))
            sigma[side] = _jackknife(left_out)
            far |= at_limit and 2 * sum(still) > len(of_side)
    return _ScannerOffsets(number, positions, moves, sigma, far)


def _moves_of(seen):
    """(3,) m ahead, left and up, the channel that shows the second, and whether it is beyond what can be measured, of one side of windows."""
    across, along, up, _ = zip(*seen)
    offsets, at_limit = best_offsets(np.sum(across, axis=0))
    # as with passes: a face looks different from another side, so it counts only where no paint shows it
    channel = next((name for name in CHANNELS[::-1] if np.isfinite(offsets[CHANNELS.index(name)])), CHANNELS[0])
    rises = [rise for rise in up if np.isfinite(rise)]
    ahead = best_offsets(np.sum(along, axis=0))[0][CHANNELS.index("paint")]
    return np.array([ahead, offsets[CHANNELS.index(channel)], np.median(rises) if rises else np.nan]), channel, bool(at_limit.any())


def _jackknife(left_out):
    """(3,) sigma of an estimate from (N, 3) estimates without one window each (Tukey 1958).

    Infinite where half of these show nothing: the estimate then depends on single windows.
    """
    values = np.array(left_out)
    count = np.isfinite(values).sum(axis=0)
    mean = np.nansum(values, axis=0) / np.maximum(count, 1)
    sigma = np.sqrt((count - 1) / np.maximum(count, 1) * np.nansum(np.square(values - mean), axis=0))
    return np.where(2 * count > len(values), sigma, np.inf)
