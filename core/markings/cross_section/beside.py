"""How wide a lane is that has a painted line on one side only: what its curb, where one drove and the usual width say together.

A lane between a line and a curb, or an edge of the pavement, has all the room, or a gutter or a row of parked cars has some of it. Each of these
readings gives a width and how well it fits the room, the usual width of lanes and the drive; all three are normal, so what they say together is.
"""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from ...countries.catalogue import NEUTRAL
from .candidates import Candidates
from .evidence import Evidence
from .weights import BARE, CURB, DOUBLE, ISLAND, OPEN, PAVEMENT, SAME_LANE, SURFACE, SURFACE_END, EstimateWeights

WIDTH, SECOND_WIDTH, NATS, SURE, BEYOND = range(5)   # columns of `lanes_beside`


def lanes_beside(c: Candidates, evidence: Evidence, usual: float, shown: bool, w: EstimateWeights) -> np.ndarray:
    """(I, M, 2, 5) of a lane on the left and on the right of each boundary, see below.

    These are its width, m, the next probable one, by how many nats that is less so, inf without one, how probably the middle of the lane is within
    SAME_LANE, and, where it lies apart from the boundary, the room beyond it, m, else NaN.

    usual : m, width of lanes of the road; shown : whether the lines of the road show it
    """
    result = np.empty((*c.left.shape, 2, 5))
    result[..., :] = usual, np.nan, np.inf, 1.0, np.nan
    i, m = np.nonzero(c.valid & c.bounding)
    if not len(i):
        return result
    i, m, side = np.tile(i, 2), np.tile(m, 2), np.repeat([0, 1], len(i))
    step = np.where(side == 0, -1, 1)
    # the surface may seem to end before the curb, at what hides it
    beyond = m + step
    for skipped in (BARE, BARE, (SURFACE, OPEN)):
        beyond = np.where(np.isin(c.made_of[i, beyond], skipped), (beyond + step).clip(0, c.left.shape[1] - 1), beyond)
    made = c.made_of[i, beyond]
    line, far = np.where(side == 0, c.left[i, m], c.right[i, m]), np.where(side == 0, c.right[i, beyond], c.left[i, beyond])
    row = 2 * c.rows[i, m, side] + side
    station = (np.cumsum(c.length) - c.length / 2)[i]
    places = _Along(row, station, c.length[i])
    across = np.abs(far - line)
    room = np.where(np.isin(made, (CURB, PAVEMENT)), across, np.nan)
    # where a line lies on the other side farther on, it shows how wide the lane is
    lined = (made <= DOUBLE) & (across >= NEUTRAL.narrowest_lane) & (across <= NEUTRAL.widest_lane)
    around, widths = _Along(np.zeros(len(i)), station, c.length[i]), np.where(lined, across, np.nan)
    between, lined_there = places.means(widths, w.laid_out), around.means(widths, w.laid_out)
    # beside an island all room is the lane's
    offset = np.where(made == ISLAND, np.nan, step * (line - evidence.driven[:evidence.own, i]))
    near, passes = _driven_beside(offset, room, w)
    driven = places.means(np.where(passes > 0, near, np.nan), w.laid_out)
    # a survey has streets of other lanes: where nobody drove, the lines there show best how wide they are
    lined_there = np.where(np.isfinite(between) | np.isfinite(driven), between, lined_there)
    usual_there, like = np.where(np.isfinite(lined_there), lined_there, usual), w.like_lines * (shown | np.isfinite(lined_there))
    sigma = w.track_sigma / np.sqrt(np.maximum(places.means(passes.astype(float), w.laid_out), 1e-9))
    share = np.array([[part] for _, _, part in w.left_over_beside])
    nats, width, spread = _readings(room, driven, sigma, usual_there, like, share, w)
    known = np.isfinite(room) & np.isfinite(driven) & np.isfinite(nats).any(axis=0)
    if known.any():
        # what is left over is alike beside other curbs that were driven on the same road near by, and so is the width of lanes that nobody drove
        probable = np.exp(nats[:, known].min(axis=0) - nats[:, known])
        probable /= probable.sum(axis=0)
        shown_there = np.full((len(share) + 1, len(i)), np.nan)
        shown_there[:, known] = *probable[:-2].reshape(2, len(share), -1).sum(axis=0), (probable * width[:, known]).sum(axis=0)
        *near_by, driven_width = (around.means(values, w.alike_within, np.isfinite(driven) * places.sums(values, w.alike_within))
                                  for values in shown_there)
        share = np.where(np.isfinite(driven_width), (share + w.alike_beside * np.array(near_by)) / (1 + w.alike_beside), share)
        undriven = np.isfinite(driven_width) & np.isnan(driven)
        usual_there = np.where(np.isnan(between) & undriven, driven_width, usual_there)
        nats, width, spread = _readings(room, driven, sigma, usual_there, np.where(undriven, w.like_lines, like), share, w)
    chosen = _chosen(places, room, lined, across, nats, width, spread, w)
    end = m + step
    free = np.where(np.isnan(room) & SURFACE_END[c.made_of[i, end]], np.abs(np.where(side == 0, c.right[i, end], c.left[i, end]) - line), room)
    result[i, m, side] = np.column_stack([chosen, _driven_apart(offset, free, chosen[:, WIDTH], w)])
    return result


