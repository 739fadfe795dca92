"""Upright things in slices across the road, single poles, and the ground beside the road that they stand on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.ndimage import grey_opening, median_filter, minimum_filter1d

from ....core.common.arrays import Rows, order_by
from ....core.road.common.pseudo_scanlines import lowest_layers
from ....core.survey.survey import Survey
from ....core.survey.weights import READING
from ..surface_grid import CROSS_CELL, SLICE_LENGTH, smoothed, surface_grid

UPRIGHT_SLICE = 0.5              # m along the road
UPRIGHT_CELL = 0.10              # m across
HEIGHT_BIN = 0.10        # m
LOW_BINS = 25            # height bins in which things stand: up to 2.5 m
TOP_BIN, TOP_BINS = 0.05, 16   # m and number of the bins below the top that tell the kind of a line
FIRST_BIN = 2            # bins below it (0.2 m) hold grass and curbs
ON_GROUND = (FIRST_BIN + 1) * HEIGHT_BIN   # m: what is seen from here down stands on the ground, for grass hides the rest
REACH_CELLS = 1          # cells on either side that belong to the same upright
BODY_CELLS = 3           # cells on either side whose points describe it
MIN_BINS = 2             # occupied height bins of an upright
TOP_SHARE = 0.97         # quantile of heights that is its top: ghosts lie higher
TALL = 2.3               # m: what reaches higher is measured up to the height that was read
TALL_BIN = 0.25          # m, bins of tall things
MAX_LOW_GAP, MAX_TALL_GAP = 2, 5  # unoccupied bins of TALL_BIN, below and above TALL, beyond which something else begins
UPPER_SIDE = 0.05        # m below its top that the upper side of a thing reaches down to
MIN_FACE_POINTS = 3      # below that
SIGHT_MARGIN = 0.10      # m below the line of sight over the top, from which a point was seen through the thing
TOP_DEPTH = 0.30         # m below the top that a thing's own upper side may lie behind its face
BEHIND = 0.30, 3.0       # m behind it where points seen through it are counted


@dataclass
class Uprights(Rows):
    """N uprights."""

    slice: np.ndarray   # (N,) int, number of the slice, counted from station 0
    d: np.ndarray   # d, ground: (N,) m, offset of the face, and local z of the ground at its foot
    ground: np.ndarray
    top: np.ndarray   # top, foot: (N,) m above the ground
    foot: np.ndarray
    below_top: np.ndarray   # (N, TOP_BINS) number of points in bins counted down from the top
    thickness: np.ndarray   # (N,) m across between the 10 % and 90 % quantile of its points
    batter: np.ndarray   # (N,) m across per m of height, positive where it leans away from the road
    points: np.ndarray   # points, behind: (N,) number of points on it, and of those seen through it
    behind: np.ndarray
    above_view: np.ndarray   # (N,) bool, may it be higher than what the scanner saw of it?
    rough: np.ndarray   # (N,) m across between two points of its face of which one is next above the other, median

    @staticmethod
    def none() -> Uprights:
        empty = np.empty(0)
        return Uprights(np.empty(0, np.int64), *(empty,) * 4, np.empty((0, TOP_BINS)), *(empty,) * 4, np.empty(0, bool), empty)


def find_uprights(s: np.ndarray, d: np.ndarray, above: np.ndarray, ground: np.ndarray, slices: tuple[int, int], side: int,
                  sight: np.ndarray, min_height: float) -> Uprights:
    """Uprights of one side (1 left, -1 right) of a stretch of road whose top is higher than `min_height` m.

    s, d, above, ground : (N,) m, stations and offsets of points beyond the carriageway's edge, heights above the ground, and local z of it
    slices : (first, last + 1) numbers of the slices
    sight : (N,) m that the line of sight to a point rises for each m across towards the road
    """
    if not len(s):
        return Uprights.none()
    i = np.floor(s / UPRIGHT_SLICE).astype(np.int64) - slices[0]
    u = side * d
    origin = np.floor(u.min() / UPRIGHT_CELL) * UPRIGHT_CELL
    j = np.floor((u - origin) / UPRIGHT_CELL).astype(np.int64)
    above = np.where(np.isfinite(above), above, -1.0)  # where no ground is known nothing stands on it
    k = np.floor(above / HEIGHT_BIN).astype(np.int64)
    rows, columns = slices[1] - slices[0], int(j.max()) + 1
    inside = (i >= 0) & (i < rows)
    low = inside & (k >= FIRST_BIN) & (k < LOW_BINS)
    occupied = np.zeros((rows, columns + 2 * REACH_CELLS, LOW_BINS), bool)
    occupied[i[low], j[low] + REACH_CELLS, k[low]] = True
    near = np.any([occupied[:, lag:lag + columns] for lag in range(2 * REACH_CELLS + 1)], axis=0)
    count, highest = near.sum(axis=2), LOW_BINS - np.argmax(near[:, :, ::-1], axis=2)
    score = np.where((count >= MIN_BINS) & (highest * HEIGHT_BIN > min_height), count, 0)
    # the densest of neighbours stands for all; of equals the nearest to the road
    order = score * 1000.0 - np.arange(columns)
    peak = score > 0
    for lag in range(1, BODY_CELLS + 1):
        peak[:, lag:] &= order[:, lag:] > order[:, :-lag]
        peak[:, :-lag] &= order[:, :-lag] > order[:, lag:]
    peaks = np.argwhere(peak)
    if not len(peaks):
        return Uprights.none()
    owner = np.full((rows, columns), -1)
    for lag in sorted(range(-BODY_CELLS, BODY_CELLS + 1), key=abs, reverse=True):
        column = peaks[:, 1] + lag
        fits = (column >= 0) & (column < columns)
        owner[peaks[fits, 0], column[fits]] = np.flatnonzero(fits)
    body = np.flatnonzero(inside & (above >= FIRST_BIN * HEIGHT_BIN))
    upright = owner[i[body], j[body]]
    body, upright = body[upright >= 0], upright[upright >= 0]
    if not len(body):
        return Uprights.none()
    return _described(peaks, upright, u[body], above[body], (i[inside], u[inside], above[inside], ground[inside], sight[inside]), slices[0], side)


def _described(at, upright, u, above, everything, first, side):
    """Uprights at (slice, cell), with `upright` the upright that every point of a body belongs to."""
    n = len(at)
    order = np.lexsort((above, upright))
    upright, u, above = upright[order], u[order], above[order]
    tops = _contiguous_top(upright, above, n)
    # what hangs over it is no part of it
    part = above <= tops[upright] + 1e-6
    upright, u, above = upright[part], u[part], above[part]
    count = np.bincount(upright, minlength=n)
    filled = count > 0
    at, tops, count = at[filled], tops[filled], count[filled]
    upright, n = (np.cumsum(filled) - 1)[upright], len(at)
    start = np.cumsum(count) - count
    down = np.maximum((tops[upright] - above) / TOP_BIN, 0.0).astype(np.int64)
    high = down < TOP_BINS
    below_top = np.bincount(upright[high] * TOP_BINS + down[high], minlength=n * TOP_BINS).reshape(n, TOP_BINS).astype(float)
    foot = above[start]
    # the face alone tells how it stands: of a low wall most points lie on its top
    face = tops[upright] - above > UPPER_SIDE
    face |= (np.bincount(upright[face], minlength=n) < MIN_FACE_POINTS)[upright]
    upright, u, above = upright[face], u[face], above[face]
    on_face = np.bincount(upright, minlength=n)
    start = np.cumsum(on_face) - on_face
    by_u = np.lexsort((u, upright))
    ordered = u[by_u]
    nearest, middle, farthest = (ordered[start + np.rint(share * (on_face - 1)).astype(np.int64)] for share in (0.1, 0.5, 0.9))
    mean_u, mean_h = (np.bincount(upright, values, n) / on_face for values in (u, above))
    du, dh = u - mean_u[upright], above - mean_h[upright]
    batter = np.bincount(upright, du * dh, n) / np.maximum(np.bincount(upright, dh * dh, n), 1e-6)
    i, all_u, all_above, all_ground, all_sight = everything
    # of the point next beyond the face of each
    key = i * 1e4 + all_u
    order = np.argsort(key, kind="stable")
    ground = all_ground[order[np.clip(np.searchsorted(key[order], at[:, 0] * 1e4 + middle), 0, len(key) - 1)]]
    behind = _behind(at, middle, ground + tops, i, all_u, all_above + all_ground, all_sight)
    return Uprights(at[:, 0] + first, side * middle, ground, tops, foot, below_top, farthest - nearest, batter, count.astype(float), behind,
                    np.zeros(n, bool), _rough(upright, u, n))


def _rough(upright, u, n):
    """(N,) m: median step across from one point of an upright to the next higher one; points in order of their owner and height."""
    step, owner = np.abs(np.diff(u)), upright[1:]
    same = np.diff(upright) == 0
    step, owner = step[same], owner[same]
    order = np.lexsort((step, owner))
    count = np.bincount(owner, minlength=n)
    middle = np.cumsum(count) - count + count // 2
    return np.where(count > 0, step[order][np.minimum(middle, max(len(step) - 1, 0))], 0.0) if len(step) else np.zeros(n)


def _contiguous_top(upright, above, n):
    """(N,) m: the top of what rises from the ground without a gap: of windows in what is tall, of a beam's height in what is not."""
    levels = int(np.floor(above.max() / TALL_BIN)) + 2 + MAX_TALL_GAP
    filled = np.zeros((n, levels), bool)
    filled[upright, np.floor(above / TALL_BIN).astype(np.int64)] = True
    filled[:, :1 + MAX_LOW_GAP] = True
    low_end, end = (_first_gap(filled, gap) for gap in (MAX_LOW_GAP, MAX_TALL_GAP))
    end = np.where(low_end * TALL_BIN < TALL, low_end, end) * TALL_BIN
    part = above < end[upright]
    upright, above = upright[part], above[part]
    if not len(above):
        return np.full(n, FIRST_BIN * HEIGHT_BIN)
    count = np.bincount(upright, minlength=n)
    start = np.cumsum(count) - count
    return np.where(count > 0, above[np.minimum(start + np.floor(TOP_SHARE * np.maximum(count - 1, 0)).astype(np.int64), len(above) - 1)],
                    FIRST_BIN * HEIGHT_BIN)


