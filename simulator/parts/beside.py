"""What runs along a road beside it, wall, concrete barrier, fence and hedge: its shapes for the scanner's pulses, and where it truly is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .materials import LABEL
from .obstacles import Post, Rail, Solid, body

PIECE, RAIL_PIECE = 2.0, 4.0  # m, length of the straight pieces that a thing along the road and a guard rail consist of
_BURIED = 0.3  # m of a thing below the ground
# Kind -> height, thickness (m), reflectance; a barrier has the section of NEW_JERSEY
USUAL = {
    "wall": (1.8, 0.24, 0.24),
    "barrier": (0.81, 0.60, 0.30),
    "fence": (1.2, 0.02, 0.30),
    "hedge": (1.4, 0.80, 0.34),
    "building": (6.5, 6.0, 0.28),
}
NEW_JERSEY = ((0.0, 0.30), (0.075, 0.30), (0.33, 0.12), (0.81, 0.075))  # m, heights and half widths (EN 1317 F and J shapes are close to it)
_MESH = 0.30  # share of the pulses that the wires of a fence return
_LEAVES = 0.10  # m that a pulse travels between the leaves of a hedge, on average


@dataclass(frozen=True)
class RunningThing:
    """Something that runs along the road, as the truth tells it."""

    kind: str   # guard_rail, or one of USUAL
    foot: np.ndarray   # (N, 3) m, local, on the ground along its face towards the road
    height: float   # height, low: m above the ground, of its top and of its lower edge
    low: float = 0.0
    stations: tuple[float, float] | None = None   # (start, end) m, where the scene has stations

    def about(self) -> dict[str, Any]:
        """The fields of the truth that are known of it."""
        start, end = self.stations or (None, None)
        return dict(kind=self.kind, height_m=self.height, foot_m=self.low, station_m=start, end_m=end)


def rail_of(foot: np.ndarray) -> Iterable[Any]:
    """The obstacles of a guard rail, Rail and its Post, along (N, 3) places on the ground (m, local), RAIL_PIECE apart."""
    for start, end in zip(foot[:-1], foot[1:]):
        ahead = end - start
        length = float(np.hypot(*ahead[:2]))
        x, y, z = ((start + end) / 2).tolist()
        yield Rail(x, y, z, float(np.arctan2(ahead[1], ahead[0])), length, float(ahead[2] / length))
        x, y, z = start.tolist()
        yield Post(x, y, z, z + Rail.high, 0.05, LABEL["pole"], 0.35)


def _box(length, near, far, low, high, brightness):
    """An upright box from `near` to `far` (m to the left)."""
    a = length / 2
    return body([(1, 0, 0, a, 0, 0), (-1, 0, 0, -a, 0, 0), (0, 1, 0, 0, far, 0), (0, -1, 0, 0, near, 0), (0, 0, 1, 0, 0, high),
                 (0, 0, -1, 0, 0, low)], brightness)


def _layer(length, low, high, brightness):
    """A layer of a barrier about y = 0, from (height, half width) to (height, half width)."""
    (z0, b0), (z1, b1), a = low, high, length / 2
    rise, back = z1 - z0, b0 - b1
    return body([(1, 0, 0, a, 0, 0), (-1, 0, 0, -a, 0, 0), (0, rise, back, 0, b0, z0), (0, -rise, back, 0, -b0, z0), (0, 0, 1, 0, 0, z1),
                 (0, 0, -1, 0, 0, z0)], brightness)


def straight_pieces(kind: str, foot: np.ndarray, side: int, height: float) -> Iterable[Any]:
    """The obstacles, Solid and Post, of a thing of USUAL along the road.

    foot : (N, 3) m, local, on the ground along its face towards the road, PIECE apart
    side : 1 where it stands left of the direction of `foot`, -1 right
    height : m; of a barrier that of NEW_JERSEY whatever is given
    """
    _, thick, brightness = USUAL[kind]
    label = LABEL[kind]
    near, far = min(0.0, side * thick), max(0.0, side * thick)
    for start, end in zip(foot[:-1], foot[1:]):
        ahead = end - start
        length = float(np.hypot(*ahead[:2]))
        heading = float(np.arctan2(ahead[1], ahead[0]))
        middle = (start + end) / 2
        bodies = (_box(length, near, far, -_BURIED, height, brightness),)
        if kind == "barrier":
            middle = middle + side * NEW_JERSEY[0][1] * np.array([-np.sin(heading), np.cos(heading), 0.0])
            bodies = (_box(length, -thick / 2, thick / 2, -_BURIED, 0.0, brightness),
                      *(_layer(length, low, high, brightness) for low, high in zip(NEW_JERSEY[:-1], NEW_JERSEY[1:])))
        x, y, z = middle.tolist()
        yield Solid(x, y, z, heading, bodies, float(np.hypot(length / 2, thick)), z + height, label, float(ahead[2] / length),
                    _MESH if kind == "fence" else 1.0, _LEAVES if kind == "hedge" else 0.0)
        if kind == "fence":
            x, y, z = start.tolist()
            yield Post(x, y, z, z + height, 0.03, label, brightness)
