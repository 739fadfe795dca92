"""How far the middle of the passes over a road may be off, and how that travels from stage to stage with points and layers."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ...common.schemas import PASS_SIGMA
from ...curves.robust import MAD_TO_SIGMA

if TYPE_CHECKING:
    import laspy

    from ...common.features import Features
    from .register import PassOffsets

SIGMA_USER_ID, SIGMA_RECORD = "LanewrightSigma", 1   # of the LAS record
_ROW = np.dtype([("road", "<u4"), ("sigma", "<f8")])


def sigma_of_passes(offsets: list[PassOffsets]) -> float | None:
    """How far the middle of the passes over a road may be off across it, from what they differ.

    Two passes with independent errors of one sigma s differ by s * sqrt(2), and the mean of n of them is off by s / sqrt(n). Single offsets
    that are far off do not count: of the RMS and the median deviation as a sigma the smaller is taken.

    Parameters
    ----------
    offsets : PassOffsets of one road

    Returns
    -------
    m, one sigma; None where no offset was measured
    """
    left = np.concatenate([pair.left[np.isfinite(pair.left)] for pair in offsets] or [np.empty(0)])
    count = len({number for pair in offsets for number in (pair.one, pair.other)})
    if not len(left):
        return None
    apart = min(np.sqrt(np.mean(left**2)), MAD_TO_SIGMA * np.median(np.abs(left)))
    return float(apart / np.sqrt(2 * count))


def to_record(sigma: dict[int, float]) -> list[laspy.VLR]:
    """{road number: m} as a LAS variable length record; none where nothing is known."""
    import laspy

    rows = np.array(sorted(sigma.items()), _ROW)
    return [laspy.VLR(SIGMA_USER_ID, SIGMA_RECORD, "Uncertainty that passes leave", rows.tobytes())] if sigma else []


def of_records(records: Iterable[laspy.VLR]) -> dict[int, float]:
    """{road number: m} as `to_record` wrote it, from the records of a file."""
    for record in records:
        if record.user_id.rstrip("\0") == SIGMA_USER_ID:
            return dict(np.frombuffer(bytes(record.record_data_bytes()), _ROW).tolist())
    return {}


def of_layer(features: Features) -> dict[int, float]:
    """{road number: m} that the rows of a layer hold, such as CURB_POINTS and MARKING_LINES."""
    found = zip(features.column("road"), features.column(PASS_SIGMA.name))
    return {int(road): float(sigma) for road, sigma in found if road is not None and sigma is not None}
