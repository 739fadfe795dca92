"""Candidate places of a curb on normalized scanlines: where the height changes within a short way across.

From the vehicle outward every scanline is searched for a rise of at least
MIN_HEIGHT within SEARCH_WIDTH that follows on road and stays up behind it. What shows
on one scanline and not on its neighbours is no candidate.

References
----------
The scanline paper (ISPRS Archives, 2020), section 3 and table 1, steps b and g.
"""

from dataclasses import dataclass

import numpy as np

from .scanline_grid import SPACING
from .steps import last_before, max_ahead, road_before

LOWEST = 0.7         # share of MIN_HEIGHT that a rise must show before its planes measure it
ROUGH_SHARE = 0.4    # of a rise at most that the road before it scatters
LEAST_ROAD = 6       # cells of road before a rise
BEHIND = (0.06, 0.40)  # m beyond a rise where the ground must stay up
LOW_SHARE = 0.25     # share of it that may lie below half the rise
FEWEST_BEHIND = 4    # cells of it that must be seen
FILLED = 0.30        # m along the road to either side from which a scanline's gaps are closed
SAME_ACROSS, SAME_UP = 0.08, 0.04  # m that candidates of neighbouring scanlines differ at most
NEIGHBOURS, PERSISTENT = 2, 3      # scanlines either side; of those, itself included, that must show a candidate


@dataclass
class Candidates:
    """Rises on the scanlines of one side, pass and scanner, sorted by row, then outward.

    row, cell : (M,) where each crosses the middle of its height
    u : (M,) m, that place's offset
    base, slope : (M,) height of the road's line there, and its rise over run
    step, rough : (M,) m of the rise, and of the road's scatter about its line
    """

    row: np.ndarray
    cell: np.ndarray
    u: np.ndarray
    base: np.ndarray
    slope: np.ndarray
    step: np.ndarray
    rough: np.ndarray

    def __len__(self):
        return len(self.row)

    def __getitem__(self, which):
        return Candidates(*(getattr(self, name)[which] for name in self.__dataclass_fields__))


def find_candidates(side, nearest, settings):
    """Rises of at least MIN_HEIGHT within SEARCH_WIDTH, and no higher than CLIPPING_HEIGHT.

    Parameters
    ----------
    side : SideScanlines
    nearest : (R,) m, offset on each row from which outward is searched
    settings : ScanlineBoundarySettings

    Returns
    -------
    Candidates
    """
    low = _filled(side.low, rows_filled(side.interval))
    base, slope, rough, count = road_before(low, SPACING)
    span = max(int(round(settings.search_width / SPACING)), 2)
    with np.errstate(invalid="ignore"):
        step = max_ahead(low, span) - base
        middle = base + 0.5 * step
        found = ((count >= LEAST_ROAD) & (step >= LOWEST * settings.min_height) & (step <= settings.clipping_height)
                 & (rough <= ROUGH_SHARE * step) & (low >= middle) & (last_before(low, span) < middle))
        found &= side.offset(np.arange(low.shape[1])) > np.asarray(nearest)[:, None]
    score = np.where(found, step - 2 * rough, -np.inf)
    beyond = max_ahead(score, span, inclusive=False)
    nearer = max_ahead(score[:, ::-1], span, inclusive=False)[:, ::-1]
    row, cell = np.nonzero(found & (score >= np.maximum(beyond, nearer)))
    chosen = Candidates(row, cell, side.offset(cell), *(values[row, cell] for values in (base, slope, step, rough)))
    chosen = chosen[_stays_up(low, chosen) & _own(side.low, chosen, span)]
    return chosen[_persistent(chosen)]


def rows_filled(interval):
    """Scanlines either side that close a scanline's gaps."""
    return max(int(round(FILLED / interval)), 1)


def _filled(low, reach):
    """Heights with the gaps of a scanline closed by its neighbours': lost pulses and shadows leave different ones."""
    filled = low.copy()
    for ahead in range(1, min(reach, len(low) - 1) + 1):
        for shifted, own in ((low[ahead:], filled[:-ahead]), (low[:-ahead], filled[ahead:])):
            np.copyto(own, shifted, where=np.isnan(own))
    return filled


def _own(low, candidates, span):
    """Did the scanline itself see something about the rise? Its neighbours alone would draw it beyond their ends."""
    cells = np.clip(candidates.cell[:, None] + np.arange(-span, span + 1), 0, low.shape[1] - 1)
    return np.isfinite(low[candidates.row[:, None], cells]).any(1)


def _stays_up(low, candidates):
    """Does the ground behind stay above half the rise?"""
    first, last = (int(round(reach / SPACING)) for reach in BEHIND)
    cells = candidates.cell[:, None] + np.arange(first, last + 1)
    heights = np.where(cells < low.shape[1], low[candidates.row[:, None], np.minimum(cells, low.shape[1] - 1)], np.nan)
    seen = np.isfinite(heights).sum(1)
    with np.errstate(invalid="ignore"):
        sunk = (heights < (candidates.base + 0.5 * candidates.step)[:, None]).sum(1)
    return (seen >= FEWEST_BEHIND) & (sunk <= LOW_SHARE * seen)


def _persistent(candidates):
    """Is there a candidate at the same place on enough of the neighbouring scanlines?"""
    count = len(candidates)
    if not count:
        return np.zeros(0, bool)
    span = 1000.0
    order = np.lexsort((candidates.u, candidates.row))
    key = (candidates.row * span + candidates.u)[order]
    seen = np.ones(count, np.int64)
    for ahead in range(-NEIGHBOURS, NEIGHBOURS + 1):
        if not ahead:
            continue
        right = np.searchsorted(key, (candidates.row + ahead) * span + candidates.u)
        partner = np.zeros(count, bool)
        for k in (np.clip(right - 1, 0, count - 1), np.clip(right, 0, count - 1)):
            other = order[k]
            partner |= (candidates.row[other] == candidates.row + ahead) \
                & (np.abs(candidates.u[other] - candidates.u) <= SAME_ACROSS * max(abs(ahead), 1)) \
                & (np.abs(candidates.base[other] - candidates.base) <= SAME_UP)
        seen += partner
    return seen >= PERSISTENT