def _first_gap(filled, gap):
    """(N,) the first level from which more than `gap` levels are empty."""
    levels = filled.shape[1]
    empty = np.stack([~filled[:, lag:levels - gap + lag] for lag in range(gap + 1)]).all(axis=0)
    return np.where(empty.any(axis=1), np.argmax(empty, axis=1), levels)


def _behind(at, middle, tops, i, u, z, sight):
    """(N,) points seen behind uprights, below the line of sight over their tops; tops and points have local z, for the ground behind may lie
    higher or lower."""
    order = np.lexsort((u, i))
    i, u, z, sight = i[order], u[order], z[order], sight[order]
    key = i * 1e4 + u
    first = np.searchsorted(key, at[:, 0] * 1e4 + middle + BEHIND[0])
    last = np.searchsorted(key, at[:, 0] * 1e4 + middle + BEHIND[1])
    count = np.maximum(last - first, 0)
    owner = np.repeat(np.arange(len(at)), count)
    index = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + np.repeat(first, count)
    passed = z[index] + sight[index] * (u[index] - middle[owner])   # where the pulse passed the upright
    through = (passed < tops[owner] - SIGHT_MARGIN) & (z[index] < tops[owner] - TOP_DEPTH)
    return np.bincount(owner[through], minlength=len(at)).astype(float)


