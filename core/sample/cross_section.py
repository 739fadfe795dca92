"""One side of the road across: from the edge of the carriageway outwards."""

from dataclasses import dataclass

import numpy as np

LOWERED = 0.02  # m, what is left of a curb at a driveway or crossing
_RAMP = 1.0     # m along the road from full to lowered curb


@dataclass(frozen=True)
class Side:
    """Strips beside the carriageway, each straight across between two borders.

    Attributes
    ----------
    sign : 1 left, -1 right
    borders : (K+1,) distances from the axis, m, increasing; the first is the edge of the carriageway
    rises : (K+1,) heights at the borders above the edge of the carriageway, m, without the curb
    on_curb : (K+1,) how much of the curb's height each border has, 0 or 1
    strips : K names of the ground
    curb_height : m, 0 where there is none
    lowered : list of (start, end) stations at which the curb is lowered
    """

    sign: int
    borders: np.ndarray
    rises: np.ndarray
    on_curb: np.ndarray
    strips: tuple
    curb_height: float = 0.0
    lowered: tuple = ()

    @property
    def edge(self):
        """Distance of the edge of the carriageway (the curb bottom) from the axis."""
        return float(self.borders[0])

    def curb(self, s):
        """Height of the curb at stations `s`, m."""
        height = np.full(np.shape(s), self.curb_height)
        for start, end in self.lowered:
            way = np.clip(np.maximum(start - s, s - end) / _RAMP, 0.0, 1.0)
            height = np.minimum(height, LOWERED + (self.curb_height - LOWERED) * way * way * (3 - 2 * way))
        return height

    def border_rise(self, k, s):
        """Height of border `k` (a number or one per point) above the edge of the carriageway."""
        return self.rises[k] + self.on_curb[k] * self.curb(s)

    def rise(self, s, away):
        """Height above the edge of the carriageway at distances `away` from the axis, beyond the edge."""
        strip = np.clip(np.searchsorted(self.borders, away, side="right") - 1, 0, len(self.strips) - 1)
        return self.rise_in_strip(strip, s, away)

    def rise_in_strip(self, strip, s, away):
        """The same on the plane of a given strip, also a little beyond its borders."""
        curb = self.curb(s)
        inner = self.rises[strip] + self.on_curb[strip] * curb
        outer = self.rises[strip + 1] + self.on_curb[strip + 1] * curb
        share = (away - self.borders[strip]) / (self.borders[strip + 1] - self.borders[strip])
        return inner + (outer - inner) * share

    def steepness(self, strip, s):
        """Slope of strips outwards, metres per metre."""
        rise = self.border_rise(strip + 1, s) - self.border_rise(strip, s)
        return rise / (self.borders[strip + 1] - self.borders[strip])


def sidewalk(sign, edge, curb_height, lowered=(), width=3.6, reach=24.0, face=0.025):
    """A raised curb with a battered face, curb stone, sidewalk and a verge up to `reach`.

    Where the curb is lowered the sidewalk ramps down to it over its first metre.
    """
    top = edge + face
    borders = np.array([edge, top, top + 0.15, top + 1.2, edge + width, reach])
    level = curb_height + 0.02 * 1.2
    rises = np.array([0.0, 0.0, 0.003, level, curb_height + 0.02 * width, curb_height + 0.02 * width + 0.15])
    on_curb = np.array([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    strips = ("curb face", "curb stone", "sidewalk", "sidewalk", "verge")
    return Side(sign, borders, rises, on_curb, strips, curb_height, tuple(lowered))


def ditch(sign, edge, depth=0.6, reach=24.0):
    """No curb: a falling shoulder, a verge, a ditch and the field behind."""
    borders = edge + np.array([0.0, 0.8, 2.2, 3.6, 4.1, 5.6, 0.0])
    borders[-1] = reach
    rises = np.array([0.0, -0.05, -0.12, -0.12 - depth, -0.12 - depth, 0.05, 0.25])
    return Side(sign, borders, rises, np.zeros(7), ("shoulder", "verge", "verge", "verge", "verge", "verge"))
