"""Steps on pseudo scan-lines: where the road ends against a face, profile by profile.

A step is sought outward from the vehicle: a smooth road side, a rise within
`window`, ground that stays up behind it. The bottom corner is then measured from
the raw points, where the road's line meets the line of the face, so that it does
not carry the grain of the cells.
"""

from dataclasses import dataclass

import numpy as np

from .profiles import HIGH_SIGMA, PseudoScanLines

ROAD_SIDE = 0.40    # m of road before the face that give the road's line
CLEARANCE = 0.05    # m next to the face left out of it: a blurred face begins there
BEHIND = 0.40       # m behind the face where the ground must stay up
WINDOW = 0.15       # m across within which the whole rise must lie
STEEPEST_ROAD = 0.15  # rise over run of the road side; ditches are steeper
WIDEST_FACE = 0.10   # m across
NOISE_RUN = 4.0      # sigmas by which noise widens a face
SIGMAS = 4.0        # a step must stand this far above the noise of its road side
FACE_LOW, FACE_HIGH = 0.15, 0.70  # part of the height that counts as face: grass hangs over the top
LEAST_SHARE = 0.5    # noise brings points from above and below into a thinner part
FACE_PRIOR = 2e-4   # m²: keeps a face seen in few points upright


@dataclass
class Steps:
    """Bottom corners found on profiles, one entry each.

    profile : (M,) number of the profile; s, u, h : (M,) station, outward offset and height
    above the expected road of the bottom corner; height : (M,) m of the step; run : (M,) m
    across of the face, less what noise adds; noise : (M,) m, heights about the road side's line; usual : (M,) m, the
    scanner's own noise there; support : (M,) points of road side and face; behind : (M,) points
    of the raised ground
    """

    profile: np.ndarray
    s: np.ndarray
    u: np.ndarray
    h: np.ndarray
    height: np.ndarray
    run: np.ndarray
    noise: np.ndarray
    usual: np.ndarray
    support: np.ndarray
    behind: np.ndarray

    def __len__(self):
        return len(self.s)

    def __getitem__(self, which):
        return Steps(*(getattr(self, name)[which] for name in self.__dataclass_fields__))

    @staticmethod
    def join(parts):
        return Steps(*(np.concatenate([getattr(p, name) for p in parts]) for name in Steps.__dataclass_fields__))


def find_steps(lines: PseudoScanLines, least, highest):
    """Steps between `least` and `highest` metres on every profile of one side.

    Returns
    -------
    Steps, sorted by profile, then outward
    """
    rows, cells = _rising_cells(lines, least, highest)
    return _measure(lines, rows, cells, least, highest)


def _rising_cells(lines, least, highest):
    """(row, cell) of the cells in which a profile crosses the middle of a step."""
    low, high, spacing = lines.low, lines.high, lines.spacing
    base, rough, count = _road_before(low, spacing)
    span = max(int(round(WINDOW / spacing)), 2)
    noise = lines.noise[:, None]
    top = _max_ahead(high, span) - HIGH_SIGMA * noise
    with np.errstate(invalid="ignore"):
        step = top - base
    # the cell before must still be road: the last occupied one within the window
    before = _last_before(low, span)
    middle = base + 0.5 * step
    with np.errstate(invalid="ignore"):
        found = ((count >= 3) & (step >= np.maximum(0.8 * least, SIGMAS * np.maximum(noise, rough) / 2))
                 & (step <= highest + 0.05) & (high >= middle) & (before < middle))
    score = np.where(found, step - 2 * rough, -np.inf)
    # one of a cluster: the best within the window
    best = score >= np.maximum(_max_ahead(score, span, inclusive=False), _max_ahead(score[:, ::-1], span, inclusive=False)[:, ::-1])
    return np.nonzero(found & best)


