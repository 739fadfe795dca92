"""Lanes that several roads read from the same asphalt, as an exit and its motorway or two carriageways side by side do: one road keeps each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely

from ..common.arrays import mask_runs
from ..common.parallel import check_cancelled
from ..markings.cross_section.evidence import driven_offsets
from ..markings.cross_section.sections import STATION_STEP
from ..markings.weights import EVIDENCE
from ..survey.frame.road_frame import RoadFrame
from ..survey.weights import FRAME
from .alignment import LanesOfRoad
from .lane_track import LaneTrack, spans_of
from .weights import TRACKS


def lanes_once(roads: Sequence[LanesOfRoad], frame: RoadFrame, shortest: float) -> list[LanesOfRoad]:
    """The roads with every lane of the asphalt in one of them; the lanes of each by first station, then from right to left.

    Two lanes are one where they lie along each other and the middle of the narrower one lies in the other, on one level. As far as they are one, it
    is of the road that drove in it. Of two that did, or did not, it is of the one whose lane would else be cut in two, then of the one driven
    nearer, then of the surer one.

    shortest : m, what is left of a lane and is shorter is left out
    """
    lanes = [[_Lane(road, track, frame) for track in road.tracks] for road in roads]
    if not any(lanes):
        return list(roads)
    spans = [spans_of(road.tracks) for road in roads]
    flat = [(k, lane) for k, of_road in enumerate(lanes) for lane in of_road]
    near = shapely.STRtree([_rectangle(lane.places, 0.0) for _, lane in flat])
    reached = [_rectangle(np.stack([road.road.x, road.road.y]), FRAME.corridor) for road in roads]
    for j, number in sorted(zip(*near.query(reached).tolist())):
        k, lane = flat[number]
        if k < j and lanes[j]:
            check_cancelled()
            _part(lane, lanes[j], spans[j])
    result = []
    for road, of_road in zip(roads, lanes):
        kept = [part for lane in of_road for part in lane.stretches(lane.kept, shortest)]
        of_others = [part for lane in of_road for part in lane.stretches(~lane.kept)]
        result.append(replace(road, tracks=sorted(kept, key=lambda track: (track.first, float(track.d[0]))), of_others=of_others))
    return result


@dataclass
class _Lane:
    """A lane of a road, and which of its places it has kept."""

    road: LanesOfRoad
    track: LaneTrack
    frame: RoadFrame

    def __post_init__(self) -> None:
        self.kept = np.ones(len(self.track), bool)

    @cached_property
    def s(self):
        """(N,) m, its stations."""
        return self.road.s[self.track.first:self.track.last + 1]

    @cached_property
    def places(self):
        """(2, N) m, its middle in local coordinates."""
        return np.stack(self.road.road.to_map(self.s, self.track.d))

    @cached_property
    def beside(self):
        """(N,) m, from the nearest pass of its road to its nearer border, 0 where a pass drove in it; inf where none did beside it."""
        driven, _ = driven_offsets(self.frame, self.road.road.number, self.s)
        distance = np.where(np.isnan(driven), np.inf, np.abs(driven - self.track.d)).min(axis=0, initial=np.inf)
        return np.maximum(distance - self.track.width / 2, 0.0)

    def claim(self, places: slice) -> tuple[bool, bool, float, float, int]:
        """What decides whose lane some of the places are, the least first."""
        far = float(np.minimum(self.beside[places], FRAME.corridor).mean())
        ends = places.start == 0 or places.stop == len(self.track)
        return 2 * np.count_nonzero(self.beside[places]) > places.stop - places.start, ends, far, -float(self.track.confidence[places].mean()), \
            self.road.road.number

    def stretches(self, places: np.ndarray, shortest: float = 0.0) -> list[LaneTrack]:
        """The parts of the track at some of its places, (N,) bool, that are not shorter than `shortest`, m."""
        return [self.track.part(first, end) for first, end in mask_runs(places) if (end - first) * STATION_STEP >= shortest]


def _rectangle(places, beyond):
    """The rectangle about (2, N) places, larger by some metres on each side."""
    return shapely.box(*(places.min(axis=1) - beyond), *(places.max(axis=1) + beyond))


def _part(lane, others, spans):
    """Take from a lane and from those of another road what the other one keeps; `spans` : the stations of the others."""
    road = others[0].road
    station, d = road.road.locate(*lane.places)
    at = np.rint((station - road.s[0]) / STATION_STEP)
    along = np.isfinite(station)
    along[along] &= (at[along] >= 0) & (at[along] < len(road.s))
    if not along.any():
        return
    at = np.where(along, at, -1).astype(int)
    for number in spans.near(int(at[along].min()), int(at.max())).tolist():
        other = others[number]
        for of_lane, of_other in _one_lane(lane, other, station, at, d):
            loser, places = max((lane, of_lane), (other, of_other), key=lambda claimed: claimed[0].claim(claimed[1]))
            loser.kept[places] = False


def _one_lane(lane, other, station, at, d):
    """(places of the one, places of the other) of the stretches on which two lanes are one.

    station, at, d : (N,) m, number on the grid and m, of the places of the one on the road of the other
    """
    row = at - other.track.first
    both = (at >= 0) & (row >= 0) & (row < len(other.track)) & lane.kept
    row = np.where(both, row, 0)
    both &= other.kept[row]
    same = both & (np.abs(d - other.track.d[row]) < np.maximum(lane.track.width, other.track.width[row]) / 2)
    same &= np.abs(np.gradient(d)) < EVIDENCE.along * np.abs(np.gradient(station)) if len(d) > 1 else False
    if not same.any():
        return
    heights = (of.frame.track_height(of.road.road.number, s[same]) for of, s in ((lane, lane.s), (other, station)))
    same[same] = np.abs(np.subtract(*heights)) < FRAME.level_separation
    gap = int(TRACKS.gap_neighbourhood / STATION_STEP)
    for first, end in mask_runs(~same):
        if first and end < len(same) and end - first < gap and both[first:end].all():
            same[first:end] = True
    for first, end in mask_runs(same):
        yield slice(first, end), slice(int(row[first:end].min()), int(row[first:end].max()) + 1)
