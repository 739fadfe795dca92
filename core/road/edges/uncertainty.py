"""How uncertain the place of a road edge is: one sigma across it.

Seven things add up as squares: how well the foot of a curb is found at all, and how much better with more points on it; curb points scatter
about the line, and their errors go on over metres; towards its ends a line is held from one side only; passes that were driven apart
and laid on each other agree on a middle of which nobody knows how far off it is; a bridge is an even bend led across a gap, and off by what
the bend changes in it, which grows with the third power of the gap; and where a line was fitted as a whole to few laser points,
its curb points are off together by what the fit says. The shares were found on simulated streets with truth (docs/accuracy.md).
It holds against the points of the survey: what they are off as a whole, with their trajectory, is in it only where the
accuracy of the trajectory was told, since one pass does not show it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.tracking import MAX_JOINED_GAP

SCATTER_REACH = 10.0    # m along the line, either way, over which the scatter of curb points is taken
POINTS_POWER = 1.3      # more than 1: where points are few, they also lie less regularly on the curb
END_LENGTH = 5.0        # m from its end at which the uncertainty of a line's end has fallen to 1/e in square


@dataclass(frozen=True)
class EdgeUncertainty:
    """The shares of an edge's uncertainty.

    foot : m, of a curb's foot, however many points are on it
    spacing : m, of the foot by a single laser point; its square falls with N points as N**-POINTS_POWER
    scatter : of the RMS of residuals of curb points; more than 1, as a line follows errors that go on over metres and shows less of them
    end : m, at the end of a line
    gap : m per m to the nearest curb point
    bridge : m per m³, in the middle of a bridge, of its length; from stretches of five simulated streets that were measured: taken for hidden over
        6, 10 and 15 m and bridged, they came to lie beside their place by 0.2, 0.3 and 1.7 cm (68 %), and by 1.5, 4 and 15 cm (95 %). It is
        a third of the latter in the mean of a bridge, for what bends change by has long tails
    """

    foot: float
    spacing: float
    scatter: float
    end: float
    gap: float
    bridge: float = 2e-5


MAIN_EDGE = EdgeUncertainty(foot=0.0014, spacing=0.10, scatter=1.2, end=0.0015, gap=0.0005)
CURB_RETURN = EdgeUncertainty(foot=0.0075, spacing=0.0, scatter=1.5, end=0.006, gap=0.0005)   # found in plan, from fewer points


def edge_sigma(at: np.ndarray, places: np.ndarray, residual: np.ndarray, support: np.ndarray | None = None,
               shares: EdgeUncertainty = MAIN_EDGE, passes: np.ndarray | float = 0.0,
               shared: np.ndarray | float = 0.0) -> np.ndarray:
    """One sigma across an edge at places along it.

    Parameters
    ----------
    at : (K,) m along the line, where it is looked at
    places : (N,) m along the line of all its curb points, rising
    residual : (N,) m, distances of the curb points from the line
    support : (N,) laser points of each; below 1, or None, where that is unknown
    shares : EdgeUncertainty
    passes : m, one sigma of the middle of the passes, see `RoadFrame.pass_sigma`; one for all or (K,)
    shared : m, one sigma that neighbouring curb points share, as those of a line that was fitted as a whole: they do not scatter about
        it; one for all or (K,)

    Returns
    -------
    (K,) m
    """
    first, last = np.searchsorted(places, at - SCATTER_REACH), np.searchsorted(places, at + SCATTER_REACH, side="right")
    # of a line as long as the road, only the points about the piece
    near = slice(int(first.min()), int(last.max()))
    few = np.zeros(near.stop - near.start) if support is None else np.where(support[near] > 0, 1.0 / np.maximum(support[near], 1), 0.0)
    scatter, spacing = (np.diff(np.append(0.0, np.cumsum(each))[[first - near.start, last - near.start]], axis=0)[0] / np.maximum(last - first, 1)
                        for each in (np.square(residual[near]), few))
    k = np.clip(np.searchsorted(places, at), 1, len(places) - 1)
    gap = np.clip(np.minimum(at - places[k - 1], places[k] - at), 0.0, None)
    length, into = places[k] - places[k - 1], at - places[k - 1]
    bridge = np.where(length > MAX_JOINED_GAP, 4.0 * shares.bridge * length * np.clip(into * (length - into), 0.0, None), 0.0)
    end = np.clip(np.minimum(at - places[0], places[-1] - at), 0.0, None)
    variance = (shares.foot**2 + shares.spacing**2 * spacing**POINTS_POWER + shares.scatter**2 * scatter + shares.end**2 * np.exp(-end / END_LENGTH)
                + (shares.gap * gap) ** 2 + bridge**2 + passes**2 + shared**2)
    return np.sqrt(variance)
