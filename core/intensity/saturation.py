"""Intensities cut off at an end of their range, by a scanner or by an export: what the cloud no longer tells."""

from dataclasses import dataclass

import numpy as np

from ..common.parallel import ordered_map
from .asphalt_model import LEVELS, LOWER, to_intensity, to_level

HIGHEST = 0.05   # share of points at their scanner's highest intensity: more than paint covers of most roads
LOWEST = LOWER   # share at its lowest: where asphalt's spread is taken from
FULL = "Export the cloud with the scanner's full intensities (16 bits, not stretched)."
AT_ONCE = 1 << 15


@dataclass(frozen=True)
class Clipping:
    """The ends of a road's intensities.

    lowest, highest : intensities
    at_lowest, at_highest : shares of points within 1.1 % of their scanner's, 0 where those are not piled up there
    """

    lowest: float = float("nan")
    at_lowest: float = 0.0
    highest: float = float("nan")
    at_highest: float = 0.0

    @classmethod
    def of(cls, levels, highest=None):
        """Clipping of (scanners, LEVELS) counts of points; `highest` where it is known to the unit."""
        levels = levels[levels.any(axis=1)]
        if not len(levels):
            return cls()
        ends = [[_piled(row[way]) for row in levels] for way in (slice(None), slice(None, None, -1))]
        total, used = levels.sum(), np.flatnonzero(levels.any(axis=0))
        at_lowest, at_highest = (float(sum(side) / total) for side in ends)
        low, high = np.rint(to_intensity(used[[0, -1]])).tolist()
        return cls(low, at_lowest, high if highest is None else float(highest), at_highest)

    @property
    def warning(self):
        """What to tell the user of it, "" where nothing was cut off."""
        texts = []
        if self.at_highest >= HIGHEST:
            texts.append(f"{100 * self.at_highest:.0f} % of the road's points have the highest intensity, {self.highest:.0f}: what was "
                         "brighter has been cut off, so that paint there may be no brighter than asphalt and be missed.")
        if self.at_lowest >= LOWEST:
            texts.append(f"{100 * self.at_lowest:.0f} % of the road's points have the lowest intensity, {self.lowest:.0f}: what was darker "
                         "has been cut off, so that asphalt seems to be all of one tone and bright spots of it may be taken for paint.")
        return " ".join([*texts, FULL]) if texts else ""


def _piled(counts):
    """Points in the first level that has any, if they are more than those of the next two."""
    used = np.flatnonzero(counts)[:3]
    first, *following = counts[used].tolist()
    return first if first > sum(following) and following else 0


def clipping_of(road_points):
    """Clipping of the raw intensities of RoadPoints."""
    def count(key):
        points, found = road_points.section(*key), np.zeros(256 * LEVELS, np.int64)
        intensity, scanner = points.intensity, points.scanner
        for first in range(0, len(points), AT_ONCE):
            rows = slice(first, first + AT_ONCE)
            found += np.bincount(scanner[rows].astype(np.int32) * np.int32(LEVELS) + to_level(intensity[rows]), minlength=len(found))
        return found

    return Clipping.of(sum(ordered_map(count, road_points.all_sections()), np.zeros(256 * LEVELS, np.int64)).reshape(256, LEVELS))
