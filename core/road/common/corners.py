"""Bottom corners of curbs, measured from the raw points about a rising cell.

The corner is where the road's line meets the line of the face. Road, face and the
raised ground behind are told apart by height over the road's own line, so the
corner does not carry the grain of the cells.
"""

from dataclasses import dataclass

import numpy as np

from .pseudo_scanlines import TOP_QUANTILE_SIGMAS, expand_ranges

ROAD_SIDE_LENGTH = 0.40    # m of road before the face that give the road's line
FACE_MARGIN = 0.05    # m next to the face left out of it: a blurred face begins there
BEHIND_LENGTH = 0.40       # m behind the face where the ground must stay up
SLOPE_PER_NOISE = 6.0    # per m: heights that scatter tilt the short line behind a face
MAX_LOW_SHARE = 0.15     # share of the points behind that may lie below half the height; a verge has more
FACE_SEARCH_HALF_WIDTH = 0.15  # m either side of the rising cell within which the face lies
MAX_ROAD_SLOPE = 0.15  # rise over run of the road side; ditches are steeper
MAX_FACE_WIDTH = 0.10   # m across
FACE_NOISE_SIGMAS = 4.0      # sigmas by which noise widens a face
CANDIDATE_HEIGHT_SHARE = 0.8         # share of the least height below which no turning makes a step of a rise
MIN_STEP_SIGMAS = 4.0        # a step must stand this far above the noise of its road side
CANDIDATE_SIGMA_SHARE = 0.5        # share of that below which no turning makes a step of a rise
MIN_VIEW_POINTS = 5       # points of a view that is measured by itself, and of the other: else it shows what all points show
FACE_LOWER_SHARE, FACE_UPPER_SHARE = 0.15, 0.70  # part of the height that counts as face: grass hangs over the top
MIN_FACE_SHARE = 0.5    # noise brings points from above and below into a thinner part
REMEASURE_SKEW = 0.1         # m outward per m along beyond which a face is measured again, turned straight
MAX_FACE_SKEW = 1.0      # m outward per m along
SKEW_PRIOR = 3e-3    # m²: keeps a face seen in one scan line along the road
FACE_PRIOR = 2e-4   # m²: keeps a face seen in few points upright


@dataclass
class CurbSteps:
    """Bottom corners found on profiles, one entry each.

    profile : (M,) number of the profile; s, u, h : (M,) station, outward offset and height
    above the expected road of the bottom corner; skew : (M,) m outward per m along of the
    face; height : (M,) m of the step; run : (M,) m
    across of the face, less what noise adds; noise : (M,) m, heights about the road side's line; scanner_noise : (M,) m, the
    scanner's own noise there; support : (M,) points of road side and face; behind : (M,) points
    of the raised ground
    """

    profile: np.ndarray
    s: np.ndarray
    u: np.ndarray
    h: np.ndarray
    skew: np.ndarray
    height: np.ndarray
    run: np.ndarray
    noise: np.ndarray
    scanner_noise: np.ndarray
    support: np.ndarray
    behind: np.ndarray

    def __len__(self):
        return len(self.s)

    def __getitem__(self, which):
        return type(self)(*(getattr(self, name)[which] for name in self.__dataclass_fields__))

    @classmethod
    def join(cls, parts):
        return cls(*(np.concatenate([getattr(p, name) for p in parts]) for name in cls.__dataclass_fields__))


