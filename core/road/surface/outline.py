"""Outlines of the road surface: one polygon for each stretch of one status."""

import numpy as np
import shapely

from .ground_grid import COLUMN_WIDTH, ROW_LENGTH

MIN_STATUS_LENGTH = 5.0  # m: a shorter change of status is not drawn


def add_outlines(surface, frame, road, carriageway, points_per_row):
    """Add the polygons of one road, left limit forth and right limit back, to `surface`.

    Stretches of one status meet in the two vertices they share.
    """
    cells = carriageway.cells
    there = np.isfinite(carriageway.left) & np.isfinite(carriageway.right)
    measured = _without_short_runs(carriageway.left_bounded & carriageway.right_bounded, int(MIN_STATUS_LENGTH / ROW_LENGTH))
    kind = np.where(there, np.where(measured, 2, 1), 0)
    cuts = np.r_[0, np.flatnonzero(np.diff(kind)) + 1, len(kind)]
    for a, b in zip(cuts[:-1], cuts[1:]):
        if not kind[a]:
            continue
        # the next stretch begins at this one's last vertices
        last = min(b, len(kind) - 1) if b < len(kind) and kind[b] else b - 1
        rows = np.arange(a, last + 1)
        if len(rows) < 2:
            continue
        stations = cells.stations[rows]
        sides = []
        for offset in (carriageway.left[rows], carriageway.right[rows]):
            column = np.clip(np.floor(offset / COLUMN_WIDTH).astype(int) - cells.first_column, 0, cells.height.shape[1] - 1)
            x, y, z = frame.to_map(road, stations, offset, carriageway.height[rows, column].astype(float))
            sides.append(np.c_[x, y, z])
        ring = np.round(np.concatenate([sides[0], sides[1][::-1]]), 4)
        polygon = shapely.Polygon(ring)
        if not polygon.is_valid:
            polygon = _largest(shapely.make_valid(polygon))
        if polygon is None or polygon.is_empty:
            continue
        surface.add(polygon, road=int(road), status="measured" if kind[a] == 2 else "grown",
                    station_m=round(float(stations[0]), 3), end_m=round(float(stations[-1]), 3),
                    area_m2=round(float(polygon.area), 3), points=int(points_per_row[a:b].sum()))


def _without_short_runs(mask, shortest):
    """The mask with runs shorter than `shortest` rows given to their surroundings, True runs first."""
    mask = mask.copy()
    for value in (True, False):
        cuts = np.r_[0, np.flatnonzero(np.diff(mask.astype(int))) + 1, len(mask)]
        for a, b in zip(cuts[:-1], cuts[1:]):
            if mask[a] == value and b - a < shortest and (a > 0 or b < len(mask)):
                mask[a:b] = not value
    return mask


def _largest(geometry):
    """The largest polygon of a geometry, None where there is none."""
    parts = [part for part in getattr(geometry, "geoms", [geometry]) if part.geom_type == "Polygon"]
    return max(parts, key=lambda part: part.area) if parts else None