def _road_before(low, spacing):
    """Line through the principal points before every cell: its height there, scatter, and count."""
    rows, cells = low.shape
    reach, skip = int(round(ROAD_SIDE / spacing)), int(round(CLEARANCE / spacing))
    there = np.isfinite(low)
    value = np.where(there, low, 0.0)
    c = np.arange(cells) * spacing

    def window(terms):
        total = np.concatenate([np.zeros((rows, 1)), np.cumsum(terms, axis=1)], axis=1)
        last = np.clip(np.arange(cells) - skip + 1, 0, cells)
        return total[:, last] - total[:, np.clip(last - reach, 0, cells)]

    n, su, sz = window(there * 1.0), window(there * c), window(value)
    suu, suz, szz = window(there * c * c), window(value * c), window(value * value)
    with np.errstate(all="ignore"):
        mu, mz = su / n, sz / n
        vuu, vuz, vzz = suu / n - mu * mu, suz / n - mu * mz, szz / n - mz * mz
        slope = np.where(vuu > 1e-4, vuz / vuu, 0.0)
        slope = np.clip(slope, -STEEPEST_ROAD, STEEPEST_ROAD)
        rough = np.sqrt(np.maximum(vzz - 2 * slope * vuz + slope * slope * vuu, 0.0))
        return mz + slope * (c - mu), rough, n


def _max_ahead(values, span, inclusive=True):
    """Largest value in this and the following cells, NaN taken as none."""
    best = np.full(values.shape, -np.inf)
    for k in range(0 if inclusive else 1, span + 1):
        width = values.shape[1] - k
        if width > 0:
            np.fmax(best[:, :width], values[:, k:], out=best[:, :width])
    return best


def _last_before(values, span):
    """Value of the nearest occupied cell before each within the span, NaN where there is none."""
    found = np.full(values.shape, np.nan)
    for k in range(span, 0, -1):
        shifted = values[:, :-k] if k < values.shape[1] else values[:, :0]
        there = np.isfinite(shifted)
        found[:, k:][there] = shifted[there]
    return found