# Single uprights: poles, signs and trunks.

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
    """One upright thing."""

    kind: str   # pole, sign or trunk
    s: float   # s, d, z: m, station and offset of its middle, local z of the ground
    d: float
    z: float
    diameter: float   # diameter, height: m
    height: float


def find_poles(s: np.ndarray, d: np.ndarray, above: np.ndarray, ground: np.ndarray, stretch: tuple[float, float], min_height: float) -> list[Pole]:
    """Poles, signs and trunks, at least `min_height` m high, of a stretch of road, from points beside it with a margin before and after.

    s, d, above, ground : (N,) m, stations, offsets, heights above the ground, and local z of it
    stretch : stations (m) between which the middle of a pole must lie: a pole belongs to one stretch
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
    poles = []
    for number, box in enumerate(ndimage.find_objects(label), 1):
        size = [(side.stop - side.start) * POLE_CELL for side in box]
        if max(size) > MAX_FOOTPRINT or filled[box][label[box] == number].any(axis=0).mean() < MIN_SHAFT_FILLED:
            continue
        rows = low[(label[i, j] == number)]
        pole = _pole(rows, s, d, above, ground, min_height)
        if pole is not None and stretch[0] <= pole.s < stretch[1]:
            poles.append(pole)
    return poles


def _pole(rows, s, d, above, ground, min_height):
    """The Pole of a shaft's points; None where it is none."""
    foot = float(above[rows].min())
    rows = rows[_narrow(s[rows], d[rows], above[rows])]
    if len(rows) < MIN_POLE_POINTS:
        return None
    stands = float(above[rows].min()) < foot + POLE_BIN
    shaft = np.c_[s[rows], d[rows]]
    centre, radius = _circle(shaft)
    miss = np.abs(np.hypot(*(shaft - centre).T) - radius)
    if np.median(miss) > MAX_CIRCLE_MISS or 2 * radius > MAX_FOOTPRINT:
        return None
    near = np.flatnonzero((np.abs(s - centre[0]) < HEAD_REACH) & (np.abs(d - centre[1]) < HEAD_REACH))
    ring = np.hypot(s[near] - centre[0], d[near] - centre[1])
    height = _top(above[near][ring < max(2 * radius, 0.25)])
    # people are slender at the head alone
    if height < max(min_height, SLENDER * 2 * radius) or height < AS_LOW_AS_CARS and not stands:
        return None
    around = (above[near] > SHAFT[0]) & (above[near] < height) & (ring > radius + FREE_ABOUT[0]) & (ring < radius + FREE_ABOUT[1])
    if height < AS_LOW_AS_CARS and around.sum() > MAX_BESIDE * len(rows):
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
    half = int(np.ceil(radius / HEAD_CELL))
    filled[middle - half:middle + half + 1, middle - half:middle + half + 1] = True
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


