"""Where no curb was found and the points lie too far apart to say that there is none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .ground_grid import GroundCells

if TYPE_CHECKING:
    from .pavement_edge import Carriageway

# points per m² of ground. A face of 10 cm of curb is 2 to 4 cm broad in plan and has some ten points per metre then. On simulated surveys of which
# a quarter and a tenth of the points was kept nearly all curbs were found where more lay at their foot, and few where fewer did.
MIN_CURB_DENSITY = 80.0
MARGIN = 1.0              # m inside the limits of the carriageway in which points are counted
STRETCH_ROWS = 20         # rows of ground cells that are looked at together
SEEN_SHARE = 0.3          # of the cells of a stretch that must hold ground: where something hides it, nothing is said
SHORTEST_TOLD = 20.0      # m of all thin margins together from which they are told
TOLD_STRETCHES = 4        # that are named, the longest first
SHORTEST_SEEN = 50.0      # m of margins without a curb that hold points enough, from which a survey shows whether its roads have curbs
FEW_CURBS = 0.05          # share of the margins that have a curb on roads without curbs: one at a bridge or a bus stop


class ThinMargin(NamedTuple):
    """A stretch of one side of a road without a curb.

    road, side : number of the road; left or right
    start, end : stations, m
    density : points per m² there
    pavement : whether an edge of the pavement was drawn there
    """

    road: int
    side: str
    start: float
    end: float
    density: float
    pavement: bool = False


@dataclass
class Margins:
    """What the margins of the roads of a survey show of curbs.

    thin : stretches that no curb bounds and that hold fewer points than curbs need
    curb, bare : m of margins along a curb, and without one though the points are enough
    """

    thin: list[ThinMargin] = field(default_factory=list)
    curb: float = 0.0
    bare: float = 0.0

    def add(self, road: int, carriageway: Carriageway, curbs: dict[str, np.ndarray], pavement: dict[str, np.ndarray]) -> None:
        """Add those of a road.

        Parameters
        ----------
        road : number
        carriageway : Carriageway, its limits are taken as they are
        curbs, pavement : side to (R,) bool, the rows beside which a curb, or an edge of the pavement, was drawn
        """
        cells = carriageway.cells
        length = STRETCH_ROWS * cells.row_size
        for side, sign, limit in (("left", 1.0, carriageway.left), ("right", -1.0, carriageway.right)):
            density = _densities(cells, carriageway.ground, sign, np.where(curbs[side], np.nan, limit))
            self.curb += float(curbs[side].sum()) * cells.row_size
            self.bare += float((density >= MIN_CURB_DENSITY).sum()) * length
            paved = _mostly(pavement[side])
            # 0 where it is not thin, 1 where it is, 2 where it is and the pavement was seen to end
            state = np.r_[0, np.where(density < MIN_CURB_DENSITY, 1 + paved, 0), 0]
            turns = np.flatnonzero(np.diff(state))
            for first, after in zip(turns[:-1], turns[1:]):
                if state[first + 1]:
                    begin, end = (cells.first_row * cells.row_size + k * length for k in (first, after))
                    self.thin.append(ThinMargin(road, side, begin, end, float(np.median(density[first:after])), bool(state[first + 1] == 2)))

    @property
    def unknown(self) -> list[ThinMargin]:
        """Those thin stretches where there may be a curb.

        On a survey that has hardly a curb where one could be seen, as on a motorway, what ends the pavement elsewhere is none either.
        """
        none = self.bare >= SHORTEST_SEEN and self.curb <= FEW_CURBS * (self.curb + self.bare)
        return [margin for margin in self.thin if not (none and margin.pavement)]


def _mostly(rows):
    """(K,) bool, whether most rows of stretches of STRETCH_ROWS are true."""
    first = np.arange(0, len(rows), STRETCH_ROWS)
    return 2 * np.add.reduceat(rows.astype(int), first) >= np.diff(np.r_[first, len(rows)]) if len(rows) else np.zeros(0, bool)


def _densities(cells: GroundCells, ground: np.ndarray, sign: float, limit: np.ndarray) -> np.ndarray:
    """(K,) points per m² along one margin, of stretches of STRETCH_ROWS; NaN where it was hardly seen."""
    found = []
    for first in range(0, len(limit), STRETCH_ROWS):
        rows = slice(first, first + STRETCH_ROWS)
        inside = sign * (limit[rows, None] - cells.offsets)   # NaN is not inside
        margin = (inside > 0) & (inside < MARGIN)
        count = cells.count[rows]
        count = count[margin & ground[rows] & (count > 0)]
        enough = 2 * np.isfinite(limit[rows]).sum() >= STRETCH_ROWS and len(count) >= max(SEEN_SHARE * margin.sum(), 1)
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
