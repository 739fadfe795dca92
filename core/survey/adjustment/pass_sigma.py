"""How far the middle of the passes over a road may be off, and how that travels from stage to stage with points and layers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ...common.features import PASS_SIGMA
from ...curves.robust import MAD_TO_SIGMA
from ..frame.row_table import SigmaAlong
from .register import MAX_OFFSET

if TYPE_CHECKING:
    import laspy

    from ...common.features import Features
    from .register import PassOffsets

SIGMA_REACH = 25.0           # m of road either way over which passes are compared: less would be the noise of single offsets
SIGMA_USER_ID = "LanewrightSigma"   # of the LAS records: FIRST_RECORD and those that follow it, and ROAD_RECORD of earlier versions
ROAD_RECORD, FIRST_RECORD = 1, 2
NODES_PER_RECORD = 5000      # a LAS record holds 65,535 bytes
_ROAD = np.dtype([("road", "<u4"), ("sigma", "<f8")])
_NODE = np.dtype([("road", "<u4"), ("station", "<f4"), ("sigma", "<f4")])


def sigma_of_passes(offsets: list[PassOffsets]) -> SigmaAlong | None:
    """How far the middle of the passes over a road may be off across it, from what they differ, place by place.

    Two passes with independent errors of one sigma s differ by s * sqrt(2), and the mean of n of them is off by s / sqrt(n). Single offsets
    that are far off do not count: of the RMS and the median deviation as a sigma the smaller is taken.

    Parameters
    ----------
    offsets : PassOffsets of one road

    Returns
    -------
    SigmaAlong; None where no offset was measured
    """
    known = [(pair, np.isfinite(pair.left)) for pair in offsets]
    stations = np.concatenate([pair.stations[own] for pair, own in known] or [np.empty(0)])
    if not len(stations):
        return None
    order = np.argsort(stations, kind="stable")
    stations, left = stations[order], np.concatenate([_apart(pair)[own] for pair, own in known])[order]
    one, other = (np.concatenate([np.full(own.sum(), getattr(pair, name)) for pair, own in known])[order] for name in ("one", "other"))
    places = np.unique(stations)
    bounds = np.searchsorted(stations, places - SIGMA_REACH), np.searchsorted(stations, places + SIGMA_REACH, side="right")
    found = []
    for first, end in zip(*bounds):
        apart = min(np.sqrt(np.mean(left[first:end] ** 2)), MAD_TO_SIGMA * np.median(np.abs(left[first:end])))
        found.append(apart / np.sqrt(2 * len({*one[first:end].tolist(), *other[first:end].tolist()})))
    return SigmaAlong(tuple(places.tolist()), tuple(map(float, found)))


def _apart(pair):
    """(N,) m across that two passes lie apart; in any direction where it is more than drift, as roads that cross are off along this one too."""
    anywhere = np.hypot(pair.left, np.nan_to_num(pair.along))
    return np.where(anywhere > MAX_OFFSET, anywhere, pair.left)


def to_record(sigma: dict[int, SigmaAlong]) -> list[laspy.VLR]:
    """{road number: SigmaAlong} as LAS variable length records; none where nothing is known."""
    import laspy

    rows = np.array([(road, *node) for road, along in sorted(sigma.items()) for node in zip(along.stations, along.metres)], _NODE)
    return [laspy.VLR(SIGMA_USER_ID, FIRST_RECORD + k, "Uncertainty that passes leave", rows[first:first + NODES_PER_RECORD].tobytes())
            for k, first in enumerate(range(0, len(rows), NODES_PER_RECORD))]


def of_records(records: Iterable[laspy.VLR]) -> dict[int, SigmaAlong]:
    """{road number: SigmaAlong} as `to_record` wrote it, from the records of a file."""
    own = {record.record_id: bytes(record.record_data_bytes()) for record in records if record.user_id.rstrip("\0") == SIGMA_USER_ID}
    if ROAD_RECORD in own:
        return {road: SigmaAlong.everywhere(metres) for road, metres in np.frombuffer(own[ROAD_RECORD], _ROAD).tolist()}
    rows = np.frombuffer(b"".join(own[number] for number in sorted(own)), _NODE)
    return {road: SigmaAlong(*(tuple(rows[name][rows["road"] == road].tolist()) for name in ("station", "sigma")))
            for road in np.unique(rows["road"]).tolist()}


def of_layer(features: Features) -> dict[int, SigmaAlong]:
    """{road number: SigmaAlong} that the rows of a layer hold, such as CURB_POINTS and MARKING_LINES."""
    found: dict[int, list[tuple[float, float]]] = {}
    for row in features.rows:
        road, metres, start = (row.get(name) for name in ("road", PASS_SIGMA.name, "station_m"))
        if road is not None and metres is not None:
            ends = [place for place in (start, row.get("end_m")) if place is not None]
            found.setdefault(int(road), []).append((float(np.mean(ends)) if ends else 0.0, float(metres)))
    return {road: SigmaAlong.through(*np.array(rows).T) for road, rows in found.items()}