# The ground beside the road: what is left when everything that stands on it is taken away; what the scanners saw of it, and gutters.

GROUND_SLICE, GROUND_CELL = 1.0, 0.20   # m along and across
STANDING_WIDTH = 2.5      # m: narrower humps of the lowest layer stand on the ground (parked cars, hedges)
GROUND_SHARE = 0.1        # quantile of the lowest layer: at the foot of a wall it reaches up the face
GROUND_JUMP = 0.10        # m of height between two layers
MIN_GROUND_POINTS = 3     # of a lowest layer, with those as high in the slices before and after it
UNSEEN_REACH = 1.0        # m across a gap in the ground that is bridged
FOOT_REACH = 0.4          # m across from a face, within which the ground lies at its foot
SHADOW_SLICES = 3          # slices along within which the foot of a face is seen that a shadow hides
RIM_STEP = 0.3            # m of height within a cell from which it holds a face; between neighbouring cells, from which the higher one stands on the
#                           ground, where nothing was seen beyond it


@dataclass(frozen=True)
class _LocalGround:
    """Heights of the ground in cells of a stretch of road."""

    start: float   # start, origin: m, station and offset of the corner
    origin: float
    height: np.ndarray   # (I, J) m above the line that the points' heights count from; NaN where the ground is not known

    def at(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) heights of the ground at (N,) stations and offsets; NaN where it is not known."""
        i = np.clip(np.floor((s - self.start) / GROUND_SLICE).astype(np.int64), 0, self.height.shape[0] - 1)
        column = np.clip((d - self.origin) / GROUND_CELL - 0.5, 0.0, self.height.shape[1] - 1.0)
        j = np.minimum(column.astype(np.int64), self.height.shape[1] - 2)
        low, high = self.height[i, j], self.height[i, j + 1]
        between = low + (column - j) * (high - low)
        return np.where(np.isfinite(between), between, np.where(np.isfinite(low), low, high))


def local_ground(s: np.ndarray, d: np.ndarray, h: np.ndarray, start: float, slices: int) -> _LocalGround:
    """The ground under points, (N,) m stations, offsets and heights above the expected road, in so many slices from a station on."""
    origin = float(np.floor(d.min() / GROUND_CELL) * GROUND_CELL)   # the border of a cell, so that cells are the same wherever one looks from
    columns = max(int(np.ceil((float(d.max()) + 1e-3 - origin) / GROUND_CELL)), 2)
    i, j = np.floor((s - start) / GROUND_SLICE).astype(np.int64), np.floor((d - origin) / GROUND_CELL).astype(np.int64)
    inside = np.flatnonzero((i >= 0) & (i < slices) & (j >= 0) & (j < columns))
    cell, h = (i * columns + j)[inside], h[inside]
    order = order_by(np.rint((h + 100.0) * 1e3).astype(np.int32), cell)
    cell, h = cell[order], h[order]
    _, first, count = lowest_layers(cell, h, GROUND_JUMP)
    solid = _supported(cell[first], h[first], count, (slices, columns))
    first, count = first[solid], count[solid]
    low, least = np.full((2, slices, columns), np.nan)
    low.flat[cell[first]] = h[first + np.rint(GROUND_SHARE * (count - 1)).astype(np.int64)]
    least.flat[cell[first]] = h[first + np.minimum(count, MIN_GROUND_POINTS) - 1]
    face = np.zeros((slices, columns), bool)
    face.flat[cell[first]] = h[first + count - 1] - h[first] > RIM_STEP
    # the foot of a face is no higher than the ground beside it
    feet = np.where(face, np.fmin(low, _continued(np.where(face, np.nan, low), FOOT_REACH)), low)
    low = _feet_in_shadow(feet, least)
    filled = _filled(low)
    low = _let_down(filled, _rims(low) | _rims(filled))
    finite = np.isfinite(low)
    if not finite.any():
        return _LocalGround(start, origin, low)
    # beyond what is known the ground neither rises nor falls
    level = np.where(finite, low, np.inf)
    cells = int(round(STANDING_WIDTH / GROUND_CELL)) | 1
    smooth = median_filter(np.where(finite, level, 1e3), size=(3, 1), mode="nearest")
    opened = grey_opening(np.where(smooth > 500.0, level.clip(max=1e3), smooth), size=(1, cells), mode="nearest")
    ground = np.where(finite & (opened < 500.0), opened, np.nan)
    return _LocalGround(start, origin, _let_down(ground, smooth - ground > RIM_STEP))


def _supported(place, height, count, shape):
    """(L,) bool, which lowest layers have enough points together with those of the slices before and after at their height."""
    number, lowest = np.zeros(shape), np.full(shape, np.nan)
    number.flat[place], lowest.flat[place] = count, height
    number, lowest = np.pad(number, ((1, 1), (0, 0))), np.pad(lowest, ((1, 1), (0, 0)), constant_values=np.nan)
    support = number[1:-1].copy()
    for neighbour in (slice(None, -2), slice(2, None)):
        support += np.where(np.abs(lowest[neighbour] - lowest[1:-1]) < GROUND_JUMP, number[neighbour], 0.0)
    return support.flat[place] >= MIN_GROUND_POINTS


def _feet_in_shadow(low, least):
    """Heights where the foot of a face that a shadow hides, as of a parked car, is the least that nearby slices see of it."""
    padded = np.pad(low, ((0, 0), (1, 1)), constant_values=np.nan)
    right, left = padded[:, :-2], padded[:, 2:]
    shadowed = np.isnan(right) & ~(left - low < RIM_STEP) | np.isnan(left) & ~(right - low < RIM_STEP)
    lowest = np.where(np.isnan(low), np.inf, np.where(shadowed, least, low))
    foot = minimum_filter1d(lowest, 2 * SHADOW_SLICES + 1, axis=0, mode="constant", cval=np.inf)
    return np.where(shadowed & (low - foot > GROUND_JUMP), foot, low)


def _filled(low):
    """Gaps across of up to UNSEEN_REACH to either side take the lower of their two ends."""
    left, right = low.copy(), low.copy()
    for _ in range(int(round(UNSEEN_REACH / GROUND_CELL))):
        left[:, 1:] = np.where(np.isnan(left[:, 1:]), left[:, :-1], left[:, 1:])
        right[:, :-1] = np.where(np.isnan(right[:, :-1]), right[:, 1:], right[:, :-1])
    return np.where(np.isnan(low), np.fmin(left, right), low)


def _let_down(low, standing):
    """Heights where what stands has that of the ground beside it; the cells beside it may hold the foot of its face, and are let down too."""
    padded = np.pad(standing, ((0, 0), (1, 1)))
    standing = (standing | padded[:, :-2] | padded[:, 2:]) & np.isfinite(low)
    return np.where(standing, _continued(np.where(standing, np.nan, low), STANDING_WIDTH), low)


def _continued(low, reach):
    """Gaps across take the height of the nearest cell within `reach` (m), of two as near the lower one."""
    low = low.copy()
    for _ in range(int(round(reach / GROUND_CELL))):
        padded = np.pad(low, ((0, 0), (1, 1)), constant_values=np.nan)
        low = np.where(np.isnan(low), np.fmin(padded[:, :-2], padded[:, 2:]), low)
    return low


def _rims(low):
    """(I, J) narrow tops beyond which nothing was seen, as of a wall that hides what lies behind it."""
    rows, columns = low.shape
    cells = np.column_stack([np.full(rows, np.nan), low]).ravel()   # a gap between the rows
    finite = np.isfinite(cells)
    step = np.diff(cells, append=np.nan)
    breaks = ~(np.abs(step) < RIM_STEP)          # after a cell: a step, or nothing known on one side
    up, down = step >= RIM_STEP, step <= -RIM_STEP
    group = np.cumsum(np.r_[True, breaks[:-1]]) - 1
    first = np.flatnonzero(np.r_[True, breaks[:-1]])
    last = np.r_[first[1:] - 1, len(cells) - 1]
    unseen = ~finite
    before, after = np.maximum(first - 1, 0), np.minimum(last + 1, len(cells) - 1)
    rim = up[before] & unseen[after] | down[last] & unseen[before]
    standing = rim & finite[first] & ((last - first + 1) * GROUND_CELL < STANDING_WIDTH)
    return standing[group].reshape(rows, columns + 1)[:, 1:]


# What the scanners could see: lines of sight, and whether their view ends a little above and below the horizon, as that of a many-beam head does.

VIEW_SAMPLE_LENGTH, VIEW_SAMPLES = 4.0, 25   # m of road, and number, of the windows of each road in which the highest view is looked for
LEAST_RANGE = 3.0          # m from the scanner: nearer, a centimetre turns the line of sight too much
HIGHEST_SHARE = 0.999      # of the lines of sight by their slope: single points astray lie above, and as few below the steepest
LEVEL_VIEW = 0.10          # m per m: heads of many beams see up to 0.03 (+2 degrees, Velodyne HDL-64E), and the vehicle tilts; mirrors see all round
STEEPEST_VIEW = 0.70       # m per m down: such heads see 0.46 (-25 degrees) or 0.58 (-30), mirrors 0.9 and more beside the vehicle


def lines_of_sight(survey: Survey, road: int, number: int, s: np.ndarray, d: np.ndarray, h: np.ndarray,
                   time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(2, N) m ahead and left along a road from points of a pass to the scanner, and (N,) m how much higher the scanner is.

    s, d, h : (N,) m, station, offset, and height above the road; time : (N,) s
    """
    driven, line = survey.frame.passes[number], survey.frame.road(road)
    x, y = line.to_map(s, d)
    eye_x, eye_y = driven.at(time, "x", "y") if survey.frame.has_time else line.to_map(s, driven.at_station(s)[0])
    heading = line.heading(s)
    ahead, left = np.cos(heading), np.sin(heading)
    dx, dy = eye_x - x, eye_y - y
    return np.stack([dx * ahead + dy * left, dy * ahead - dx * left]), survey.sensor_height.get(number, READING.default_sensor_height) - h


