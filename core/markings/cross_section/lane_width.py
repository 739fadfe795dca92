"""How wide lanes are in the strip between two boundaries, and where they begin."""

from __future__ import annotations

import numpy as np

from .weights import CURB, ISLAND, OPEN, PAVEMENT, SURFACE

LIKELY_SHARE = 0.8, 1.5    # of the usual width of a lane: lanes in bends
# whether nothing is painted there, and whether the surface ends without an edge or nothing is known of it, by what a boundary is made of
UNPAINTED, SURFACE_END = (np.isin(np.arange(PAVEMENT + 1), made) for made in ((CURB, ISLAND, PAVEMENT, SURFACE, OPEN), (SURFACE, OPEN)))


def lane_places(left: np.ndarray, right: np.ndarray, made_left: np.ndarray, made_right: np.ndarray, number: np.ndarray | int, usual: float,
                bend: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where lanes lie in strips.

    Between two lines they share the strip. Beside a curb, or an edge of the pavement that was seen, they are no wider than usual; beside an island,
    where nothing else has room, they share the strip too, but are as wide as usual where it reaches somewhat into them. Elsewhere the surface may
    end at what hides it, and reach into side streets: beside its end they are as wide as usual. In bends, where lanes are widened, lanes beside the
    end of the surface are as wide as there is room.

    Parameters
    ----------
    left, right : metres, offsets of the two boundaries of each strip; all arrays broadcast together
    made_left, made_right : SOLID ... ISLAND, what the boundaries are made of
    number : lanes in the strip
    usual : metres, the usual width of a lane
    bend : bool, whether the road bends so much that lanes are widened

    Returns
    -------
    begin : metres, offset of the left border of the leftmost lane
    each : metres, width of each lane
    """
    open_left, open_right = UNPAINTED[made_left], UNPAINTED[made_right]
    loose = open_left ^ open_right
    each = (left - right) / number
    widened = bend & (each > LIKELY_SHARE[0] * usual) & (each < LIKELY_SHARE[1] * usual)
    hidden = loose & beside_surface_end(made_left, made_right)
    least = np.where(widened & ((made_left == PAVEMENT) | (made_right == PAVEMENT)), each, np.minimum(each, usual))
    likely = beside_island(made_left, made_right) & (each > LIKELY_SHARE[0] * usual) & (each < LIKELY_SHARE[1] * usual)
    each = np.where(hidden, np.where(widened, each, usual), np.where(loose, np.where(likely, np.maximum(each, usual), least), each))
    return np.where(loose & open_left, right + number * each, left), each


def beside_island(made_left: np.ndarray, made_right: np.ndarray) -> np.ndarray:
    """Bool, whether a strip reaches to the curb of an island."""
    return (made_left == ISLAND) | (made_right == ISLAND)


def beside_surface_end(made_left: np.ndarray, made_right: np.ndarray) -> np.ndarray:
    """Bool, whether a strip reaches to where the surface ends without an edge, or to where nothing is known of it."""
    return SURFACE_END[made_left] | SURFACE_END[made_right]