class _Along:
    """Places along rows: (N,) rows, stations and lengths of road, m."""

    def __init__(self, row, station, length):
        self.order, self.length = np.lexsort((station, row)), length
        self.far = station.max(initial=0.0) + 1.0
        self.row, self.station = row[self.order], station[self.order]

    def means(self, values, reach, less=0):
        """(N,) means of what is not NaN of values, over `reach` m either way along the same row, less some `sums`; NaN where there is none."""
        total, length = self.sums(values, reach) - less
        with np.errstate(invalid="ignore", divide="ignore"):
            return total / length

    def sums(self, values, reach):
        """(2, N) int, the same times their length, and that length, in millionths: as whole numbers they do not depend on what lies farther along."""
        place = self.row * (self.far + 2 * reach) + self.station
        low, high = np.searchsorted(place, place - reach), np.searchsorted(place, place + reach, side="right")
        weight = np.where(np.isfinite(values), self.length, 0.0)[self.order]
        parts = weight * np.where(np.isfinite(values), values, 0.0)[self.order], weight
        result = np.empty((2, len(values)), np.int64)
        for of_part, part in zip(result, parts):
            total = np.r_[0, np.cumsum(np.rint(1e6 * part).astype(np.int64))]
            of_part[self.order] = total[high] - total[low]
        return result


def _driven_beside(offset, room, w):
    """(N,) m, mean distance of the passes within reach of a line and within its room, and (N,) their number; `offset` : (P, N) m from the line."""
    with np.errstate(invalid="ignore"):
        inside = (offset > NEUTRAL.narrowest_lane / 3) & (offset < w.widest_beside / 2 + SAME_LANE) & ~(offset > room)
    number = inside.sum(axis=0)
    return np.where(inside, offset, 0.0).sum(axis=0) / np.maximum(number, 1), number


def _driven_apart(offset, room, width, w):
    """(N,) m beyond a lane that is driven apart from the line beside it, as where this moves aside for a lane that opens; NaN where it is not."""
    with np.errstate(invalid="ignore"):
        nearest = np.where((offset > 0) & (offset < room), offset, np.inf).min(axis=0, initial=np.inf)
        apart = np.minimum(nearest - width / 2, room - width)
        return np.where(np.isfinite(nearest) & (apart > w.driven_sigma), room - width - apart, np.nan)


