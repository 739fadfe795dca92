"""The trajectory from whatever the user has: a layer, a table, or the file itself."""

from pathlib import Path

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsVectorLayer, QgsWkbTypes

from ..core.errors import RoadExtractionError
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

    Such a file passes as an empty stand-in layer; whether it can be read is said
    by the reader, in its own words.
    """
    accepted = dict(parameters)
    for name in algorithm.TRAJECTORIES:
        path = trajectory_path(parameters.get(name))
        if path is not None and path.is_file():
            stand_in = QgsVectorLayer("Point", "trajectory", "memory")
            context.temporaryLayerStore().addMapLayer(stand_in)
            accepted[name] = stand_in.id()
    return accepted


def read_trajectory_source(source, label):
    """A point layer, line layer or table as the core's Trajectory (not yet cleaned)."""
    from ..core.survey.trajectory import Trajectory

    names = [field.name() for field in source.fields()]
    roles = column_roles(names)
    kind = QgsWkbTypes.geometryType(source.wkbType())
    if kind == QgsWkbTypes.GeometryType.LineGeometry:
        return _from_lines(source, label)
    has_points = kind == QgsWkbTypes.GeometryType.PointGeometry
    columns = {role: [] for role in ("time", "x", "y", "z", "roll", "pitch", "heading")}
    missing = [role for role in ("x", "y", "z") if role not in roles]
    if not has_points and missing:
        raise RoadExtractionError(
            tr("{label} is a table with the columns {names}; x, y and z are needed. Name the columns so, or run Import trajectory.").format(
                label=label, names=", ".join(names)
            )
        )
    with_z = has_points and QgsWkbTypes.hasZ(source.wkbType())
    if has_points and not with_z and "z" not in roles:
        raise RoadExtractionError(
            tr("{label} has points without heights and no column z. Use a layer with Z, or add the heights as a column z.").format(label=label)
        )
    for feature in source.getFeatures():
        place = {}
        if has_points:
            geometry = feature.geometry()
            if geometry.isNull() or geometry.isEmpty():
                continue
            vertex = next(geometry.vertices())
            place = {"x": vertex.x(), "y": vertex.y()}
            if with_z:
                place["z"] = vertex.z()
        for role, values in columns.items():
            if role in place:
                values.append(place[role])
            else:
                values.append(_number(feature.attribute(roles[role])) if role in roles else np.nan)
    arrays = {role: np.array(values, float) for role, values in columns.items()}
    has_time = "time" in roles and np.isfinite(arrays["time"]).any()
    if not has_time:
        arrays["time"] = np.arange(len(arrays["x"]), dtype=float)
    return Trajectory(**arrays, crs=crs_text(source.sourceCrs()), has_time=has_time)


def _from_lines(source, label):
    """Vertices in drawing order; M, where there is one, is the time."""
    from ..core.survey.trajectory import Trajectory

    if not QgsWkbTypes.hasZ(source.wkbType()):
        raise RoadExtractionError(tr("{label} has lines without heights (Z). Use a line layer with Z.").format(label=label))
    has_time = QgsWkbTypes.hasM(source.wkbType())
    rows = []
    for feature in source.getFeatures():
        rows += [(v.x(), v.y(), v.z(), v.m() if has_time else 0.0) for v in feature.geometry().vertices()]
    x, y, z, time = np.array(rows, float).reshape(-1, 4).T
    if not has_time:
        time = np.arange(len(x), dtype=float)
    return Trajectory(time, x, y, z, crs=crs_text(source.sourceCrs()), has_time=has_time)


def column_roles(names):
    """Which column is time, x, y, z, roll, pitch, heading: the same words as for files."""
    from ..core.survey.trajectory_file import columns_by_role

    return columns_by_role(names)


def _number(value):
    try:
        return float(value)
    except (TypeError, ValueError):
        return np.nan


def trajectory_features(trajectory):
    """A cleaned trajectory as a point layer, each row with its road, pass and station where it has one."""
    import shapely

    from ..core.features import Features
    from ..core.schemas import TRAJECTORY

    placed = [(None, None, None)] * len(trajectory)
    if not QgsCoordinateReferenceSystem.fromWkt(trajectory.crs).isGeographic():
        placed = _road_pass_station(trajectory)
    points = shapely.points(np.c_[trajectory.x, trajectory.y, trajectory.z])
    columns = (trajectory.time if trajectory.has_time else np.full(len(trajectory), np.nan),
               trajectory.roll, trajectory.pitch, trajectory.heading)
    rows = [
        dict(zip(("time", "roll", "pitch", "heading", "road", "pass", "station_m"), (*values, *where)))
        for values, where in zip(np.c_[columns].T.tolist(), placed)
    ]
    return Features("PointZ", TRAJECTORY, list(points), rows, trajectory.crs)


def _road_pass_station(trajectory):
    """(road, pass, station) of every row; None in stretches too short to be a pass."""
    from ..core.survey.road_frame import build_frame

    found = [(None, None, None)] * len(trajectory)
    for driven in build_frame(trajectory).passes:
        rows = np.flatnonzero((trajectory.time >= driven.time[0]) & (trajectory.time <= driven.time[-1]))
        for row, station in zip(rows, driven.station_at(trajectory.time[rows])):
            found[row] = (driven.road, driven.number, float(station))
    return found
