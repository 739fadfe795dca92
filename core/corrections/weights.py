"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class _CorrectionWeights:
    """What a correction of an analyst is about, and what it changes."""

    step: float = 0.25   # m between the places at which a line is compared with a correction
    shortest: float = 1.0   # m of a line along a correction that counts: a line that only crosses it does not
    shortest_rest: float = 0.5   # m: a shorter rest of a line goes with the stretch that is cut from it
    no_length: float = 1e-3   # m: sums of lengths differ in their last digits
    along: float = 0.5   # share of its length by which a stretch advances along the correction: one that crosses it does not
    moved_from: float = 2.0   # m beside its new place at most that a line is moved from; half of a lane is more than that
    near_vertices: float = 10.0   # m within which the map's own vertices tell the height of what was drawn
    height_neighbours: int = 8   # vertices whose heights are averaged, by the inverse of their distance
    taken_reach: float = 0.5   # m beside its place, of a lane that the estimate made as it was taken,
    taken_share: float = 0.8   # and share of its length
    most_lost: float = 0.5   # share of a curve that may be taken away before its elements go with it


CORRECTING = _CorrectionWeights()