def _readings(room, driven, track_sigma, usual, like, share, w):
    """(R, N) nats, widths and their sigma, m, of the readings of strips: of what is left over, of lanes as wide as between lines and of others.

    `like` : (N,) share of those as wide as between lines; `share` : (3, N) or (3, 1), of what is left over; the rest of it may be anything, the last
    two readings
    """
    left_over, scatter = (np.array(values)[:, None] for values in list(zip(*w.left_over_beside))[:2])
    nats, width, spread = [], [], []
    with np.errstate(divide="ignore"):
        for sigma, of_sigma in ((w.width_sigma_lined, like), (w.width_sigma_beside, 1 - like)):
            misfit, variance = room - left_over - usual, sigma**2 + scatter**2
            fits = 0.5 * (misfit**2 / variance + np.log(2 * np.pi * variance)) - np.log(share) - np.log(of_sigma)
            nats.append(np.where(np.isfinite(room), fits, np.inf))
            width.append(np.where(np.isfinite(room), usual + misfit * sigma**2 / variance, usual))
            spread.append(np.broadcast_to(sigma**2 * scatter**2 / variance, misfit.shape))
        for sigma, of_sigma in ((w.width_sigma_lined, like), (w.width_sigma_beside, 1 - like)):
            of_rest = np.where(np.isfinite(room), (1 - share.sum(axis=0)) / w.widest_beside, 1.0)
            nats.append(-np.log(of_rest * of_sigma)[None])
            width.append(usual[None])
            spread.append(np.full((1, len(room)), sigma**2))
    nats, width, spread = (np.concatenate(values) for values in (nats, width, spread))
    # what the drive says
    variance = spread + (2 * track_sigma) ** 2
    shown = np.where(np.isfinite(driven), 2 * driven - width, 0.0)
    nats = nats + np.where(np.isfinite(driven), 0.5 * (shown**2 / variance + np.log(2 * np.pi * variance)), 0.0)
    width = width + np.where(np.isfinite(driven), shown * spread / variance, 0.0)
    possible = (width >= NEUTRAL.narrowest_lane) & (width <= np.fmin(room, w.widest_beside) + SAME_LANE)
    return np.where(possible, nats, np.inf), width, np.sqrt(np.where(np.isfinite(driven), spread * (variance - spread) / variance, spread))


def _chosen(places, room, lined, across, nats, width, spread, w):
    """(N, 4) width, second width and nats, and how probably the middle is right; a road is laid out alike as far as its line goes on.

    The width is that of the most probable reading, or one towards the next, with which the lane is most often within SAME_LANE, and within a third of
    that, which counts less.
    """
    alike = np.stack([places.means(np.where(np.isfinite(part), part, np.nan), w.repeats) for part in nats])
    nats = np.where(np.isfinite(nats), alike, np.inf)
    order, columns = np.argmin(nats, axis=0), np.arange(len(room))
    first = width[order, columns]
    apart = np.where(np.abs(width - first) > SAME_LANE, nats, np.inf)
    other = np.where(np.isfinite(apart).any(axis=0), width[apart.argmin(axis=0), columns], first)
    with np.errstate(invalid="ignore"):
        share = np.nan_to_num(np.exp(nats.min(axis=0) - nats))
    between = first + np.array(w.between_widths)[:, None] * (other - first)
    off = np.abs(between[:, None] - width)
    right, nearer = ((share * (ndtr((reach - off) / spread) - ndtr((-reach - off) / spread))).sum(axis=1)
                     for reach in (2 * SAME_LANE, 2 * SAME_LANE / 3))
    tried = np.argmax([places.means(part, w.repeats) for part in right + w.nearer * nearer], axis=0)
    first, sure = between[tried, columns], right[tried, columns] / np.maximum(share.sum(axis=0), 1.0)
    apart = np.where(np.abs(width - first) > 2 * SAME_LANE, nats, np.inf)
    second = np.argmin(apart, axis=0)
    known = np.isfinite(apart[second, columns])
    behind = np.where(known, np.where(known, apart[second, columns], 0.0) - nats[order, columns], np.inf)
    # beyond the end of the curb, or of the other line, a lane goes on as wide as beside it
    bounded = np.isfinite(room)
    elsewhere = places.means(np.where(lined, across, np.where(bounded, first, np.nan)), w.laid_out)
    first = np.where(~bounded & np.isfinite(elsewhere), elsewhere, first)
    return np.column_stack([first, width[second, columns], behind, sure])
