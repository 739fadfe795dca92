"""Bottom corners of curbs, measured from the points about a rising cell.

The corner is where the line of the road meets the line of the face. Road, face and the raised ground behind are separated by their height above the
line of the road, so the corner does not depend on the grid of the cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from ...common.arrays import Rows
from ..weights import CURBS
from .pseudo_scanlines import TOP_QUANTILE_SIGMAS, PseudoScanLines, expand_ranges

MIN_BED_SLOPE = np.tan(np.radians(CURBS.least_slope))  # rise over run of plants or a wall right behind a curb; flatter ground is a ramp,


@dataclass
class CurbSteps(Rows):
    """Bottom corners found on profiles, one entry each."""

    PARTS: ClassVar[tuple[tuple[str, str, str], ...]] = (("bottom", "u", "h"),)   # of a curb that each shows, and their offsets and heights

    profile: np.ndarray   # (M,) number of the profile
    s: np.ndarray   # s, u, h: (M,) m, station, outward offset, and height above the expected road of the bottom corner
    u: np.ndarray
    h: np.ndarray
    skew: np.ndarray   # (M,) m outward per m along, direction of the face
    height: np.ndarray   # (M,) m of the step
    run: np.ndarray   # (M,) m across of the face, less what noise adds
    noise: np.ndarray   # (M,) m, scatter of heights about the line of the road side
    scanner_noise: np.ndarray   # (M,) m, the scanner's own noise there
    support: np.ndarray   # (M,) points of road side and face; those that several profiles use count by their share
    behind: np.ndarray   # (M,) points of the raised ground
    hidden: np.ndarray   # (M,) m, one sigma of the foot of a face that no point shows; 0 where one does

    @property
    def upright(self) -> np.ndarray:
        """(M,) bool, is the face as steep as is usual? Only some methods look for others."""
        return np.ones(len(self), bool)


def measure_corners(lines: PseudoScanLines, rows: np.ndarray, cells: np.ndarray, min_height: float, max_height: float,
                    least_evidence: float = -np.inf) -> CurbSteps:
    """The step at each rising cell, where it proves to be one.

    rows, cells : (M,) profiles and cells in which the ground rises
    min_height, max_height : m, of a step
    least_evidence : nats of `_step_evidence` that a step must have where few points show it

    Returns CurbSteps, at most M, in the order of the cells
    """
    cell_count = lines.shape[1]
    reach = int(round(max(CURBS.road_side_length + CURBS.face_margin, CURBS.behind_length) / lines.spacing)) + 2
    start = lines.starts[rows * cell_count + np.maximum(cells - reach, 0)]
    end = lines.starts[rows * cell_count + np.minimum(cells + reach + 1, cell_count)]
    owner, index = expand_ranges(start, end)
    ground = lines.ground.take(index)
    if not ground.all():
        ground = np.flatnonzero(ground)
        owner, index = owner.take(ground), index.take(ground)
    best, everywhere = _measure(lines, rows, cells, owner, index, min_height, max_height), (owner, index)
    # positions that drifted between one view and the next blur a face that each view shows sharply: what is no
    # step in all points together may be one in the points seen from one side of the vehicle
    ahead = lines.along.take(lines.point.take(index)) > 0
    ahead_of, count = np.bincount(owner, ahead, len(rows)), np.bincount(owner, minlength=len(rows))
    mixed = np.minimum(ahead_of, count - ahead_of) >= CURBS.min_view_points
    remeasured = np.flatnonzero(best["likely"] & ~best["good"] & mixed)
    if len(remeasured):
        number = np.full(len(rows), -1)
        number[remeasured] = np.arange(len(remeasured))
        members = np.flatnonzero(number.take(owner) >= 0)
        owner, index, ahead = number.take(owner.take(members)), index.take(members), ahead.take(members)
        views = [_measure(lines, rows[remeasured], cells[remeasured], owner[view], index[view], min_height, max_height) for view in (~ahead, ahead)]
        support = [np.where(view["good"], view["support"], 0) for view in views]
        for view, better in zip(views, (support[0] >= support[1], support[0] < support[1])):
            better &= view["good"]
            for name, values in view.items():
                best[name][remeasured[better]] = values[better]
    good = best["good"]
    if least_evidence > 0.0:
        owner, index = (v[good.take(everywhere[0])] for v in everywhere)
        point = lines.point.take(index)
        s = lines.s.take(point) - best["s"].take(owner)
        good = good & (_step_evidence(owner, lines.u.take(point) - best["u"].take(owner) - best["skew"].take(owner) * s, s, lines.h.take(index),
                                     lines.noise[rows]) >= least_evidence)
    return CurbSteps(profile=lines.first + rows[good], scanner_noise=lines.noise[rows[good]],
                     **{name: values[good] for name, values in best.items() if name not in ("good", "likely")})


def _step_evidence(owner: np.ndarray, u: np.ndarray, s: np.ndarray, h: np.ndarray, scanner_noise: np.ndarray) -> np.ndarray:
    """(M,) nats by which a step explains the heights about each of M places better than ground that bends there or ramps up.

    Each is added to a plane that goes on across the place; what it leaves counts in units of that and the scanner's noise.

    owner : (N,) place of every point
    u, s, h : (N,) m, offset outward from the face, along its direction, distance along, and height
    scanner_noise : (M,) m
    """
    kept = np.flatnonzero((np.abs(u) > CURBS.face_margin) & (u > -CURBS.road_side_length - CURBS.face_margin) & (u < CURBS.behind_length))
    owner, u, s, h = (v.take(kept) for v in (owner, u, s, h))
    terms = h, np.ones(len(h)), u, s, u > 0.0, np.maximum(u, 0.0), np.clip(u / CURBS.behind_length + 0.5, 0.0, 1.0)
    moments = np.array([[np.bincount(owner, one * other, len(scanner_noise)) for other in terms] for one in terms])
    n = np.maximum(moments[1, 1], 1.0)
    for k in (1, 2, 3):   # what the plane explains is taken out of the others
        moments = moments - moments[:, k, None] * moments[k] / np.maximum(moments[k, k], 1e-9)
    squares = np.maximum(moments[0, 0] - moments[0, 4:] ** 2 / np.maximum(np.einsum("kkm->km", moments)[4:], 1e-9), 0.0) + n * scanner_noise ** 2
    return 0.5 * np.maximum(n - 4.0, 0.0) * np.log(squares[1:].min(0) / squares[0])


def _measure(lines, rows, cells, owner, index, min_height, max_height):
    """`StepPatches.corners` of rising cells, as stations and offsets; the points `index` belong to the cells `owner`."""
    edge, middle = lines.offset(cells), (lines.first + rows + 0.5) * lines.width
    point = lines.point.take(index)
    patches = StepPatches(owner, lines.u.take(point) - edge.take(owner), lines.s.take(point) - middle.take(owner), lines.h.take(index),
                          lines.noise[rows], min_height, max_height, unplaced=not lines.along.any())
    corners = patches.corners()
    skewed = np.flatnonzero(np.abs(corners["skew"]) > CURBS.remeasure_skew)
    if len(skewed):
        remeasured = patches.straightened(skewed, corners["skew"][skewed]).corners()
        remeasured["skew"] = remeasured["skew"] + corners["skew"][skewed]
        for name, values in remeasured.items():
            corners[name][skewed] = values
    corners["u"] = corners["u"] + edge
    corners["s"] = corners["s"] + middle
    return corners


class StepPatches:
    """Ground points about M candidate steps, in coordinates outward and along from each candidate's place.

    owner : (N,) candidate of every point
    u, s, h : (N,) m, offset outward, distance along, and height
    scanner_noise : (M,) m
    min_height, max_height : m, of a step
    skew : (M,) m outward per m along that was taken out of the offsets, or 0
    graded : may the road rise along the curb? Points of few scan lines do not tell such a grade from a slope
    unplaced : is it unknown from where the points were measured? From the road every face is seen, from the sidewalk it looks away
    """

    def __init__(self, owner: np.ndarray, u: np.ndarray, s: np.ndarray, h: np.ndarray, scanner_noise: np.ndarray,
                 min_height: float, max_height: float, skew: np.ndarray | float = 0.0, graded: bool = False, unplaced: bool = False):
        self.owner, self.u, self.s, self.h = owner, u, s, h
        self.scanner_noise, self.min_height, self.max_height = scanner_noise, min_height, max_height
        self.count, self.skew, self.graded, self.unplaced = len(scanner_noise), skew, graded, unplaced

    def straightened(self, which: np.ndarray, skew: np.ndarray) -> StepPatches:
        """The candidates `which`, (K,) indices, with the direction of each face, (K,) m outward per m along, taken out of the offsets."""
        number = np.full(self.count, -1)
        number[which] = np.arange(len(which))
        members = np.flatnonzero(number[self.owner] >= 0)
        owner = number[self.owner[members]]
        return StepPatches(owner, self.u[members] - skew[owner] * self.s[members], self.s[members], self.h[members], self.scanner_noise[which],
                           self.min_height, self.max_height, skew, self.graded, self.unplaced)

    def corners(self) -> dict[str, np.ndarray]:
        """The corner of every candidate.

        Returns dict of (M,) arrays: the attributes of CurbSteps except `profile` and `scanner_noise`; `good` : bool, is it a step?; `likely` : bool,
        may it be one in another direction or view?
        """
        owner, u, s, h, count = self.owner, self.u, self.s, self.h, self.count
        road = np.flatnonzero((u < -CURBS.face_margin) & (u > -CURBS.road_side_length - CURBS.face_margin))
        grade = self._grade(road)
        if self.graded:
            h = h - grade.take(owner) * s
        side = owner.take(road), u.take(road), h.take(road)
        level, slope, noise, n_road = _line_per_owner(*side, count)
        off = np.abs(side[2] - level.take(side[0]) - slope.take(side[0]) * side[1])
        keep = np.flatnonzero(off < np.maximum(2.5 * noise, 0.01).take(side[0]))
        level, slope, noise, n_road = _line_per_owner(side[0].take(keep), side[1].take(keep), side[2].take(keep), count)
        rise = h - level.take(owner) - slope.take(owner) * u
        height, n_behind, stays = self._raised_ground(rise)
        ground = dict(level=level, slope=slope, grade=grade, noise=noise, n_road=n_road, height=height, n_behind=n_behind, stays=stays)
        # most candidates are no step in any direction: their faces need no measurement
        likely = (n_road >= 4) & (height >= np.maximum(CURBS.candidate_height_share * self.min_height,
                                                       CURBS.candidate_sigma_share * CURBS.min_step_sigmas * noise)) \
            & (np.abs(slope) <= CURBS.max_road_slope / CURBS.candidate_height_share)
        candidates = np.flatnonzero(likely)
        number = np.full(count, -1)
        number[candidates] = np.arange(len(candidates))
        members = np.flatnonzero((np.abs(u) < CURBS.face_search_half_width) & (number.take(owner) >= 0))
        skew = self.skew if isinstance(self.skew, float) else self.skew[candidates]
        near = StepPatches(number.take(owner.take(members)), u.take(members), s.take(members), h.take(members), self.scanner_noise[candidates],
                           self.min_height, self.max_height, skew, self.graded, self.unplaced)
        result = dict(likely=likely)
        for name, values in near._faces(rise.take(members), **{name: values[candidates] for name, values in ground.items()}).items():
            result[name] = np.zeros(count, values.dtype)
            result[name][candidates] = values
        return result

    def _grade(self, road):
        """(M,) m per m along the curb, of the plane through the points `road` of each candidate; 0 where that is not wanted.

        At a corner the crossfall of one street is a grade along the curb of the other. The estimate is by ridge regression, close to 0
        where the points, as those of a single scan line, do not tell it from the slope across.
        """
        if not self.graded:
            return np.zeros(self.count)
        owner, (u, s, h) = self.owner.take(road), (v.take(road) for v in (self.u, self.s, self.h))
        n = np.maximum(np.bincount(owner, minlength=self.count), 1)

        def moment(a, b):
            return np.bincount(owner, a * b, self.count) - np.bincount(owner, a, self.count) * np.bincount(owner, b, self.count) / n

        uu, us, ss, uh, sh = (moment(a, b) for a, b in ((u, u), (u, s), (s, s), (u, h), (s, h)))
        # points that all lie at one offset do not give a slope
        share = np.where(uu > n * 0.03**2, us / np.maximum(uu, 1e-12), 0.0)
        return (sh - share * uh) / (np.maximum(ss - share * us, 0.0) + CURBS.grade_prior)

    def _faces(self, rise, level, slope, grade, noise, n_road, height, n_behind, stays):
        """What `corners` returns, for candidates whose road side and height are known; `rise` : (N,) m of the points above the road."""
        owner, u, s, count = self.owner, self.u, self.s, self.count
        scatter = np.maximum(noise, self.scanner_noise)
        # the part of the height that is surely neither road nor raised ground
        lower = np.minimum(np.maximum(CURBS.face_lower_share * height, 2 * scatter), 0.45 * height)
        upper = np.maximum(np.minimum(CURBS.face_upper_share * height, height - 2 * scatter), 0.55 * height)
        low = rise <= lower.take(owner)
        face = np.flatnonzero((np.abs(u) < CURBS.face_search_half_width) & ~low & (rise < upper.take(owner)))
        owner, u, s, rise = (v.take(face) for v in (owner, u, s, rise))
        skew, straight = _skew(owner, u, s, scatter, count)
        mid, spread = _median_and_spread(owner, straight, count)
        near = np.flatnonzero(np.abs(straight - mid.take(owner)) < 0.05 + 2 * scatter.take(owner))
        owner, u, s, rise = (v.take(near) for v in (owner, u, s, rise))
        skew, straight = _skew(owner, u, s, scatter, count)
        n_face = np.bincount(owner, minlength=count)
        mid, up, station = (_mean(np.bincount(owner, v, count), n_face) for v in (straight, rise, s))
        off = rise - up.take(owner)
        var_up = np.bincount(owner, off ** 2, count)
        lean = np.bincount(owner, (straight - mid.take(owner)) * off, count) / (var_up + n_face * CURBS.face_prior + 1e-9)
        corner = mid - np.clip(lean, -0.2, 0.8) * up
        # half the points of an even face lie within half its run; noise widens that
        share = np.maximum((upper - lower) / np.maximum(height, 1e-3), CURBS.min_face_share)
        run = 2 * np.sqrt(np.maximum(spread**2 - (1.35 * scatter) ** 2, 0.0)) / share
        run = np.where(n_face < 3, 0.0, np.maximum(run - CURBS.face_noise_sigmas * scatter, 0.0))
        good = (np.isfinite(level) & (n_road >= 4) & (height >= self.min_height) & (height <= self.max_height)
                & (height >= CURBS.min_step_sigmas * noise) & (np.abs(slope) <= CURBS.max_road_slope) & stays
                & ((n_face >= 1) | self._hidden_face(low, np.minimum(n_road, n_behind)))
                & (run <= CURBS.max_face_width))
        # derived: a foot that is evenly probable beneath the widest face, from the edge of its top on
        hidden = np.where(n_face < 1, CURBS.max_face_width / np.sqrt(3.0), 0.0)
        return dict(s=station, u=corner + self.skew * station, h=level + slope * corner + grade * station, skew=skew, height=height, run=run,
                    noise=noise, support=n_road + n_face, behind=n_behind, hidden=hidden, good=good)

    def _hidden_face(self, low, beside):
        """(M,) bool, may a face look away from the scanner there, as less of the ground before the rising cell was seen than by chance?

        low : (N,) bool, points of the road; beside : (M,) points on the side that has fewer. Such a face stands beneath the edge of its top
        """
        if not self.unplaced:
            return np.zeros(self.count, bool)
        before = np.flatnonzero(low & (self.u < 0.0))
        gap = np.full(self.count, CURBS.face_search_half_width)
        np.minimum.at(gap, self.owner.take(before), -self.u.take(before))
        return (gap > CURBS.max_face_width) & (gap * beside > CURBS.hidden_face_spacings * CURBS.road_side_length)

    def _raised_ground(self, rise):
        """Height of the ground behind the face, how many points lie there, and whether it stays up and is level or a bed of plants."""
        count = self.count
        beyond = np.flatnonzero((self.u > 0.03) & (self.u < CURBS.behind_length))
        owner, u, rise_beyond = self.owner.take(beyond), self.u.take(beyond), rise.take(beyond)
        raised = np.flatnonzero((rise_beyond > 0.4 * self.min_height) & (rise_beyond < self.max_height + 0.1))
        up, out, to = owner.take(raised), u.take(raised), rise_beyond.take(raised)
        first = _mean(np.bincount(up, to, count), np.bincount(up, minlength=count))
        foot, bank, _, n_raised = _line_per_owner(up, out, to, count)
        alike = np.flatnonzero(np.abs(to - first.take(up)) < 0.05)
        up, out, to = up.take(alike), out.take(alike), to.take(alike)
        # a ramp continues to rise, while the ground behind a curb is as level as a road
        _, climb, _, n_behind = _line_per_owner(up, out, to, count)
        level = (n_behind < 4) | (np.abs(climb) <= CURBS.max_road_slope + CURBS.slope_per_noise * self.scanner_noise)
        peak = np.zeros(count)
        near = np.flatnonzero((self.u > -0.03) & (self.u < CURBS.face_search_half_width) & (n_behind < 2).take(self.owner))
        with np.errstate(invalid="ignore"):  # an unknown rise stays unknown; newer numpy warns about it
            np.maximum.at(peak, self.owner.take(near), rise.take(near))
        height = np.where(n_behind >= 2, _mean(np.bincount(up, to, count), n_behind),
                          np.maximum(peak - TOP_QUANTILE_SIGMAS * self.scanner_noise, 0.0))
        # plants, or a wall, right behind a curb rise from its top: what their slope does not explain is the curb
        bed = ~level & (n_raised >= CURBS.min_bed_points) & (bank > MIN_BED_SLOPE) & (bank <= CURBS.max_bed_slope) & (foot > 0.0)
        height, level = np.where(bed, foot, height), level | bed
        far = np.flatnonzero(u > 0.10)
        low = np.flatnonzero(rise_beyond < 0.5 * height.take(owner))
        low = low[u.take(low) > 0.10]
        low, far = (np.bincount(owner.take(v), minlength=count) for v in (low, far))
        return height, n_behind, level & (low <= np.maximum(CURBS.max_low_share * far, 1))


def _skew(owner, u, s, scatter, count):
    """How far the face turns away from the road's direction, and offsets with that taken out.

    Returns (count,) m outward per m along, close to 0 where there are few points or a
    short stretch, and (N,) m offsets moved along the face to its mean station.
    """
    n = np.bincount(owner, minlength=count)
    mean_s, mean_u = (_mean(np.bincount(owner, v, count), n) for v in (s, u))
    ds, du = s - mean_s.take(owner), u - mean_u.take(owner)
    along = np.bincount(owner, ds ** 2, count)
    skew = np.bincount(owner, ds * du, count) / (along + CURBS.skew_prior + (5 * scatter) ** 2)
    skew = np.minimum(np.maximum(skew, -CURBS.max_face_skew), CURBS.max_face_skew)
    return skew, u - skew.take(owner) * ds


def _median_and_spread(owner, values, count):
    """Median and interquartile range of the values of each owner (0 where it has none)."""
    order = np.lexsort((values, owner))
    values = np.r_[values[order], 0.0]
    n = np.bincount(owner, minlength=count)
    first = np.cumsum(n) - n

    def quantile(q):
        rank = q * np.maximum(n - 1, 0)
        k = np.floor(rank).astype(np.int64)
        low, high = values[first + k], values[np.minimum(first + k + 1, len(values) - 1)]
        return np.where(n > 0, np.where(n > k + 1, low + (rank - k) * (high - low), low), 0.0)

    return quantile(0.5), quantile(0.75) - quantile(0.25)


def _mean(total, count):
    return total / np.maximum(count, 1)


def _line_per_owner(owner, u, h, count):
    """Least-squares line h = level + slope * u for each owner: level, slope, scatter, points."""
    n = np.bincount(owner, minlength=count)
    mu, mh, suu, suh, shh = (np.bincount(owner, v, count) for v in (u, h, u * u, u * h, h * h))
    mu, mh = _mean(mu, n), _mean(mh, n)
    suu, suh, shh = suu - n * mu * mu, suh - n * mu * mh, np.maximum(shh - n * mh * mh, 0.0)
    # points that all lie at one offset do not give a slope
    slope = np.where(suu > n * 0.03**2, suh / np.maximum(suu, 1e-12), 0.0)
    scatter = np.sqrt(np.maximum(shh - slope * (2 * suh - slope * suu), 0.0) / np.maximum(n - 2, 1))
    return np.where(n > 0, mh - slope * mu, np.nan), slope, scatter, n


def road_before(low: np.ndarray, heights: np.ndarray, offsets: np.ndarray, spacing: float, rows: np.ndarray,
                columns: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Line through the ground before some cells.

    low : (P, C) m, heights of cells; heights, offsets : (N,) m, of those that hold ground, in order
    spacing : m across per cell
    rows, columns : (M,) the cells

    Returns the height of the line at each cell, its slope, the scatter of the ground about it, and number of cells, each (M,)
    """
    reach, skip = int(round(CURBS.road_side_length / spacing)), int(round(CURBS.face_margin / spacing))
    # of the occupied cells, those before a cell are a range
    filled_before = np.zeros(low.size + 1, np.int32)
    np.cumsum(np.isfinite(low), out=filled_before[1:])
    start = rows * low.shape[1]
    first, end = (filled_before.take(start + np.maximum(columns + 1 - back, 0)).astype(np.intp) for back in (reach + skip, skip))
    n = end - first
    bounds = np.c_[first, end].ravel()
    u, z = np.append(offsets, 0.0), np.append(heights, 0.0)

    def window(terms):
        return np.add.reduceat(terms, bounds)[::2] if len(bounds) else np.empty(0)

    su, sz, suz, suu, szz = (window(terms) for terms in (u, z, u * z, u * u, z * z))
    with np.errstate(all="ignore"):
        mu, mz = su / n, sz / n
        vuu, vuz, vzz = suu / n - mu * mu, suz / n - mu * mz, szz / n - mz * mz
        slope = np.where(vuu > 1e-4, vuz / vuu, 0.0)
        slope = np.clip(slope, -CURBS.max_road_slope, CURBS.max_road_slope)
        rough = np.sqrt(np.maximum(vzz - 2 * slope * vuz + slope * slope * vuu, 0.0))
        return mz + slope * (columns * spacing - mu), slope, rough, n