def measure_corners(lines, rows, cells, least, highest):
    """The step at each rising cell, where it proves to be one.

    Parameters
    ----------
    lines : PseudoScanLines
    rows, cells : (M,) rising cells
    least, highest : metres, heights of a step

    Returns
    -------
    CurbSteps, at most M, in the order of the cells
    """
    cell_count = lines.shape[1]
    reach = int(round(max(ROAD_SIDE_LENGTH + FACE_MARGIN, BEHIND_LENGTH) / lines.spacing)) + 2
    start = lines.starts[rows * cell_count + np.maximum(cells - reach, 0)]
    end = lines.starts[rows * cell_count + np.minimum(cells + reach + 1, cell_count)]
    owner, index = expand_ranges(start, end)
    ground = lines.ground.take(index)
    if not ground.all():
        ground = np.flatnonzero(ground)
        owner, index = owner.take(ground), index.take(ground)
    seen = _seen(lines, rows, cells, owner, index, least, highest)
    # positions that drifted between one view and the next blur a face that each of them shows sharp: what is
    # no step in all points together may be one in those seen from before, or from behind alone
    ahead = lines.along.take(index) > 0
    ahead_of, count = np.bincount(owner, ahead, len(rows)), np.bincount(owner, minlength=len(rows))
    mixed = np.minimum(ahead_of, count - ahead_of) >= MIN_VIEW_POINTS
    left = np.flatnonzero(seen["likely"] & ~seen["good"] & mixed)
    if len(left):
        number = np.full(len(rows), -1)
        number[left] = np.arange(len(left))
        own = np.flatnonzero(number.take(owner) >= 0)
        owner, index, ahead = number.take(owner.take(own)), index.take(own), ahead.take(own)
        views = [_seen(lines, rows[left], cells[left], owner[view], index[view], least, highest) for view in (~ahead, ahead)]
        support = [np.where(view["good"], view["support"], 0) for view in views]
        for view, better in zip(views, (support[0] >= support[1], support[0] < support[1])):
            better &= view["good"]
            for name, values in view.items():
                seen[name][left[better]] = values[better]
    good = seen["good"]
    return CurbSteps(profile=lines.first + rows[good], scanner_noise=lines.noise[rows[good]],
                 **{name: values[good] for name, values in seen.items() if name not in ("good", "likely")})


def _seen(lines, rows, cells, owner, index, least, highest):
    """What StepPatches.corners gives of rising cells, in stations and offsets; the points `index` belong to the cells `owner`."""
    edge, middle = lines.offset(cells), (lines.first + rows + 0.5) * lines.width
    near = StepPatches(owner, lines.u.take(index) - edge.take(owner), lines.s.take(index) - middle.take(owner), lines.h.take(index),
                     lines.noise[rows], least, highest)
    found = near.corners()
    skewed = np.flatnonzero(np.abs(found["skew"]) > REMEASURE_SKEW)
    if len(skewed):
        again = near.turned(skewed, found["skew"][skewed]).corners()
        again["skew"] = again["skew"] + found["skew"][skewed]
        for name, values in again.items():
            found[name][skewed] = values
    found["u"] = found["u"] + edge
    found["s"] = found["s"] + middle
    return found