def _measure(lines, rows, cells, least, highest):
    """Bottom corners from the raw points about rising cells."""
    cell_count = lines.shape[1]
    reach = int(round(max(ROAD_SIDE + CLEARANCE, BEHIND) / lines.spacing)) + 2
    start = lines.starts[rows * cell_count + np.maximum(cells - reach, 0)]
    end = lines.starts[rows * cell_count + np.minimum(cells + reach + 1, cell_count)]
    owner, index = _expand(start, end)
    ground = lines.ground[index]
    owner, index = owner[ground], index[ground]
    # each step is measured from all points, and from those seen from before and from behind
    # alone: positions that drifted in between blur a face that each of the two shows sharp
    candidates = len(rows)
    owner = np.concatenate([owner, owner + candidates * (1 + lines.ahead[index])])
    index = np.concatenate([index, index])
    rows, cells = np.tile(rows, 3), np.tile(cells, 3)
    count, edge = len(rows), lines.offset(cells)
    u, h, s = lines.u[index] - edge[owner], lines.h[index], lines.s[index]
    usual = lines.noise[rows]

    def total(mask, values=None):
        return np.bincount(owner[mask], None if values is None else values[mask], minlength=count)

    road = (u < -CLEARANCE) & (u > -ROAD_SIDE - CLEARANCE)
    level, slope, noise, n_road = _line_per_owner(owner, u, h, road, count)
    keep = road & (np.abs(h - level[owner] - slope[owner] * u) < np.maximum(2.5 * noise, 0.01)[owner])
    level, slope, noise, n_road = _line_per_owner(owner, u, h, keep, count)
    rise = h - level[owner] - slope[owner] * u
    # what lies behind the face, trimmed about its own mean once
    raised = (u > 0.03) & (u < BEHIND) & (rise > 0.4 * least) & (rise < highest + 0.1)
    first = _mean(total(raised, rise), total(raised))
    raised &= np.abs(rise - first[owner]) < 0.05
    n_behind = total(raised)
    crest = lines.high[rows, np.minimum(cells + 3, cell_count - 1)]
    peak = np.full(count, -np.inf)
    near = (u > -0.03) & (u < WINDOW)
    np.maximum.at(peak, owner[near], rise[near])
    height = np.where(n_behind >= 2, _mean(total(raised, rise), n_behind), peak - HIGH_SIGMA * usual)
    fallen = (u > 0.10) & (u < BEHIND) & (rise < 0.35 * height[owner])
    n_fallen = total(fallen)

    # the part of the height that is surely neither road nor raised ground
    scatter = np.maximum(noise, usual)
    lower = np.minimum(np.maximum(FACE_LOW * height, 2 * scatter), 0.45 * height)
    upper = np.maximum(np.minimum(FACE_HIGH * height, height - 2 * scatter), 0.55 * height)
    face = (np.abs(u) < WINDOW) & (rise > lower[owner]) & (rise < upper[owner])
    mid, spread = _median_and_spread(owner, u, face, count)
    face &= np.abs(u - mid[owner]) < 0.05 + 2 * scatter[owner]
    n_face = total(face)
    mid, up, at = (_mean(total(face, v), n_face) for v in (u, rise, s))
    var_up = total(face, (rise - up[owner]) ** 2)
    lean = total(face, (u - mid[owner]) * (rise - up[owner])) / (var_up + n_face * FACE_PRIOR + 1e-9)
    lean = np.clip(lean, -0.2, 0.8)
    seen = n_face >= 1
    height = np.maximum(height, 0.0)
    corner = np.where(seen, mid - lean * up, 0.0)
    # half the points of an even face lie within half its run; noise widens that
    share = np.maximum((upper - lower) / np.maximum(height, 1e-3), LEAST_SHARE)
    run = 2 * np.sqrt(np.maximum(spread**2 - (1.35 * scatter) ** 2, 0.0)) / share
    run = np.where(n_face < 3, 0.0, np.maximum(run - NOISE_RUN * scatter, 0.0))
    station = np.where(seen, at, (lines.first + rows + 0.5) * lines.width)
    good = (np.isfinite(level) & (n_road >= 4) & (height >= least) & (height <= highest)
            & (height >= SIGMAS * noise) & (np.abs(slope) <= STEEPEST_ROAD) & (n_fallen <= n_behind) & seen
            & (run <= WIDEST_FACE))
    steps = Steps(lines.first + rows, station, edge + corner, level + slope * corner, height, run, noise, usual,
                  n_road + n_face, n_behind)
    return _best_view(steps, good, candidates)


def _best_view(steps, good, count):
    """Of three measurements of each step the first that is good: from all points, or the view with more of them."""
    single = good[count:].reshape(2, count)
    support = np.where(single, steps.support[count:].reshape(2, count), 0)
    view = np.where(good[:count], 0, 1 + np.argmax(support, axis=0))
    chosen = np.flatnonzero(good[:count] | single.any(0))
    return steps[chosen + count * view[chosen]]


def _expand(start, end):
    """Every index of ragged ranges, and which range it belongs to."""
    length = np.maximum(end - start, 0)
    owner = np.repeat(np.arange(len(start)), length)
    index = np.arange(length.sum()) - np.repeat(np.cumsum(length) - length, length) + np.repeat(start, length)
    return owner, index


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


def _line_per_owner(owner, u, h, mask, count):
    """Least-squares line h = level + slope * u for each owner: level, slope, scatter, points."""
    owner, u, h = owner[mask], u[mask], h[mask]
    n = np.bincount(owner, minlength=count)
    mu, mh = _mean(np.bincount(owner, u, count), n), _mean(np.bincount(owner, h, count), n)
    du, dh = u - mu[owner], h - mh[owner]
    suu, suh, shh = (np.bincount(owner, v, count) for v in (du * du, du * dh, dh * dh))
    # points that all lie at one offset do not give a slope
    slope = np.where(suu > n * 0.03**2, suh / np.maximum(suu, 1e-12), 0.0)
    scatter = np.sqrt(np.maximum(shh - slope * (2 * suh - slope * suu), 0.0) / np.maximum(n - 2, 1))
    return np.where(n > 0, mh - slope * mu, np.nan), slope, scatter, n