# Levels of the ground on either side of every place of averaged profiles.


class RunningSums:
    """Running sums over the cells of every profile; differences of them give the line through any range of cells.

    shape : (P, C), profiles and cells
    spacing : m, width of a cell
    """

    def __init__(self, shape: tuple[int, int], spacing: float):
        self.cells, self.spacing, self.u = shape[1], spacing, np.arange(shape[1]) * spacing
        # a window may reach beyond the first and the last cell
        self.pad = int(round((CURBS.blurred_face_half_width + CURBS.road_fit_length) / spacing)) + 2
        self.totals = np.zeros((6, shape[0], self.cells + 2 * self.pad))

    def add(self, value: np.ndarray) -> None:
        """Sum the heights of cells, (P, C), NaN where there is none."""
        measured = np.isfinite(value)
        h, u = np.where(measured, value, 0.0), measured * self.u
        columns = slice(self.pad, self.pad + self.cells)
        for total, v in zip(self.totals, (measured * 1.0, h, h * h, u, u * u, u * h)):
            np.cumsum(v, axis=1, out=total[:, columns])
            total[:, columns.stop:] = total[:, columns.stop - 1:columns.stop]

    def window(self, which: int, first: int, last: int) -> np.ndarray:
        """Sum of the cells from `first` to `last` beside every cell."""
        total, start, end = self.totals[which], self.pad - 1 + first, self.pad + last
        return total[:, end:end + self.cells] - total[:, start:start + self.cells]

    def window_at(self, which: int, first: int, last: int, cells: np.ndarray) -> np.ndarray:
        """The same at some cells."""
        row, cell = np.divmod(cells, self.cells)
        total = self.totals[which]
        return total[row, cell + self.pad + last] - total[row, cell + self.pad - 1 + first]

    def mean(self, first: int, last: int) -> np.ndarray:
        """Mean of the occupied cells from `first` to `last` beside every cell."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.window(1, first, last) / self.window(0, first, last)


class SideLines:
    """Lines through the cells from `first` to `last` beside every cell: height at the cell (`level`), slope, number of cells (`n`), each (P, C)."""

    def __init__(self, sums: RunningSums, first: int, last: int):
        self.n, sz, su, suu, suz = (sums.window(k, first, last) for k in (0, 1, 3, 4, 5))
        with np.errstate(invalid="ignore", divide="ignore"):
            mu, self.mz = su / self.n, sz / self.n
            vuu, self.vuz = suu / self.n - mu * mu, suz / self.n - mu * self.mz
            self.slope = np.where(vuu > 1e-4, self.vuz / vuu, 0.0)
            self.level = self.mz + self.slope * (sums.u - mu)
        self._squares = partial(sums.window_at, 2, first, last)

    def deviation(self, cells: np.ndarray) -> np.ndarray:
        """(M,) standard deviation of heights at some cells."""
        return np.sqrt(np.maximum(self._squares(cells) / self.n.take(cells) - self.mz.take(cells)**2, 0.0))

    def scatter(self, cells: np.ndarray) -> np.ndarray:
        """(M,) scatter of heights about the line at some cells."""
        n, mz = self.n.take(cells), self.mz.take(cells)
        with np.errstate(invalid="ignore", divide="ignore"):
            vzz = self._squares(cells) / n - mz * mz
        return np.sqrt(np.maximum(vzz - self.slope.take(cells) * self.vuz.take(cells), 0.0) * n / np.maximum(n - 2, 1))
