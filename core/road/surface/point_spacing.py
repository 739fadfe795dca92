"""Where no curb was found and the points lie too far apart to say that there is none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .ground_grid import GroundCells

if TYPE_CHECKING:
    from .extract import Carriageway

# points per m² of ground. A face of 10 cm of curb is 2 to 4 cm broad in plan and has some ten points per metre then. On simulated surveys of which
# a quarter and a tenth of the points was kept nearly all curbs were found where more lay at their foot, and few where fewer did.
MIN_CURB_DENSITY = 80.0
MARGIN = 1.0              # m inside the limits of the carriageway in which points are counted
STRETCH_ROWS = 20         # rows of ground cells that are looked at together
SEEN_SHARE = 0.3          # of the cells of a stretch that must hold ground: where something hides it, nothing is said
SHORTEST_TOLD = 20.0      # m of all thin margins together from which they are told
TOLD_STRETCHES = 4        # that are named, the longest first


class ThinMargin(NamedTuple):
    """A stretch of one side of a road without a curb: road number, side, stations (m), and points per m² there."""

    road: int
    side: str
    start: float
    end: float
    density: float


def thin_margins(road: int, carriageway: Carriageway, curbs: dict[str, np.ndarray]) -> list[ThinMargin]:
    """Stretches of a road that no curb bounds and whose margins hold fewer points than curbs need.

    Parameters
    ----------
    road : number
    carriageway : Carriageway, its limits are taken as they are
    curbs : side to (R,) bool, the rows beside which a curb was found
    """
    cells = carriageway.cells
    found = []
    for side, sign, limit in (("left", 1.0, carriageway.left), ("right", -1.0, carriageway.right)):
        density = _densities(cells, carriageway.ground, sign, np.where(curbs[side], np.nan, limit))
        thin = np.r_[False, density < MIN_CURB_DENSITY, False]
        turns = np.flatnonzero(np.diff(thin.astype(int)))
        length = STRETCH_ROWS * cells.row_size
        for first, after in zip(turns[::2], turns[1::2]):
            found.append(ThinMargin(road, side, cells.first_row * cells.row_size + first * length,
                                    cells.first_row * cells.row_size + after * length, float(np.median(density[first:after]))))
    return found


def _densities(cells: GroundCells, ground: np.ndarray, sign: float, limit: np.ndarray) -> np.ndarray:
    """(K,) points per m² along one margin, of stretches of STRETCH_ROWS; NaN where it was hardly seen."""
    inside = sign * (limit[:, None] - cells.offsets)   # NaN is not inside
    margin = (inside > 0) & (inside < MARGIN)
    seen = margin & ground & (cells.count > 0)
    found = []
    for first in range(0, len(limit), STRETCH_ROWS):
        rows = slice(first, first + STRETCH_ROWS)
        count = cells.count[rows][seen[rows]]
        enough = 2 * np.isfinite(limit[rows]).sum() >= STRETCH_ROWS and len(count) >= max(SEEN_SHARE * margin[rows].sum(), 1)
        found.append(float(np.median(count)) / (cells.row_size * cells.column_size) if enough else np.nan)
    return np.array(found)


def said_of_thin(margins: Sequence[ThinMargin]) -> str:
    """What a user is told of them, one sentence after the other; "" where there is little to tell."""
    total = sum(margin.end - margin.start for margin in margins)
    if total < SHORTEST_TOLD:
        return ""
    longest = sorted(margins, key=lambda margin: margin.start - margin.end)[:TOLD_STRETCHES]
    density = float(np.average([margin.density for margin in margins], weights=[margin.end - margin.start for margin in margins]))
    where = "; ".join(f"road {m.road}, {m.side} side, station {m.start:.0f} to {m.end:.0f} m" for m in longest)
    where += "; …" if len(margins) > len(longest) else ""
    return (f"The points are too few to find curbs along {total:.0f} m, where none was drawn ({where}): {density:.0f} per m² beside "
            f"the limit of the road surface, some {100 / np.sqrt(density):.0f} cm apart. A curb of 10 cm needs about "
            f"{MIN_CURB_DENSITY:.0f}, a lower one more; whether there is one is not known. Give the whole cloud if this one was thinned, or "
            "drive slower or nearer to that side.")
