"""Strips of ground beside a carriageway: curb and sidewalk, or shoulder and ditch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

LOWERED_CURB_HEIGHT = 0.02  # m, height of a curb at a driveway or crossing
_RAMP = 1.0      # m along the road from full to lowered curb


@dataclass(frozen=True)
class Side:
    """Strips of ground beside the carriageway, on one side of the road; each is straight across between two borders."""

    sign: int   # 1 left, -1 right
    borders: np.ndarray   # (K + 1,) m from the axis, increasing; the first is the edge of the carriageway
    rises: np.ndarray   # (K + 1,) m, heights of the borders above the edge of the carriageway, without the curb
    on_curb: np.ndarray   # (K + 1,) 0 or 1, share of the height of the curb at each border
    strips: tuple[str, ...]   # K names of the ground
    curb_height: float = 0.0   # m, 0 where there is no curb
    lowered: tuple[tuple[float, float], ...] = ()   # (start, end) stations of lowered curbs, m

    @property
    def edge(self) -> float:
        """Distance of the edge of the carriageway (the curb bottom) from the axis, m."""
        return float(self.borders[0])

    def curb(self, s: np.ndarray) -> np.ndarray:
        """Height of the curb at (N,) stations, (N,) m."""
        height = np.full(np.shape(s), self.curb_height)
        for start, end in self.lowered:
            way = np.clip(np.maximum(start - s, s - end) / _RAMP, 0.0, 1.0)
            height = np.minimum(height, LOWERED_CURB_HEIGHT + (self.curb_height - LOWERED_CURB_HEIGHT) * way * way * (3 - 2 * way))
        return height

    def border_rise(self, k: np.ndarray | int, s: np.ndarray) -> np.ndarray:
        """Height of border `k` (a number or one per point) above the edge of the carriageway."""
        return self.rises[k] + self.on_curb[k] * self.curb(s)

    def rise(self, s: np.ndarray, away: np.ndarray) -> np.ndarray:
        """Height above the edge of the carriageway at distances `away` from the axis, beyond the edge."""
        strip = np.clip(np.searchsorted(self.borders, away, side="right") - 1, 0, len(self.strips) - 1)
        return self.rise_in_strip(strip, s, away)

    def rise_in_strip(self, strip: np.ndarray, s: np.ndarray, away: np.ndarray) -> np.ndarray:
        """The same on the plane of a given strip, also a little beyond its borders."""
        curb = self.curb(s)
        inner = self.rises[strip] + self.on_curb[strip] * curb
        outer = self.rises[strip + 1] + self.on_curb[strip + 1] * curb
        share = (away - self.borders[strip]) / (self.borders[strip + 1] - self.borders[strip])
        return inner + (outer - inner) * share

    def steepness(self, strip: np.ndarray | int, s: np.ndarray) -> np.ndarray:
        """Outward slope of strips at stations, m per m."""
        rise = self.border_rise(strip + 1, s) - self.border_rise(strip, s)
        return rise / (self.borders[strip + 1] - self.borders[strip])


def sidewalk(sign: int, edge: float, curb_height: float, lowered: Sequence[tuple[float, float]] = (), width: float = 3.6,
             reach: float = 24.0, face: float = 0.025) -> Side:
    """A raised curb with an inclined face, curb stone, sidewalk and verge, on the left (sign 1) or right (-1) of an axis.

    edge, reach : m from the axis to the curb bottom and to the end of the verge
    lowered : (start, end) stations of lowered curbs, m, to which the sidewalk ramps down over its first metre
    width, face : m, of curb and sidewalk, and across the face of the curb
    """
    top = edge + face
    borders = np.array([edge, top, top + 0.15, top + 1.2, edge + width, reach])
    level = curb_height + 0.02 * 1.2
    rises = np.array([0.0, 0.0, 0.003, level, curb_height + 0.02 * width, curb_height + 0.02 * width + 0.15])
    on_curb = np.array([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    strips = ("curb face", "curb stone", "sidewalk", "sidewalk", "verge")
    return Side(sign, borders, rises, on_curb, strips, curb_height, tuple(lowered))


def ditch(sign: int, edge: float, depth: float = 0.6, reach: float = 24.0) -> Side:
    """No curb: a falling shoulder, a verge, a ditch and a field, on the left (sign 1) or right (-1) of an axis.

    `edge`, `reach`: m from the axis to the edge of the carriageway and to the end of the field.
    """
    borders = edge + np.array([0.0, 0.8, 2.2, 3.6, 4.1, 5.6, 0.0])
    borders[-1] = reach
    rises = np.array([0.0, -0.05, -0.12, -0.12 - depth, -0.12 - depth, 0.05, 0.25])
    return Side(sign, borders, rises, np.zeros(7), ("shoulder", "verge", "verge", "verge", "verge", "verge"))
