"""Saturated intensities: values that a scanner or an export cut off at an end of their range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.parallel import ordered_map
from ..survey.store.road_points import RoadPoints
from .asphalt_model import INTENSITY_LEVELS, LOWER_QUANTILE, POINTS_AT_ONCE, to_intensity, to_level

MAX_SHARE_AT_HIGHEST = 0.05   # share of points at their scanner's highest intensity: more than paint covers of most roads
MAX_SHARE_AT_LOWEST = LOWER_QUANTILE   # share at its lowest: the quantile from which asphalt's spread is taken
REMEDY = "Export the cloud with the scanner's full intensities (16 bits, not stretched)."
SCANNER_NUMBERS = 256   # numbers that a scanner may have


@dataclass(frozen=True)
class Saturation:
    """The ends of the range of a road's intensities.

    lowest, highest : intensities, raw counts
    at_lowest, at_highest : shares of points within 1.1 % of their scanner's lowest and highest, 0 where they do not accumulate there
    """

    lowest: float = float("nan")
    at_lowest: float = 0.0
    highest: float = float("nan")
    at_highest: float = 0.0

    @classmethod
    def from_levels(cls, levels: np.ndarray, highest: float | None = None) -> Saturation:
        """Saturation of counts of points.

        Parameters
        ----------
        levels : (scanners, INTENSITY_LEVELS) int, how many points have each level
        highest : the highest intensity, where it is known exactly
        """
        levels = levels[levels.any(axis=1)]
        if not len(levels):
            return cls()
        ends = [[_accumulated(row[way]) for row in levels] for way in (slice(None), slice(None, None, -1))]
        total, used = levels.sum(), np.flatnonzero(levels.any(axis=0))
        at_lowest, at_highest = (float(sum(side) / total) for side in ends)
        low, high = np.rint(to_intensity(used[[0, -1]])).tolist()
        return cls(low, at_lowest, high if highest is None else float(highest), at_highest)

    @property
    def warning(self) -> str:
        """What the user should know of it, "" where nothing was cut off."""
        texts = []
        if self.at_highest >= MAX_SHARE_AT_HIGHEST:
            texts.append(f"{100 * self.at_highest:.0f} % of the road's points have the highest intensity, {self.highest:.0f}: brighter values "
                         "were cut off, so that paint there may be no brighter than asphalt and be missed.")
        if self.at_lowest >= MAX_SHARE_AT_LOWEST:
            texts.append(f"{100 * self.at_lowest:.0f} % of the road's points have the lowest intensity, {self.lowest:.0f}: darker values "
                         "were cut off, so that asphalt seems to be of one tone and its bright spots may be taken for paint.")
        return " ".join([*texts, REMEDY]) if texts else ""


def _accumulated(counts):
    """Points in the first level that has any, if they are more than those of the next two; else 0."""
    used = np.flatnonzero(counts)[:3]
    first, *following = counts[used].tolist()
    return first if first > sum(following) and following else 0


def saturation_of(road_points: RoadPoints) -> Saturation:
    """Saturation of the raw intensities of road points."""
    def count(key):
        points, found = road_points.section(*key), np.zeros(SCANNER_NUMBERS * INTENSITY_LEVELS, np.int64)
        intensity, scanner = points.intensity, points.scanner
        for first in range(0, len(points), POINTS_AT_ONCE):
            rows = slice(first, first + POINTS_AT_ONCE)
            found += np.bincount(scanner[rows].astype(np.int32) * np.int32(INTENSITY_LEVELS) + to_level(intensity[rows]), minlength=len(found))
        return found

    counts = sum(ordered_map(count, road_points.all_sections()), np.zeros(SCANNER_NUMBERS * INTENSITY_LEVELS, np.int64))
    return Saturation.from_levels(counts.reshape(SCANNER_NUMBERS, INTENSITY_LEVELS))
