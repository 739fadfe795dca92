"""Check that the result of an earlier stage belongs to the trajectory it is used with.

Stations start where the road of a trajectory begins. With another trajectory, or another part of the same one, every
station in a file refers to another position.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..common.errors import RoadExtractionError

if TYPE_CHECKING:
    from ..common.features import Features
    from .frame.road_frame import RoadFrame
    from .store.road_points import RoadPoints

STATION_TOLERANCE = 1.0    # m: far more than rounding, far less than the shift of another drive
# m from the roads: the widest corridor and an arm of a side street beyond it; the nodes compared are 5 m apart
REACH_OF_ROADS, NODES_APART = 200.0, 50
CHECKED_SECTIONS, CHECKED_POINTS_PER_SECTION = 50, 200  # evenly over the file


def check_features_on_roads(features: Features, frame: RoadFrame, label: str) -> None:
    """Refuse features whose field `station_m` disagrees with their position in the road frame.

    Parameters
    ----------
    features : Features with the fields `road` and `station_m`
    frame : RoadFrame
    label : name of the input, as at the beginning of a sentence

    Raises
    ------
    RoadExtractionError
        If more than half of them disagree.
    """
    import shapely

    agree = []
    for geometry, row in features:
        if row.get("station_m") is not None:
            x, y = shapely.get_coordinates(geometry).T[:2]
            agree.append(_station_agrees(frame, row["road"], x, y, row["station_m"]))
    _refuse_mismatch(agree, label, "features")


def keep_near_roads(features: Features, frame: RoadFrame, label: str) -> str:
    """Leave out what lies so far from the roads that it was drawn or written there by mistake: work goes with the length of lines.

    Parameters
    ----------
    features : Features in map coordinates, which are changed: points and polygons go whole, of lines the vertices far away
    frame : RoadFrame
    label : name of the input, as at the beginning of a sentence

    Returns
    -------
    What to tell of it, "" where all lies near
    """
    import shapely
    from scipy.spatial import cKDTree

    shapes = np.asarray(features.geometries, object)
    if not len(shapes):
        return ""
    places, owner = shapely.get_coordinates(shapes, include_z=True, return_index=True)
    local = np.column_stack(frame.to_local(places[:, 0], places[:, 1]))
    nodes = np.concatenate([np.column_stack([road.x, road.y])[::NODES_APART] for road in frame.roads])
    low, high = nodes.min(axis=0) - REACH_OF_ROADS, nodes.max(axis=0) + REACH_OF_ROADS
    far = ~((local >= low) & (local <= high)).all(axis=1)
    far[~far] = ~np.isfinite(cKDTree(nodes).query(local[~far], distance_upper_bound=REACH_OF_ROADS)[0])
    if not far.any():
        return ""
    lines = shapely.get_type_id(shapes) == shapely.GeometryType.LINESTRING
    kept = np.bincount(owner[~far], minlength=len(shapes))
    touched = np.unique(owner[far])
    cut = touched[lines[touched] & (kept[touched] > 1)]
    for row in cut.tolist():
        features.geometries[row] = shapely.linestrings(places[(owner == row) & ~far])
    gone = set(touched.tolist()) - set(cut.tolist())
    example = places[int(np.argmax(far))]
    features.geometries[:], features.rows[:] = ([value for row, value in enumerate(values) if row not in gone]
                                                for values in (features.geometries, features.rows))
    return (f"{label}: {np.count_nonzero(far):,} of {len(far):,} vertices lie more than {REACH_OF_ROADS:.0f} m from the trajectory, the first at "
            f"{example[0]:.1f}, {example[1]:.1f}. They were left out, and {len(gone):,} of {len(shapes):,} features with them.")


def check_road_points_on_roads(road_points: RoadPoints, frame: RoadFrame, label: str) -> None:
    """Refuse road points whose stations disagree with their positions in the road frame, judged by a sample.

    Parameters
    ----------
    road_points : RoadPoints
    frame : RoadFrame
    label : name of the input, as at the beginning of a sentence

    Raises
    ------
    RoadExtractionError
        If more than half of the sampled points disagree.
    """
    agree = [np.abs(_stations(frame, road, x, y) - s) <= STATION_TOLERANCE for road, x, y, s in sample_road_points(road_points)]
    _refuse_mismatch(np.concatenate(agree) if agree else [], label, "points looked at")


def sample_road_points(road_points: RoadPoints) -> Iterator[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
    """A sample of road points, evenly over the file.

    Yields
    ------
    road number, (N,) x and y in map coordinates, and (N,) stations in metres, section by section
    """
    keys = road_points.all_sections()
    for k in np.unique(np.linspace(0, len(keys) - 1, CHECKED_SECTIONS).astype(int)) if keys else ():
        road, number = keys[k]
        points = road_points.section(road, number)
        rows = np.unique(np.linspace(0, len(points) - 1, CHECKED_POINTS_PER_SECTION).astype(int))
        yield road, points.x[rows] + road_points.origin[0], points.y[rows] + road_points.origin[1], points.s[rows]


def _station_agrees(frame, road, x, y, station):
    """Whether the stations of the vertices of a feature include its field `station_m`."""
    s = _stations(frame, road, x, y)
    s = s[np.isfinite(s)]
    return len(s) > 0 and s.min() - STATION_TOLERANCE <= station <= s.max() + STATION_TOLERANCE


def _stations(frame, road, x, y):
    """(N,) stations of map coordinates on a road; NaN beside it, or if there is no such road."""
    if road is None or not 0 <= road < len(frame.roads):
        return np.full(len(x), np.nan)
    return frame.road(road).locate(*frame.to_local(x, y))[0]


def _refuse_mismatch(agree, label, what):
    agree = np.asarray(agree, bool)
    if len(agree) and agree.mean() < 0.5:
        raise RoadExtractionError(
            f"{label} and the trajectory do not belong together: only {np.count_nonzero(agree)} of {len(agree)} {what} lie "
            "at the station they carry. Give the trajectory that they were made with, whole.")
