"""The trajectory from whatever the user has: a layer, a table, or the file itself."""

from pathlib import Path

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsVectorLayer, QgsWkbTypes

from ..core.common.errors import RoadExtractionError
from .layers import crs_text
from .texts import tr

# Files the core reads better than QGIS: headers of any wording, none at all, binary SBET
FILE_SUFFIXES = {".csv", ".txt", ".out", ".sbet", ".xyz", ".pos", ".traj"}


def trajectory_path(value):
    """The path where a TRAJECTORY value names such a file, else None."""
    if not isinstance(value, str) or not value or "|" in value:
        return None
    path = Path(value)
    return path if path.suffix.lower() in FILE_SUFFIXES else None


def accept_trajectory_file(algorithm, parameters, context):
    """Parameters for QGIS's own check, which knows no SBET and no table without a header.

    Such a file passes as an empty stand-in layer; whether it is there and can be
    read is said by the reader, in its own words.
    """
    accepted = dict(parameters)
    for name in algorithm.TRAJECTORIES:
        path = trajectory_path(parameters.get(name))
        if path is not None:
            stand_in = QgsVectorLayer("Point", "trajectory", "memory")
            context.temporaryLayerStore().addMapLayer(stand_in)
            accepted[name] = stand_in.id()
    return accepted


def read_trajectory_source(source, label, crs="", heights_needed=True):
    """A point layer, line layer or table as the core's Trajectory (not yet cleaned); without heights, where none are needed, all are 0."""
    from ..core.survey.trajectory.reader import trajectory_from_columns

    kind = QgsWkbTypes.geometryType(source.wkbType())
    if kind == QgsWkbTypes.GeometryType.LineGeometry:
        columns = _line_columns(source)
    elif kind == QgsWkbTypes.GeometryType.PointGeometry:
        columns = _point_columns(source)
    else:
        columns = _table_columns(source, label)
    if not len(next(iter(columns.values()))):
        raise RoadExtractionError(
            tr("{label} has no rows. Choose the layer that holds the driven positions.").format(label=label)
        )
    if not heights_needed and not np.isfinite(columns.get("z", np.nan)).any():
        columns["z"] = np.zeros(len(next(iter(columns.values()))))
    return trajectory_from_columns(columns, crs or crs_text(source.sourceCrs()), label=label)


def _line_columns(source):
    """Vertices in drawing order; M, where there is one, is the time."""
    has_z, has_m = QgsWkbTypes.hasZ(source.wkbType()), QgsWkbTypes.hasM(source.wkbType())
    rows = [
        (v.x(), v.y(), v.z() if has_z else np.nan, v.m() if has_m else np.nan)
        for feature in source.getFeatures()
        for v in feature.geometry().vertices()
    ]
    x, y, z, time = np.array(rows, float).reshape(-1, 4).T
    return {"x": x, "y": y, **({"z": z} if has_z else {}), **({"time": time} if has_m else {})}


def _point_columns(source):
    """Places from the geometry (the height too, where it has one), the rest from fields."""
    names = _roles(source)
    for role in ("x", "y", "lon", "lat", *(("z",) if QgsWkbTypes.hasZ(source.wkbType()) else ())):
        names.pop(role, None)
    places, fields = [], {role: [] for role in names}
    for feature in source.getFeatures():
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            continue
        vertex = next(geometry.vertices())
        places.append((vertex.x(), vertex.y(), vertex.z()))
        for role, name in names.items():
            fields[role].append(_number(feature.attribute(name)))
    x, y, z = np.array(places, float).reshape(-1, 3).T
    columns = {role: np.array(values, float) for role, values in fields.items()}
    return {"x": x, "y": y, **columns, **({} if "z" in names else {"z": z})}


def _table_columns(source, label):
    names = _roles(source)
    missing = [role for role, other in (("x", "lon"), ("y", "lat"), ("z", "z")) if role not in names and other not in names]
    if missing:
        raise RoadExtractionError(
            tr("{label} is a table with the columns {names}; {missing} cannot be found among them. Name them time, x, y, z, "
               "roll, pitch, heading.").format(
                label=label, names=", ".join(field.name() for field in source.fields()), missing=", ".join(missing))
        )
    rows = [[_number(feature.attribute(name)) for name in names.values()] for feature in source.getFeatures()]
    return dict(zip(names, np.array(rows, float).reshape(-1, len(names)).T))


def _roles(source):
    """Role to field name, by the same words as for files."""
    from ..core.survey.trajectory.columns import columns_by_role

    return columns_by_role([field.name() for field in source.fields()])


def _number(value):
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan


def trajectory_features(trajectory):
    """A cleaned trajectory as a point layer, each row with its road, pass and station where it has one."""
    import shapely

    from ..core.common.features import Features
    from ..core.common.schemas import TRAJECTORY

    placed = [(None, None, None)] * len(trajectory)
    if not QgsCoordinateReferenceSystem.fromWkt(trajectory.crs).isGeographic():
        placed = _road_pass_station(trajectory)
    points = shapely.points(np.c_[trajectory.x, trajectory.y, trajectory.z])
    columns = (trajectory.time if trajectory.has_time else np.full(len(trajectory), np.nan),
               trajectory.roll, trajectory.pitch, trajectory.heading)
    rows = [
        dict(zip(("time", "roll", "pitch", "heading", "road", "pass", "station_m"), (*values, *where)))
        for values, where in zip(np.stack(columns, axis=1).tolist(), placed)
    ]
    return Features("PointZ", TRAJECTORY, list(points), rows, trajectory.crs)


def _road_pass_station(trajectory):
    """(road, pass, station) of every row; None in stretches too short to be a pass."""
    from ..core.survey.frame.road_frame import build_frame

    found = [(None, None, None)] * len(trajectory)
    for driven in build_frame(trajectory).passes:
        rows = np.flatnonzero((trajectory.time >= driven.time[0]) & (trajectory.time <= driven.time[-1]))
        for row, station in zip(rows, driven.station_at(trajectory.time[rows])):
            found[row] = (driven.road, driven.number, float(station))
    return found
