"""A drive that was laid on others goes on where it measures alone: it is moved on as where it left them, not back to where it was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..frame.row_table import SigmaAlong
from ..store.records import to_units
from .register import CORRECTION_STEP, PassCorrections

if TYPE_CHECKING:
    from ..frame.passes import Pass
    from ..frame.road_frame import RoadFrame
    from .register import PassOffsets

MAX_SEAM = 1.0   # s between the end of a pass and the start of the next one of the same drive


def continued_corrections(frame: RoadFrame, moves: PassCorrections, compared: list[PassOffsets]) -> PassCorrections:
    """Corrections of passes with those of the passes that follow or precede them in the same drive and could be compared with no other.

    Navigation drifts slowly, by centimetres over kilometres, so what a drive is off by at the end of a road is what it is off by at the start of
    the next. Between two that were moved the correction changes evenly. Two passes meet in their middle, so what one was moved by across the road
    is also the sigma of where they meet; `frame.pass_sigma` of roads without one says so.

    Parameters
    ----------
    frame : RoadFrame
    moves : PassCorrections of the passes that were compared
    compared : PassOffsets of all roads; passes that were found to lie as the others do are not moved
    """
    known = {number for pair in compared for number in (pair.one, pair.other)}
    by_pass = dict(moves.by_pass)
    passes = sorted(frame.passes, key=lambda p: float(p.time[0]))
    while found := _beside_moved(passes, by_pass, known):
        by_pass.update(found)
        for number in found:
            across = _moved_across(frame, PassCorrections(by_pass), frame.passes[number])
            frame.pass_sigma.setdefault(frame.passes[number].road, SigmaAlong.everywhere(across))
    return PassCorrections(by_pass)


def _beside_moved(passes, by_pass, known):
    """Corrections of the passes, in order of time, that touch one of those moved, and are neither moved nor known to lie right."""
    found = {}
    for before, p, after in zip([None, *passes[:-1]], passes, [*passes[1:], None]):
        if p.number not in by_pass and p.number not in known:
            ends = _touching(before, p, by_pass), _touching(p, after, by_pass)
            if any(ends):
                found[p.number] = _led_on(PassCorrections(by_pass), p, *ends)
    return found


def _moved_across(frame, moves, p):
    """RMS metres by which a pass is moved across its road."""
    s = np.linspace(*p.span, max(int(np.ptp(p.span) / CORRECTION_STEP), 2))
    east, north, _ = moves.metres(p.number, s)
    heading = frame.road(p.road).heading(s)
    return float(np.sqrt(np.mean((north * np.cos(heading) - east * np.sin(heading)) ** 2)))


def _touching(first: Pass | None, then: Pass | None, by_pass: dict) -> Pass | None:
    """The one of two passes that was moved, if they touch in time."""
    if first is None or then is None or not 0.0 <= then.time[0] - first.time[-1] <= MAX_SEAM:
        return None
    return next((one for one in (first, then) if one.number in by_pass), None)


def _led_on(moves, p, before, after):
    """(station of the first node, (3, N) int16 in 0.1 mm) of a pass from the ends of those before and after it, either of them None."""
    ends = [np.array(moves.metres(one.number, one.s[[row]])) for one, row in ((before, -1), (after, 0)) if one is not None]
    first, last = p.span
    nodes = first + CORRECTION_STEP * np.arange(int(np.ceil((last - first) / CORRECTION_STEP)) + 1)
    share = np.interp(nodes, [first, last], [0.0, 1.0] if p.s[-1] > p.s[0] else [1.0, 0.0])
    return first, to_units(ends[0] + share * (ends[-1] - ends[0])).astype(np.int16)
