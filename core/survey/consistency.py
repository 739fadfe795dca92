"""Check that the result of an earlier stage belongs to the trajectory it is used with.

Stations start where the road of a trajectory begins. With another trajectory, or another part of the same one, every station in a file refers to
another position. Offsets are counted from its way: where a trajectory beside its scanners was moved to them as the points were read, offsets in a
file are those of the way as moved. One that was moved in height alone shows as a road on which its vehicle cannot have driven.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from ..common.errors import RoadExtractionError
from ..common.features import Features
from ..lazy import shapely
from .frame.placement import located
from .frame.road_frame import RoadFrame
from .store.road_points import RoadPoints
from .weights import FRAME, MIRROR, VEHICLE

WITH_ANOTHER = "they were made with another one, or one moved to the scanners. Run Road map, which makes all layers with the moved trajectory."
CHECKED_SECTIONS, CHECKED_POINTS_PER_SECTION = 50, 200  # cost: evenly over the file


def check_features_on_roads(features: Features, frame: RoadFrame, label: str) -> None:
    """Refuse features whose fields `station_m` and `offset_m` disagree with their position in the road frame, or that lie at heights of another.

    features : Features with the fields `road` and `station_m`, and maybe `offset_m`
    label : name of the input, as at the beginning of a sentence

    Raises RoadExtractionError if more than half of them disagree.
    """
    seen = []
    for geometry, row in features:
        if row.get("station_m") is None:
            continue
        x, y, z = shapely.get_coordinates(geometry, include_z=True).T
        s, d = located(frame, np.full(len(x), -1 if row["road"] is None else row["road"]), *frame.to_local(x, y))
        inside = np.isfinite(s)
        above = [np.median(_above(frame, row["road"], s[inside], z[inside]))] if inside.any() else []
        agrees = bool(above) and abs(_outside(s[inside], row["station_m"])) <= FRAME.station_tolerance
        seen.append(([agrees], [_outside(d[inside], row["offset_m"])] if agrees and row.get("offset_m") is not None else [], above))
    _refuse_misplaced(seen, label, "features")


def keep_near_roads(features: Features, frame: RoadFrame, label: str) -> str:
    """Leave out what lies so far from the roads that it was drawn or written there by mistake: work goes with the length of lines.

    features : Features in map coordinates, which are changed: points and polygons go whole, of lines the vertices far away
    label : name of the input, as at the beginning of a sentence

    Returns what to tell of it, "" where all lies near
    """
    shapes = np.asarray(features.geometries, object)
    if not len(shapes):
        return ""
    places, owner = shapely.get_coordinates(shapes, include_z=True, return_index=True)
    local = np.column_stack(frame.to_local(places[:, 0], places[:, 1]))
    nodes = np.concatenate([np.column_stack([road.x, road.y])[::FRAME.nodes_apart] for road in frame.roads])
    low, high = nodes.min(axis=0) - FRAME.reach_of_roads, nodes.max(axis=0) + FRAME.reach_of_roads
    far = ~((local >= low) & (local <= high)).all(axis=1)
    far[~far] = ~np.isfinite(cKDTree(nodes).query(local[~far], distance_upper_bound=FRAME.reach_of_roads)[0])
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
    return (f"{label}: {np.count_nonzero(far):,} of {len(far):,} vertices lie more than {FRAME.reach_of_roads:.0f} m from the trajectory, "
            f"the first at {example[0]:.1f}, {example[1]:.1f}. They were left out, and {len(gone):,} of {len(shapes):,} features with them.")


def check_road_points_on_roads(road_points: RoadPoints, frame: RoadFrame, label: str) -> None:
    """Refuse road points whose stations, offsets or heights disagree with their positions in the road frame, judged by a sample.

    label : name of the input, as at the beginning of a sentence

    Raises RoadExtractionError if more than half of the sampled points disagree.
    """
    seen = []
    for road, x, y, s, d, z in sample_road_points(road_points):
        station, offset = located(frame, np.full(len(x), road), *frame.to_local(x, y))
        agree = np.abs(station - s) <= FRAME.station_tolerance
        seen.append((agree, (d - offset)[agree], _above(frame, road, s[agree], z[agree]) if agree.any() else []))
    _refuse_misplaced(seen, label, "points looked at")


def sample_road_points(road_points: RoadPoints) -> Iterator[tuple[int, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
    """A sample of road points, evenly over the file.

    Yields road number, (N,) x and y in map coordinates, (N,) stations and offsets in metres, and (N,) z, section by section
    """
    keys = road_points.all_sections()
    for k in np.unique(np.linspace(0, len(keys) - 1, CHECKED_SECTIONS).astype(int)) if keys else ():
        road, number = keys[k]
        points = road_points.section(road, number)
        rows = np.unique(np.linspace(0, len(points) - 1, CHECKED_POINTS_PER_SECTION).astype(int))
        yield road, points.x[rows] + road_points.origin[0], points.y[rows] + road_points.origin[1], points.s[rows], points.d[rows], \
            points.z[rows] + road_points.origin[2]


def _outside(values, carried):
    """m that a number lies above the range of (N,) values, negative below it; 0 within."""
    return float(carried - np.clip(carried, values.min(), values.max()))


def _above(frame, road, s, z):
    """(N,) m of the trajectory above z at stations of a road; NaN where there is no height, as of what was drawn on the map."""
    return np.where(z == 0.0, np.nan, frame.track_height(road, s) + frame.origin[2] - z)


def _refuse_misplaced(seen, label, what):
    """Refuse what for the most part disagrees with its stations, lies beside its offsets, or lies where no vehicle is.

    seen : of each part whether its entries agree, (N,) m that they lie to the left, and (M,) m that they lie below the trajectory
    """
    if not seen:
        return
    agree, beside, above = (np.concatenate(column) for column in zip(*seen))
    above = above[np.isfinite(above)]
    if len(agree) and agree.mean() < 0.5:
        raise RoadExtractionError(f"{label} and the trajectory do not belong together: only {np.count_nonzero(agree)} of {len(agree)} {what} lie at "
                                  "the station they carry. Give the trajectory that they were made with, whole.")
    if np.count_nonzero(np.abs(beside) > FRAME.offset_tolerance) > 0.5 * len(beside):
        raise RoadExtractionError(f"{label} lie {np.median(np.abs(beside)):.2f} m beside the offsets they carry: {WITH_ANOTHER}")
    if np.count_nonzero((above < -VEHICLE.lowest_sensor) | (above > MIRROR.heights[1])) > 0.5 * len(above):
        depth = float(np.median(above))
        raise RoadExtractionError(f"{label} lie {abs(depth):.2f} m {'below' if depth > 0 else 'above'} the trajectory, where its vehicle cannot have "
                                  f"driven: {WITH_ANOTHER}")