class StepPatches:
    """Ground points about candidate steps: offset and station from each one's own place, outward and along."""

    def __init__(self, owner, u, s, h, scanner_noise, least, highest):
        self.owner, self.u, self.s, self.h = owner, u, s, h
        self.scanner_noise, self.least, self.highest, self.count = scanner_noise, least, highest, len(scanner_noise)

    def turned(self, which, skew):
        """The candidates `which` alone, with the direction of each face taken out of the offsets."""
        number = np.full(self.count, -1)
        number[which] = np.arange(len(which))
        own = np.flatnonzero(number[self.owner] >= 0)
        owner = number[self.owner[own]]
        near = StepPatches(owner, self.u[own] - skew[owner] * self.s[own], self.s[own], self.h[own], self.scanner_noise[which],
                     self.least, self.highest)
        near.turn = skew
        return near

    turn = 0.0

    def total(self, mask, values=None):
        return np.bincount(self.owner[mask], None if values is None else values[mask], minlength=self.count)

    def corners(self):
        """Everything a CurbSteps holds, as a dict of (count,) arrays, `good`: is it a step, and `likely`: may it be one, seen otherwise?"""
        owner, u, s, h, count = self.owner, self.u, self.s, self.h, self.count
        road = np.flatnonzero((u < -FACE_MARGIN) & (u > -ROAD_SIDE_LENGTH - FACE_MARGIN))
        side = owner.take(road), u.take(road), h.take(road)
        level, slope, noise, n_road = _line_per_owner(*side, count)
        off = np.abs(side[2] - level.take(side[0]) - slope.take(side[0]) * side[1])
        keep = np.flatnonzero(off < np.maximum(2.5 * noise, 0.01).take(side[0]))
        level, slope, noise, n_road = _line_per_owner(*(v.take(keep) for v in side), count)
        rise = h - level.take(owner) - slope.take(owner) * u
        height, n_behind, stays = self._raised(rise)
        found = dict(level=level, slope=slope, noise=noise, n_road=n_road, height=height, n_behind=n_behind, stays=stays)
        # most candidates are no step from whatever direction they are seen: their faces need no measuring
        likely = (n_road >= 4) & (height >= np.maximum(CANDIDATE_HEIGHT_SHARE * self.least, CANDIDATE_SIGMA_SHARE * MIN_STEP_SIGMAS * noise)) \
            & (np.abs(slope) <= MAX_ROAD_SLOPE / CANDIDATE_HEIGHT_SHARE)
        which = np.flatnonzero(likely)
        number = np.full(count, -1)
        number[which] = np.arange(len(which))
        own = np.flatnonzero((np.abs(u) < FACE_SEARCH_HALF_WIDTH) & (number.take(owner) >= 0))
        near = StepPatches(number.take(owner.take(own)), *(v.take(own) for v in (u, s, h)), self.scanner_noise[which], self.least, self.highest)
        near.turn = self.turn if np.isscalar(self.turn) else self.turn[which]
        seen = dict(likely=likely)
        for name, values in near._measured(rise.take(own), **{name: values[which] for name, values in found.items()}).items():
            seen[name] = np.zeros(count, values.dtype)
            seen[name][which] = values
        return seen

    def _measured(self, rise, level, slope, noise, n_road, height, n_behind, stays):
        """What `corners` gives, of candidates whose road side and height are known and points whose rise is."""
        owner, u, s, count, total = self.owner, self.u, self.s, self.count, self.total
        scatter = np.maximum(noise, self.scanner_noise)
        # the part of the height that is surely neither road nor raised ground
        lower = np.minimum(np.maximum(FACE_LOWER_SHARE * height, 2 * scatter), 0.45 * height)
        upper = np.maximum(np.minimum(FACE_UPPER_SHARE * height, height - 2 * scatter), 0.55 * height)
        face = (np.abs(u) < FACE_SEARCH_HALF_WIDTH) & (rise > lower[owner]) & (rise < upper[owner])
        skew, straight = _skew(owner, u, s, face, scatter, count)
        mid, spread = _median_and_spread(owner, straight, face, count)
        face &= np.abs(straight - mid[owner]) < 0.05 + 2 * scatter[owner]
        skew, straight = _skew(owner, u, s, face, scatter, count)
        n_face = total(face)
        mid, up, at = (_mean(total(face, v), n_face) for v in (straight, rise, s))
        var_up = total(face, (rise - up[owner]) ** 2)
        lean = total(face, (straight - mid[owner]) * (rise - up[owner])) / (var_up + n_face * FACE_PRIOR + 1e-9)
        corner = mid - np.clip(lean, -0.2, 0.8) * up
        # half the points of an even face lie within half its run; noise widens that
        share = np.maximum((upper - lower) / np.maximum(height, 1e-3), MIN_FACE_SHARE)
        run = 2 * np.sqrt(np.maximum(spread**2 - (1.35 * scatter) ** 2, 0.0)) / share
        run = np.where(n_face < 3, 0.0, np.maximum(run - FACE_NOISE_SIGMAS * scatter, 0.0))
        good = (np.isfinite(level) & (n_road >= 4) & (height >= self.least) & (height <= self.highest)
                & (height >= MIN_STEP_SIGMAS * noise) & (np.abs(slope) <= MAX_ROAD_SLOPE) & stays
                & (n_face >= 1) & (run <= MAX_FACE_WIDTH))
        return dict(s=at, u=corner + self.turn * at, h=level + slope * corner, skew=skew, height=height, run=run,
                    noise=noise, support=n_road + n_face, behind=n_behind, good=good)

    def _raised(self, rise):
        """Height of the ground behind the face, how many points lie there, and whether it stays up and level."""
        count = self.count
        beyond = np.flatnonzero((self.u > 0.03) & (self.u < BEHIND_LENGTH))
        owner, u, rise_there = self.owner.take(beyond), self.u.take(beyond), rise.take(beyond)
        raised = np.flatnonzero((rise_there > 0.4 * self.least) & (rise_there < self.highest + 0.1))
        up, out, to = owner.take(raised), u.take(raised), rise_there.take(raised)
        first = _mean(np.bincount(up, to, count), np.bincount(up, minlength=count))
        alike = np.flatnonzero(np.abs(to - first.take(up)) < 0.05)
        up, out, to = up.take(alike), out.take(alike), to.take(alike)
        # a ramp goes on rising where the ground behind a curb is as level as a road
        _, climb, _, n_behind = _line_per_owner(up, out, to, count)
        level = (n_behind < 4) | (np.abs(climb) <= MAX_ROAD_SLOPE + SLOPE_PER_NOISE * self.scanner_noise)
        peak = np.zeros(count)
        near = np.flatnonzero((self.u > -0.03) & (self.u < FACE_SEARCH_HALF_WIDTH) & (n_behind < 2).take(self.owner))
        with np.errstate(invalid="ignore"):  # a rise that could not be told stays one; newer numpy says so aloud
            np.maximum.at(peak, self.owner.take(near), rise.take(near))
        height = np.where(n_behind >= 2, _mean(np.bincount(up, to, count), n_behind),
                          np.maximum(peak - TOP_QUANTILE_SIGMAS * self.scanner_noise, 0.0))
        far = np.flatnonzero(u > 0.10)
        low = np.flatnonzero(rise_there < 0.5 * height.take(owner))
        low = low[u.take(low) > 0.10]
        low, far = (np.bincount(owner.take(v), minlength=count) for v in (low, far))
        return height, n_behind, level & (low <= np.maximum(MAX_LOW_SHARE * far, 1))


