"""Single uprights: poles, signs and trunks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

POLE_CELL = 0.10          # m, of the plan
POLE_BIN = 0.25           # m of height
SHAFT = 0.5, 2.0          # m above the ground where a shaft stands free of grass and, mostly, of branches
MIN_SHAFT_FILLED = 0.6    # share of the height bins of the shaft with points, in every cell of it or beside
MAX_FOOTPRINT = 0.8       # m of a shaft
MIN_POLE_POINTS = 20      # on the shaft
MAX_CIRCLE_MISS = 0.06           # m, median distance of a shaft's points from its circle
MIN_DIAMETER = 0.03       # m, what a circle may be
SLENDER = 5.5             # times as high as thick at least: people, bushes and the ends of cars are stouter
AS_LOW_AS_CARS = 2.0      # m: what is lower stands free, or it is the edge of a vehicle
FREE_ABOUT = 0.15, 0.60   # m from its shaft, between which little else stands
MAX_BESIDE = 0.5          # points there for each on the shaft
WIDER_LEVEL = 1.5         # times the spread of the narrower levels of a shaft, beyond which a level holds a plate or leaves
HEAD_REACH = 1.5          # m about a shaft in which its head is looked for
MAX_POLE_GAP = 4          # bins of POLE_BIN without points, beyond which something else begins
HEAD_CELL = 0.20          # m, of the plan: what is not linked to the shaft by such cells stands behind it
CROWN_SPREAD = 0.45       # m, standard deviation across of what lies above a trunk's shaft
TRUNK_DIAMETER = 0.12     # m at least
PLATE = 0.12, 0.9         # m, standard deviation across of a sign's head (a plate of 0.4 to 3 m); less is a pole
PLATE_THICKNESS = 0.06    # m, standard deviation of a sign's head through its plate
MIN_HEAD_POINTS = 15


@dataclass(frozen=True)
class Pole:
    """One upright thing.

    kind : pole, sign or trunk
    s, d, z : m, station and offset of its middle, local z of the ground
    diameter, height : m
    """

    kind: str
    s: float
    d: float
    z: float
    diameter: float
    height: float


def find_poles(s: np.ndarray, d: np.ndarray, above: np.ndarray, ground: np.ndarray, own: tuple[float, float], min_height: float) -> list[Pole]:
    """Poles, signs and trunks of a stretch of road.

    Parameters
    ----------
    s, d : (N,) m, stations and offsets of points beside the carriageway, with a margin before and after the stretch
    above, ground : (N,) m, heights above the ground, and local z of it
    own : stations (m) between which the middle of a pole must lie: a pole belongs to one stretch
    min_height : m
    """
    low = np.flatnonzero((above > SHAFT[0]) & (above < SHAFT[1]))
    if len(low) < MIN_POLE_POINTS:
        return []
    i, j = (np.floor(v[low] / POLE_CELL).astype(np.int64) for v in (s, d))
    i, j = i - i.min(), j - j.min()
    k = np.floor((above[low] - SHAFT[0]) / POLE_BIN).astype(np.int64)
    levels = int(round((SHAFT[1] - SHAFT[0]) / POLE_BIN))
    filled = np.zeros((int(i.max()) + 1, int(j.max()) + 1, levels), bool)
    filled[i, j, np.minimum(k, levels - 1)] = True
    # a plate or a branch beside the shaft fills some of the levels alone
    levels_about = ndimage.maximum_filter(filled, size=(3, 3, 1)).mean(axis=2)
    label, _ = ndimage.label(filled.any(axis=2) & (levels_about >= MIN_SHAFT_FILLED), np.ones((3, 3)))
    found = []
    for number, box in enumerate(ndimage.find_objects(label), 1):
        size = [(side.stop - side.start) * POLE_CELL for side in box]
        if max(size) > MAX_FOOTPRINT or filled[box][label[box] == number].any(axis=0).mean() < MIN_SHAFT_FILLED:
            continue
        rows = low[(label[i, j] == number)]
        pole = _pole(rows, s, d, above, ground, min_height)
        if pole is not None and own[0] <= pole.s < own[1]:
            found.append(pole)
    return found


def _pole(rows, s, d, above, ground, min_height):
    """The Pole of a shaft's points; None where it is none."""
    foot = float(above[rows].min())
    rows = rows[_narrow(s[rows], d[rows], above[rows])]
    if len(rows) < MIN_POLE_POINTS:
        return None
    stands = float(above[rows].min()) < foot + POLE_BIN
    place = np.c_[s[rows], d[rows]]
    centre, radius = _circle(place)
    miss = np.abs(np.hypot(*(place - centre).T) - radius)
    if np.median(miss) > MAX_CIRCLE_MISS or 2 * radius > MAX_FOOTPRINT:
        return None
    near = np.flatnonzero((np.abs(s - centre[0]) < HEAD_REACH) & (np.abs(d - centre[1]) < HEAD_REACH))
    ring = np.hypot(s[near] - centre[0], d[near] - centre[1])
    height = _top(above[near][ring < max(2 * radius, 0.25)])
    # people are slender at the head alone
    if height < max(min_height, SLENDER * 2 * radius) or height < AS_LOW_AS_CARS and not stands:
        return None
    beside = (above[near] > SHAFT[0]) & (above[near] < height) & (ring > radius + FREE_ABOUT[0]) & (ring < radius + FREE_ABOUT[1])
    if height < AS_LOW_AS_CARS and beside.sum() > MAX_BESIDE * len(rows):
        return None
    head = near[(above[near] > SHAFT[1] - 0.5) & (above[near] < height + HEAD_REACH) & (ring < HEAD_REACH) & (ring > 2 * radius)]
    kind = _head_kind(_linked(np.c_[s[head], d[head]] - centre, radius), 2 * radius)
    return Pole(kind, float(centre[0]), float(centre[1]), float(np.median(ground[rows])), float(max(2 * radius, MIN_DIAMETER)), float(height))