def level_views(survey: Survey) -> dict[int, float]:
    """The passes whose scanner sees hardly higher than it rides, so that it does not show how high anything is that is as high.

    In open country nothing stands that a mirror could see above it. That its view ends is told by the ground beside the vehicle, which only a
    mirror sees; without times, which tell where the scanner was, nothing high is taken for a view that ends.
    Returns {number of the pass: m above the road, height of its scanner}.
    """
    slopes: dict[int, list[np.ndarray]] = {}
    far: dict[int, list[np.ndarray]] = {}
    for road in survey.store.roads():
        first, last = survey.store.span(road)
        for start in np.linspace(first, max(last - VIEW_SAMPLE_LENGTH, first), VIEW_SAMPLES):
            points = survey.window(road, start, start + VIEW_SAMPLE_LENGTH)
            h = points.z - survey.road_height(road, points.s)
            for number in np.unique(points.pass_number).tolist():
                rows = points.pass_number == number
                across, up = lines_of_sight(survey, road, number, points.s[rows], points.d[rows], h[rows], points.time[rows])
                distance = np.hypot(*across)
                slope = -up / np.maximum(distance, 1e-3)
                slopes.setdefault(number, []).append(slope)
                far.setdefault(number, []).append(slope[distance > LEAST_RANGE])
    return {number: float(survey.sensor_height.get(number, READING.default_sensor_height)) for number in slopes if _is_level(
        np.concatenate(far[number]), np.concatenate(slopes[number]), survey.frame.has_time)}


