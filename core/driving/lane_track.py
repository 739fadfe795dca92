"""One lane followed along the road, and how stretches of lanes become one."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..common.arrays import mask_runs
from ..common.parallel import check_cancelled
from ..markings.cross_section.sections import STATION_STEP
from ..markings.cross_section.weights import SAME_LANE, EstimateWeights, Reading
from ..survey.frame.row_table import RowSpans
from .weights import TRACKS

MEASURED, INFERRED, BRIDGED = 0, 1, 2
LANE_STATUS = ("measured", "inferred", "bridged")


@dataclass
class LaneTrack:
    """A lane from grid station `first` on.

    second : (N,) object, the second Reading of each place, None where none is known
    aside : (N,) metres that the lane was moved across from where its own borders show it, to meet a surer stretch
    """

    first: int
    d: np.ndarray   # (N,) metres
    width: np.ndarray
    status: np.ndarray   # (N,) of MEASURED, INFERRED, BRIDGED
    offset: np.ndarray   # (N,) True where the place comes from one line only, or from the drive
    left: np.ndarray   # (N,) rows of Boundaries that it lies between, -1 where nothing is painted
    right: np.ndarray
    left_use: np.ndarray   # (N,) what these separate, LANE_LINE ... OTHER_LINE, -1 where unknown
    right_use: np.ndarray
    probability: np.ndarray   # (N,) 0 to 1, as of LaneSpan
    confidence: np.ndarray
    direction: int   # 1 along the road's reference line, -1 against it
    second: np.ndarray = None  # type: ignore[assignment]  # filled on construction
    aside: np.ndarray = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        if self.second is None:
            self.second = np.full(len(self.d), None, object)
        if self.aside is None:
            self.aside = np.zeros(len(self.d))

    @property
    def last(self) -> int:
        return self.first + len(self.d) - 1

    @property
    def stations(self) -> np.ndarray:
        """(N,) int, numbers of its grid stations."""
        return np.arange(self.first, self.first + len(self))

    def __len__(self) -> int:
        return len(self.d)

    def part(self, a: int, b: int) -> LaneTrack:
        """Rows a to b (exclusive) as a track of their own."""
        return replace(self, first=self.first + a, **self._each(lambda name, v: v[a:b]))

    @staticmethod
    def joined(parts: Sequence[LaneTrack]) -> LaneTrack:
        """Tracks of which each begins at the next station after the one before, as one."""
        first = parts[0]
        return first if len(parts) == 1 else replace(first, **first._each(lambda name, v: np.concatenate([getattr(part, name) for part in parts])))

    def stretched(self, first: int, d: np.ndarray, width: np.ndarray, row: int) -> LaneTrack:
        """A track from station `first` on that is in all but its place and width as this one is at a row."""
        alike = replace(self, first=first, **self._each(lambda name, v: np.repeat(v[row], len(d))))
        return replace(alike, d=d, width=width)

    def _each(self, change: Callable[[str, np.ndarray], np.ndarray]) -> dict[str, Any]:
        """{name: change(name, values)} of what is known at every station."""
        return {column.name: change(column.name, v) for column in fields(self) if isinstance(v := getattr(self, column.name), np.ndarray)}

    def without_jumps(self, s: np.ndarray) -> LaneTrack:
        """The track with borders that are led over where they jump aside: a lane has no steps at its sides. s : (K,) metres, grid stations"""
        stations = s[self.first:self.last + 1]
        left, right = (led_over(stations, self.d + side * self.width / 2, rows) for side, rows in ((1, self.left), (-1, self.right)))
        return replace(self, d=(left + right) / 2, width=left - right)

    def at(self, k: int) -> tuple[float, float]:
        """Offset and width at grid station k; NaN where the lane is not."""
        if self.first <= k <= self.last:
            return float(self.d[k - self.first]), float(self.width[k - self.first])
        return np.nan, np.nan

    def end_width(self, head: bool) -> float:
        rows = int(TRACKS.end_width_length / STATION_STEP)
        return float(np.median(self.width[:rows] if head else self.width[-rows:]))

    @cached_property
    def in_doubt(self) -> np.ndarray:
        """(N,) bool, where a second reading is almost as probable, or the lane lies beside where its own borders show it."""
        behind = np.array([np.inf if reading is None else reading.nats for reading in self.second])
        doubtful = (behind < EstimateWeights.doubt) | (np.abs(self.aside) > SAME_LANE)
        for first, end in mask_runs(~doubtful):
            if first and end < len(doubtful) and (end - first) * STATION_STEP < TRACKS.near_doubt:
                doubtful[first:end] = True
        return doubtful

    def said_confidence(self) -> np.ndarray:
        """(N,) how often such lanes are right, at most `most_in_doubt` where there is a second reading."""
        return np.where(self.in_doubt, np.minimum(self.confidence, EstimateWeights.most_in_doubt), self.confidence)

    def said(self, rows: slice, weights: EstimateWeights = EstimateWeights()) -> dict[str, Any]:
        """The confidence of part of the lane, and `other`, its second reading as JSON where most of the part is in doubt, else "".

        The JSON holds the nats by which that reading is less probable, and the lanes that then lie there.
        """
        confidence = float(self.confidence[rows].mean())
        if 2 * np.count_nonzero(self.in_doubt[rows]) <= len(self.d[rows]):
            return dict(confidence=confidence, other="")
        return dict(confidence=min(confidence, weights.most_in_doubt), other=self._other(rows, weights))

    def _other(self, rows, weights):
        readings = []
        for second, d, width, aside in zip(self.second[rows], self.d[rows], self.width[rows], self.aside[rows]):
            if abs(aside) > SAME_LANE:
                readings.append(Reading(0.0, ((d - aside, width, self.direction),)))
            elif second is not None and second.nats < weights.doubt:
                readings.append(second)
        if not readings:
            return ""   # in doubt between two doubtful stretches: neither reading is of these places
        ways = [tuple(way for _, _, way in reading.lanes) for reading in readings]
        usual = max(sorted(set(ways)), key=ways.count)
        alike = [reading for reading, way in zip(readings, ways) if way == usual]
        lanes = np.median(np.array([reading.lanes for reading in alike], float).reshape(len(alike), -1, 3), axis=0)
        return json.dumps({"nats": round(float(np.median([reading.nats for reading in alike])), 2), "lanes": [
            {"offset_m": round(d, 2), "width_m": round(width, 2), "direction": int(way)} for d, width, way in lanes.tolist()]})

    def without_doubtful_ends(self) -> LaneTrack | None:
        """The track less stretches at its ends that only led over a gap, or are improbable; None if nothing is left."""
        led_over = (self.status == BRIDGED) | self.offset & (self.left < 0) & (self.right < 0)
        min_probability = np.array(TRACKS.least_probability_of_end)[self.offset.astype(int)]
        sure = np.flatnonzero(~led_over & (self.probability >= min_probability))
        return self.part(sure[0], sure[-1] + 1) if len(sure) else None


def led_over(s: np.ndarray, offset: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(N,) m, a border at `offset` along `s`, m, without jumps, as where it goes on as another line, `rows`, beside the first; -1 where it is none.

    Each jump is spread over `jump_lead` times its size, `longest_lead` at most, half of it on either side; less where the lane ends before, and
    places aside at its very end are continued with the others.
    """
    result, jumps, steps = offset.copy(), np.diff(offset), np.diff(s)
    sudden = (np.diff(rows) != 0) & (np.abs(jumps) > TRACKS.least_jump) | (np.abs(jumps) > TRACKS.most_oblique_border * steps)
    for k in np.flatnonzero(sudden):
        middle = (s[k] + s[k + 1]) / 2
        room = 2 * min(middle - s[0], s[-1] - middle)
        if room > 2 * STATION_STEP:
            lead = min(max(TRACKS.jump_lead * abs(jumps[k]), 2 * STATION_STEP), TRACKS.longest_lead, room)
            window = slice(*np.searchsorted(s, [middle - lead, middle + lead]))
            share = np.clip((s[window] - middle) / lead + 0.5, 0.0, 1.0)
            result[window] += jumps[k] * (share**2 * (3 - 2 * share) - (s[window] > middle))
        elif middle - s[0] < s[-1] - middle:   # the place or two at an end lie aside
            result[:k + 1] += jumps[k]
        else:
            result[k + 1:] -= jumps[k]
    return result


