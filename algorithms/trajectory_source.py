"""The trajectory from whatever the user has: a layer, a table, or the file itself."""

import math
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from .texts import tr
from .vector_source import LINE, POINT, vertices_of

# Files the core reads better than QGIS and GDAL: headers of any wording, none at all, binary SBET
FILE_SUFFIXES = {".csv", ".txt", ".out", ".sbet", ".xyz", ".pos", ".traj"}


def trajectory_path(value):
    """The path where a TRAJECTORY value names such a file, else None."""
    if not isinstance(value, str) or not value or "|" in value:
        return None
    path = Path(value)
    return path if path.suffix.lower() in FILE_SUFFIXES else None


def read_trajectory_source(source, crs="", heights_needed=True):
    """A point layer, line layer or table (VectorSource) as the core's Trajectory, not yet cleaned.

    Without heights, where none are needed, all are 0.
    """
    import numpy as np

    from ..core.survey.trajectory.reader import trajectory_from_columns

    if source.kind == LINE:
        columns = _line_columns(source)
    elif source.kind == POINT:
        columns = _point_columns(source)
    else:
        columns = _table_columns(source)
    if not len(next(iter(columns.values()))):
        raise RoadExtractionError(
            tr("{label} has no rows. Choose the layer that holds the driven positions.").format(label=source.label)
        )
    if not heights_needed and not np.isfinite(columns.get("z", np.nan)).any():
        columns["z"] = np.zeros(len(next(iter(columns.values()))))
    return trajectory_from_columns(columns, crs or source.stored_crs, label=source.label)


def _line_columns(source):
    """Vertices in drawing order; M, where there is one, is the time."""
    import numpy as np

    rows = [vertices_of(wkb) for wkb, _ in source.stored_rows(measures=True) if wkb is not None]
    x, y, z, time = np.concatenate([np.empty((0, 4)), *rows]).T
    return {"x": x, "y": y, **({"z": z} if source.has_z else {}), **({"time": time} if source.has_m else {})}


def _point_columns(source):
    """Places from the geometry (the height too, where it has one), the rest from fields."""
    import numpy as np

    names = _roles(source)
    for role in ("x", "y", "lon", "lat", *(("z",) if source.has_z else ())):
        names.pop(role, None)
    index = {role: source.names.index(name) for role, name in names.items()}
    places, fields = [np.empty((0, 4))], {role: [] for role in names}
    for wkb, values in source.stored_rows():
        if wkb is None:
            continue
        places.append(vertices_of(wkb)[:1])
        for role, k in index.items():
            fields[role].append(_number(values[k]))
    x, y, z, _ = np.concatenate(places).T
    columns = {role: np.array(values, float) for role, values in fields.items()}
    return {"x": x, "y": y, **columns, **({} if "z" in names else {"z": z})}


def _table_columns(source):
    import numpy as np

    names = _roles(source)
    missing = [role for role, other in (("x", "lon"), ("y", "lat"), ("z", "z")) if role not in names and other not in names]
    if missing:
        raise RoadExtractionError(
            tr("{label} is a table with the columns {names}; {missing} cannot be found among them. Name them time, x, y, z, "
               "roll, pitch, heading.").format(
                label=source.label, names=", ".join(source.names), missing=", ".join(missing))
        )
    index = [source.names.index(name) for name in names.values()]
    rows = [[_number(values[k]) for k in index] for _, values in source.stored_rows()]
    return dict(zip(names, np.array(rows, float).reshape(-1, len(names)).T))


def _roles(source):
    """Role to field name, by the same words as for files."""
    from ..core.survey.trajectory.columns import columns_by_role

    return columns_by_role(source.names)


def _number(value):
    try:
        return float(value)
    except (TypeError, ValueError):
        return math.nan


def trajectory_features(trajectory, **further):
    """A cleaned trajectory as a point layer, each row with its road, pass and station where it has one.

    `further` columns, name to (N,) values, belong to an estimated trajectory.
    """
    import numpy as np
    import shapely

    from ..core.common.features import Features
    from ..core.common.schemas import ESTIMATED_TRAJECTORY, TRAJECTORY
    from ..core.io.crs import parse_crs

    placed = [(None, None, None)] * len(trajectory)
    if not trajectory.crs or not parse_crs(trajectory.crs).is_geographic:
        placed = _road_pass_station(trajectory)
    points = shapely.points(np.c_[trajectory.x, trajectory.y, trajectory.z])
    columns = (trajectory.time if trajectory.has_time else np.full(len(trajectory), np.nan),
               trajectory.roll, trajectory.pitch, trajectory.heading)
    rows = [
        dict(zip(("time", "roll", "pitch", "heading", "road", "pass", "station_m"), (*values, *where)))
        for values, where in zip(np.stack(columns, axis=1).tolist(), placed)
    ]
    for name, values in further.items():
        for row, value in zip(rows, values.tolist()):
            row[name] = value
    return Features("PointZ", ESTIMATED_TRAJECTORY if further else TRAJECTORY, list(points), rows, trajectory.crs)


def _road_pass_station(trajectory):
    """(road, pass, station) of every row; None in stretches too short to be a pass."""
    import numpy as np

    from ..core.survey.frame.build import build_frame

    found = [(None, None, None)] * len(trajectory)
    for driven in build_frame(trajectory).passes:
        rows = np.flatnonzero((trajectory.time >= driven.time[0]) & (trajectory.time <= driven.time[-1]))
        for row, station in zip(rows, driven.station_at(trajectory.time[rows])):
            found[row] = (driven.road, driven.number, float(station))
    return found
