"""The point clouds that files, folders and wildcards name."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import replace
from glob import glob, has_magic
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from ..core.lazy import np, shapely
from .texts import tr
from .vector_source import LINE, POINT, vertices_of

SUFFIXES = (".las", ".laz")
COPC, VIRTUAL = ".copc.laz", ".vpc"


def cloud_files(given: Iterable[str], label: str) -> list[str]:
    """The files of a survey.

    given : files, virtual point clouds (for the files that they name), folders (their LAS and LAZ files, without those of folders inside; the
        virtual point clouds where there are none) and names with the wildcards * ? [ ]
    label : what messages call the parameter
    Returns list of paths, each once, those of a folder or wildcard by name. A file that is named is not looked for. Of a folder or wildcard,
    `a.copc.laz` is left out where `a.laz` or `a.las` is among it, and `a-overview.copc.laz` where `a.vpc` is: QGIS makes such copies of clouds
    that it shows, and no point shall count twice.

    Raises RoadExtractionError if a folder or wildcard holds no point cloud, or a virtual point cloud cannot be used.
    """
    files: list[str] = []
    for name in filter(None, given):
        path = Path(name)
        if path.is_file():
            files += _clouds([path], "") if path.suffix.lower() == VIRTUAL else [name]
        elif path.is_dir():
            files += _clouds(path.iterdir(), tr("{label}: the folder {name} holds no LAS or LAZ file.").format(label=label, name=name))
        elif has_magic(name):
            files += _clouds(map(Path, glob(name)), tr("{label}: no LAS or LAZ file is called {name}.").format(label=label, name=name))
        else:
            files.append(name)
    return list(dict.fromkeys(files))


def survey_name(clouds: list[str]) -> str:
    """What a survey is called: the folder of its point clouds and what their names have in common, such as B12/tile."""
    stems = [Path(path).stem.removesuffix(".copc") for path in clouds]
    folders = {Path(path).absolute().parent for path in clouds}
    folder = folders.pop().name if len(folders) == 1 else ""
    name = os.path.commonprefix(stems).rstrip("_-. 0123456789") if len(set(stems)) > 1 else "".join(stems[:1])
    return "/".join(part for part in dict.fromkeys((folder, name)) if part)


def _clouds(paths, none_found):
    """Point clouds among paths, by name; raises RoadExtractionError with `none_found` where there is none."""
    files = sorted(str(path) for path in paths if path.suffix.lower() in (*SUFFIXES, VIRTUAL) and path.is_file())
    virtual = [name for name in files if name.lower().endswith(VIRTUAL)]
    clouds = {name for name in files if name not in virtual}
    copies = {name for name in clouds if name.lower().endswith(COPC) and (
        any(name[:-len(COPC)] + suffix in clouds for suffix in SUFFIXES)
        or any(name.startswith(f"{shown[:-len(VIRTUAL)]}-overview") for shown in virtual))}
    if not files:
        raise RoadExtractionError(none_found)
    return sorted(clouds - copies) if clouds else [name for shown in virtual for name in _named_by(shown)]


def _named_by(path):
    """The files of a virtual point cloud, a table of contents in JSON: https://github.com/PDAL/wrench/blob/main/vpc-spec.md

    Names without folder are beside it; one made on Windows has strokes that lean left. What it says about points and CRS, the files say too.
    """
    try:
        assets = [asset for feature in json.loads(Path(path).read_text(encoding="utf-8-sig"))["features"] for asset in feature["assets"].values()]
        names = [asset["href"].replace("\\", "/") for asset in assets if "overview" not in (asset.get("roles") or ())]
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        names = []
    if not names:
        raise RoadExtractionError(tr("{path} names no point clouds as a virtual point cloud does. Make it again in QGIS, or choose the LAS and LAZ "
                                     "files themselves.").format(path=path))
    if remote := [name for name in names if "://" in name or name.lower().startswith("/vsi")]:
        raise RoadExtractionError(tr("{path} names {name} on a server, and nothing is fetched. Download the files and choose them.").format(
            path=path, name=remote[0]))
    return [os.path.normpath(os.path.join(os.path.dirname(path), name)) for name in names]


# The trajectory from whatever the user has: a layer, a table, or the file itself.

# Files the core reads better than QGIS and GDAL: headers of any wording, none at all, binary SBET, logs of receivers, tracks
FILE_SUFFIXES = {".csv", ".txt", ".out", ".sbet", ".xyz", ".pos", ".traj", ".llh", ".tsv", ".dat", ".asc", ".log", ".nmea", ".pof", ".gpx", ".kml"}


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
    from ..core.common.features import ESTIMATED_TRAJECTORY
    from ..core.survey.trajectory.reader import trajectory_from_columns, trajectory_from_rows

    if source.kind == LINE:
        columns = _line_columns(source)
        _refuse_empty(source, len(columns["x"]))
        if not heights_needed and not np.isfinite(columns.get("z", np.nan)).any():
            columns["z"] = np.zeros(len(columns["x"]))
        return trajectory_from_columns(columns, crs or source.stored_crs, label=source.label)
    rows, points = [], []
    for wkb, values in source.stored_rows():
        if wkb or source.kind != POINT:
            rows.append(values)
            points.append(wkb)
    _refuse_empty(source, len(rows))
    coordinates = {}
    if source.kind == POINT:
        firsts = shapely.get_geometry(shapely.from_wkb(np.array(points, object)), 0)  # of what has several
        coordinates["x"], coordinates["y"], z = shapely.get_coordinates(firsts, include_z=True).T
        if source.has_z:
            coordinates["z"] = z
    trajectory = trajectory_from_rows(source.names, rows, coordinates, crs or source.stored_crs, source.label, heights_needed)
    # Estimate trajectory writes the ridge of a cloud without times with its uncertainty, and does not know which way it was driven
    estimated = {column.name for column in ESTIMATED_TRAJECTORY} <= set(source.names)
    return replace(trajectory, way_known=False) if estimated and not trajectory.has_time else trajectory


def _refuse_empty(source, count):
    if not count:
        raise RoadExtractionError(
            tr("{label} has no rows. Choose the layer that holds the driven positions.").format(label=source.label))


def _line_columns(source):
    """Vertices in drawing order; M, where there is one, is the time."""
    rows = [vertices_of(wkb) for wkb, _ in source.stored_rows(measures=True) if wkb]
    x, y, z, time = np.concatenate([np.empty((0, 4)), *rows]).T
    return {"x": x, "y": y, **({"z": z} if source.has_z else {}), **({"time": time} if source.has_m else {})}


def trajectory_features(trajectory, **further):
    """A cleaned trajectory as a point layer, each row with its road, pass and station where it has one.

    `further` columns, name to (N,) values, belong to an estimated trajectory.
    """
    from ..core.common.features import ESTIMATED_TRAJECTORY, TRAJECTORY, Features
    from ..core.io.crs import parse_crs

    placed = [(None, None, None)] * len(trajectory)
    if not trajectory.crs or not parse_crs(trajectory.crs).is_geographic:
        placed = _road_pass_station(trajectory)
    points = shapely.points(np.c_[trajectory.x, trajectory.y, trajectory.z])
    columns = (trajectory.time if trajectory.has_time else np.full(len(trajectory), np.nan),
               trajectory.roll, trajectory.pitch, trajectory.heading)
    rows = [
        dict(zip(("time", "roll", "pitch", "heading", "road", "pass", "station_m"), (*values, *location)))
        for values, location in zip(np.stack(columns, axis=1).tolist(), placed)
    ]
    for name, values in further.items():
        for row, value in zip(rows, values.tolist()):
            row[name] = value
    return Features("PointZ", ESTIMATED_TRAJECTORY if further else TRAJECTORY, list(points), rows, trajectory.crs)


def _road_pass_station(trajectory):
    """(road, pass, station) of every row; None in stretches too short to be a pass."""
    from ..core.survey.frame.road_frame import build_frame

    locations = [(None, None, None)] * len(trajectory)
    for driven in build_frame(trajectory).passes:
        rows = np.flatnonzero((trajectory.time >= driven.time[0]) & (trajectory.time <= driven.time[-1]))
        for row, station in zip(rows, driven.station_at(trajectory.time[rows])):
            locations[row] = (driven.road, driven.number, float(station))
    return locations