def _is_level(far, all_slopes, has_time):
    """Whether slopes of lines of sight to what is far, and to everything, end a little above and below the horizon."""
    if not len(far) or np.quantile(far, HIGHEST_SHARE) >= LEVEL_VIEW:
        return False
    return not has_time or np.quantile(all_slopes, 1.0 - HIGHEST_SHARE) > -STEEPEST_VIEW


# Gutters: the lines of lowest points beside the carriageway's edge, where water runs.

GUTTER_INSIDE, GUTTER_OUTSIDE = 0.80, 0.15  # m from the edge, within which the lowest point is looked for
OUTER_RISE, OUTER_REACH = 0.02, 0.40        # m that the ground rises outward of a gutter, and within how many
INNER_RISE, INNER_REACH = 0.008, 0.50       # m that the road rises inward of it: 1.6 % fall towards the gutter
READ_BEYOND = 0.60                          # m beyond the edge that are read


def find_gutters(survey: Survey, road: int, start: float, slices: int, side: int, edge: Callable[[np.ndarray], np.ndarray]) -> Uprights:
    """The lowest points of one side (1 left, -1 right) of so many slices of a road from a station on, where water runs along its edge.

    edge : function of stations that gives the offset of the edge of that side
    Returns Uprights whose `top` is how deep the gutter lies below its outer side; one for each UPRIGHT_SLICE
    """
    s = start + (np.arange(slices) + 0.5) * SLICE_LENGTH
    edges = edge(s)
    ends = np.array([edges - side * (GUTTER_INSIDE + INNER_REACH), edges + side * READ_BEYOND])
    grid = surface_grid(survey, road, start, slices, (float(np.floor(ends.min() / CROSS_CELL) * CROSS_CELL), float(ends.max())))
    if not len(grid.groups):
        return Uprights.none()
    # of all passes and scanners together, by their numbers of points
    count = np.where(np.isfinite(grid.height), grid.count, 0)
    total, n = (np.nan_to_num(grid.height) * count).sum(axis=0), count.sum(axis=0)
    profile = smoothed(np.where(n > 0, total / np.maximum(n, 1), np.nan))
    gutters, columns, depth = lowest_along(profile, side * (grid.d - edges[:, None]))
    # a slice of the surface holds several of those along which lines are followed
    times = int(round(SLICE_LENGTH / UPRIGHT_SLICE))
    gutters = np.repeat(gutters, times)
    number = np.floor(s[gutters] / SLICE_LENGTH).astype(np.int64) * times + np.tile(np.arange(times), len(gutters) // times)
    zero = np.zeros(len(gutters))
    columns, depth = np.repeat(columns, times), np.repeat(depth, times)
    return Uprights(number, grid.d[columns], profile[gutters, columns] + grid.line(s[gutters]), depth, zero,
                    np.zeros((len(gutters), TOP_BINS)), zero, zero, zero + 1.0, zero, zero > 0, zero)


def lowest_along(profile: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where water runs along an edge: the lowest place of a profile beside it, from which the ground rises to both sides.

    profile : (I, J) m, heights of the ground; NaN where it was not seen
    u : (I, J) m, places of the cells outward of the edge
    Returns rows and columns of such places, and by how many m the ground rises outward of them, (N,) each
    """
    searched = (u > -GUTTER_INSIDE) & (u < GUTTER_OUTSIDE) & np.isfinite(profile)
    lowest = np.where(searched, profile, np.inf)
    j = np.argmin(lowest, axis=1)
    rows = np.arange(len(profile))
    low, offset = lowest[rows, j], u[rows, j]
    beyond = u - offset[:, None]
    outer, inner = (np.where((beyond * way > 0) & (beyond * way < reach) & np.isfinite(profile), profile, -np.inf).max(axis=1)
                    for way, reach in ((1, OUTER_REACH), (-1, INNER_REACH)))
    # water stays where the ground rises outward from the lowest point on: a verge that falls on is none
    falls_on = np.where((beyond > 0) & (beyond < OUTER_REACH) & np.isfinite(profile), profile, np.inf).min(axis=1) < low
    gutters = np.flatnonzero(np.isfinite(low) & (outer - low > OUTER_RISE) & (inner - low > INNER_RISE) & ~falls_on)
    return gutters, j[gutters], (outer - low)[gutters]