def _narrow(s, d, above):
    """(N,) bool, which points of a shaft lie at levels where it is as narrow as it mostly is."""
    level = np.floor((above - SHAFT[0]) / POLE_BIN).astype(np.int64)
    count = np.bincount(level)
    n = np.maximum(count, 1)
    spread = np.sqrt(sum(np.maximum(np.bincount(level, v * v) / n - (np.bincount(level, v) / n) ** 2, 0.0) for v in (s - s.mean(), d - d.mean())))
    narrow = np.quantile(spread[count > 1], 0.25) if (count > 1).any() else 0.0
    return (spread <= WIDER_LEVEL * narrow + 0.01)[level]


def _linked(head, radius):
    """Those of (N, 2) places about a shaft that hang together with it."""
    if not len(head):
        return head
    middle = int(np.ceil(HEAD_REACH / HEAD_CELL)) + 1
    cell = np.floor(head / HEAD_CELL + 0.5).astype(np.int64) + middle
    filled = np.zeros((2 * middle + 1,) * 2, bool)
    filled[cell[:, 0], cell[:, 1]] = True
    own = int(np.ceil(radius / HEAD_CELL))
    filled[middle - own:middle + own + 1, middle - own:middle + own + 1] = True
    label, _ = ndimage.label(filled, np.ones((3, 3)))
    return head[label[cell[:, 0], cell[:, 1]] == label[middle, middle]]


def _head_kind(head, diameter):
    """What a shaft carries."""
    if len(head) < MIN_HEAD_POINTS:
        return "pole"
    spread = np.sqrt(np.linalg.eigvalsh(np.cov(head.T)))
    if diameter > TRUNK_DIAMETER and spread[0] > 0.5 * CROWN_SPREAD and spread[1] > CROWN_SPREAD:
        return "trunk"
    return "sign" if spread[0] < PLATE_THICKNESS and PLATE[0] < spread[1] < PLATE[1] else "pole"


def _top(above):
    """m: top of what rises without a gap."""
    if not len(above):
        return 0.0
    filled = np.zeros(int(above.max() / POLE_BIN) + MAX_POLE_GAP + 2, bool)
    filled[np.maximum(np.floor(above / POLE_BIN), 0).astype(np.int64)] = True
    filled[:int(SHAFT[1] / POLE_BIN)] = True
    empty = np.convolve(~filled, np.ones(MAX_POLE_GAP, int), "valid") == MAX_POLE_GAP
    end = (int(np.argmax(empty)) if empty.any() else len(filled)) * POLE_BIN
    return float(above[above < end].max(initial=0.0))


def _circle(place):
    """(centre, radius) of the circle through points that may lie on one side of it.

    The radius is that of Taubin's fit, which an arc seen from one side does not make smaller than it is; a thin pole, whose points
    lie within the noise, has the radius of their scatter.
    """
    middle = place.mean(axis=0)
    x, y = (place - middle).T
    w = x * x + y * y
    mean = w.mean()
    design = np.c_[(w - mean) / (2.0 * np.sqrt(max(mean, 1e-12))), x, y]
    _, _, v = np.linalg.svd(design, full_matrices=False)
    a = v[2] / np.array([2.0 * np.sqrt(max(mean, 1e-12)), 1.0, 1.0])
    if abs(a[0]) > 1e-9:
        centre = -a[1:] / (2.0 * a[0])
        radius = float(np.sqrt(max(centre @ centre + mean, 0.0)))
        if radius < MAX_FOOTPRINT and np.hypot(*centre) < MAX_FOOTPRINT:
            return middle + centre, radius
    return middle, float(np.sqrt(mean))