def _skew(owner, u, s, mask, scatter, count):
    """How far the face turns away from the road's direction, and offsets with that taken out.

    Returns (count,) metres outward per metre along, drawn to 0 where few points or a
    short stretch cannot tell, and (N,) offsets moved along the face to its mean station.
    """
    n = np.bincount(owner[mask], minlength=count)
    at, out = (_mean(np.bincount(owner[mask], v[mask], count), n) for v in (s, u))
    ds, du = s - at[owner], u - out[owner]
    along = np.bincount(owner[mask], ds[mask] ** 2, count)
    skew = np.bincount(owner[mask], (ds * du)[mask], count) / (along + SKEW_PRIOR + (5 * scatter) ** 2)
    skew = np.clip(skew, -MAX_FACE_SKEW, MAX_FACE_SKEW)
    return skew, u - skew[owner] * ds


def _median_and_spread(owner, values, mask, count):
    """Median and interquartile range of the masked values of each owner (0 where it has none)."""
    owner, values = owner[mask], values[mask]
    order = np.lexsort((values, owner))
    values = np.r_[values[order], 0.0]
    n = np.bincount(owner, minlength=count)
    first = np.cumsum(n) - n

    def quantile(q):
        at = q * np.maximum(n - 1, 0)
        k = np.floor(at).astype(np.int64)
        low, high = values[first + k], values[np.minimum(first + k + 1, len(values) - 1)]
        return np.where(n > 0, np.where(n > k + 1, low + (at - k) * (high - low), low), 0.0)

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
