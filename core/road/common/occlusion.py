"""What the scanner saw beside the road: ground, or something tall in front of it.

A missing curb is hidden only where no ground was measured at its place and
something tall stands between it and the vehicle. Ground seen there means that the
road is open: a driveway, a junction.
"""

import numpy as np

OCCLUSION_CELL = 0.25      # m across
MIN_OCCLUDER_HEIGHT = 0.45      # m above the expected road: what can hide a curb
MAX_BOTTOM_DIFFERENCE = 0.30       # m about the curb's bottom within which ground counts as seen
HIDDEN_POINT_SPACING = 0.5  # m along the road between two points of hidden curb, and the length that each stands for
SHADOW_REACH = 3.0       # m along the road: scanners look askew, so does the shadow


class OcclusionGrid:
    """Ground and tall things of one side of a road on a grid of profiles and cells of 0.25 m.

    Heights of the ground are above the expected road, NaN where none was seen.
    """

    def __init__(self, width, first, count, reach):
        self.width, self.first = width, first
        self.cells = int(np.ceil(reach / OCCLUSION_CELL))
        self.ground = np.full((count, self.cells), np.nan, np.float32)
        self.tall = np.zeros((count, self.cells), bool)

    def add_points(self, u, s, h, profiles, lines):
        """Note the points and pseudo scan-lines of some profiles (first, last + 1); passes add up."""
        first, last = profiles[0] - self.first, profiles[1] - self.first
        row = np.floor(s / self.width).astype(np.int64) - self.first
        cell = np.floor(u / OCCLUSION_CELL).astype(np.int64)
        tall = (h > MIN_OCCLUDER_HEIGHT) & (cell >= 0) & (cell < self.cells) & (row >= first) & (row < last)
        self.tall[row[tall], cell[tall]] = True
        place = np.clip((lines.offset(np.arange(lines.shape[1])) / OCCLUSION_CELL).astype(np.int64), 0, self.cells - 1)
        starts = np.flatnonzero(np.r_[True, np.diff(place) > 0])
        lowest = np.fmin.reduceat(lines.low, starts, axis=1)
        seen = self.ground[first:last]
        seen[:, place[starts]] = np.fmin(seen[:, place[starts]], lowest)

    def add_level_ground(self, profiles, nearest, farthest, height):
        """Note that some profiles (first, last + 1) have ground everywhere between two offsets, (R,) each, at a height."""
        cell = np.arange(self.cells) * OCCLUSION_CELL
        there = (cell >= nearest[:, None]) & (cell + OCCLUSION_CELL <= farthest[:, None])
        seen = self.ground[profiles[0] - self.first:profiles[1] - self.first]
        seen[:] = np.where(there, np.fmin(seen, height[:, None]), seen)

    def hidden(self, s, u, h, near):
        """(N,) bool: is a curb expected at station s, offset u and height h hidden from view?

        near : (N,) offset of the vehicle's track, metres
        """
        rows = len(self.ground)
        row = np.clip(np.floor(s / self.width).astype(np.int64) - self.first, 0, rows - 1)
        cell = np.floor(u / OCCLUSION_CELL).astype(np.int64)
        offsets = cell[:, None] + np.arange(-1, 2)
        inside = (offsets >= 0) & (offsets < self.cells)
        there = self.ground[row[:, None], np.clip(offsets, 0, self.cells - 1)]
        with np.errstate(invalid="ignore"):
            seen = inside & (np.abs(there - h[:, None]) < MAX_BOTTOM_DIFFERENCE)
        # cumulative counts answer "anything tall within these rows and cells" at once
        sums = np.zeros((rows + 1, self.cells + 1), np.int32)
        np.cumsum(np.cumsum(self.tall, 0, np.int32), 1, np.int32, out=sums[1:, 1:])
        lean = int(round(SHADOW_REACH / self.width))
        r0, r1 = np.clip(row - lean, 0, rows), np.clip(row + lean + 1, 0, rows)
        c0 = np.clip(np.floor(near / OCCLUSION_CELL).astype(np.int64) + 3, 0, self.cells)
        c1 = np.maximum(np.clip(cell + 1, 0, self.cells), c0)
        tall = sums[r1, c1] - sums[r0, c1] - sums[r1, c0] + sums[r0, c0]
        return (seen.sum(1) < 2) & (tall > 0)