def _between(a, b):
    """The bridged LaneTrack between two others; the road's own shape is in the frame."""
    count = b.first - a.last - 1
    share = np.arange(1, count + 1) / (count + 1)
    # it is moved as far as either, and as doubtful
    d, width, aside = (before + (after - before) * share for before, after in (
        (a.d[-1], b.d[0]), (a.end_width(False), b.end_width(True)), (a.aside[-1], b.aside[0])))
    ends = (a.probability, b.probability, TRACKS.bridged_trust), (a.confidence, b.confidence, TRACKS.trust_bridged)
    sure = (np.full(count, trust * min(before[-1], after[0])) for before, after, trust in ends)
    second = np.full(count, None, object)
    second[:] = [min((reading for reading in (a.second[-1], b.second[0]) if reading is not None),
                     key=lambda reading: reading.nats, default=None)] * count
    return LaneTrack(a.last + 1, d, width, np.full(count, BRIDGED), np.ones(count, bool), *[np.full(count, -1)] * 4, *sure, a.direction,
                     second, aside)


def connect(tracks: list[LaneTrack], longest: float) -> list[LaneTrack]:
    """Lanes joined end to start over gaps of all lines up to `longest`, m, where one faces exactly one other: never across a split or merge."""
    tracks = sorted(tracks, key=lambda track: (track.first, float(track.d[0])))
    firsts, reach = np.array([track.first for track in tracks], int), int((longest + TRACKS.gap_neighbourhood) / STATION_STEP)
    ahead: list[list[int]] = []
    behind: list[list[int]] = [[] for _ in tracks]
    for i, a in enumerate(tracks):
        check_cancelled()
        window = range(*np.searchsorted(firsts, [a.last + 1, a.last + 2 + reach]).tolist())
        facing = [j for j in window if abs(tracks[j].d[0] - a.d[-1]) < max(a.end_width(False), tracks[j].end_width(True)) / 2 + SAME_LANE]
        # what begins beyond the end of the next one is faced by that
        ahead.append([j for j in facing if tracks[j].first <= tracks[facing[0]].last])
        for j in ahead[-1]:
            behind[j].append(i)
    after = {i: of[0] for i, of in enumerate(ahead) if len(of) == 1 and behind[of[0]] == [i] and _goes_on(tracks[i], tracks[of[0]], longest)}
    joined = []
    for i in sorted(set(range(len(tracks))) - set(after.values())):
        parts = [tracks[i]]
        while i in after:
            parts += [_between(tracks[i], tracks[after[i]]), tracks[after[i]]]
            i = after[i]
        joined.append(LaneTrack.joined(parts))
    return joined


def _goes_on(a, b, longest):
    """Whether one lane goes on as another: it leads the same way, is about as wide and lies about where the other one does."""
    wa, wb = a.end_width(False), b.end_width(True)
    return a.direction == b.direction and (b.first - a.last - 1) * STATION_STEP <= longest \
        and abs(b.d[0] - a.d[-1]) <= TRACKS.max_lane_jump_share * min(wa, wb) and abs(wa - wb) <= 2 * TRACKS.max_lane_jump_share * max(wa, wb)


def spans_of(tracks: Sequence[LaneTrack]) -> RowSpans:
    """The stations that each track runs over, to ask which are near a place."""
    return RowSpans(np.array([track.first for track in tracks], int), np.array([len(track) for track in tracks], int),
                    max((track.last + 1 for track in tracks), default=0))
