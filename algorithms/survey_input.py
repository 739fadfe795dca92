"""What the stages work on: the files of point clouds, the trajectory, the survey, the road frame, the road points."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import replace
from glob import glob, has_magic
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from ..core.common.features import CORRECTIONS, ESTIMATED_TRAJECTORY, TRAJECTORY, Features
from ..core.lazy import np, shapely
from .algorithm import settings_of
from .rooms import core
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
            files += _clouds(path.iterdir(), tr("{label}: the folder {name} holds no LAS or LAZ file.", label=label, name=name))
        elif has_magic(name):
            files += _clouds(map(Path, glob(name)), tr("{label}: no LAS or LAZ file is called {name}.", label=label, name=name))
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
                                     "files themselves.", path=path))
    if remote := [name for name in names if "://" in name or name.lower().startswith("/vsi")]:
        raise RoadExtractionError(tr("{path} names {name} on a server, and nothing is fetched. Download the files and choose them.", path=path,
                                     name=remote[0]))
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
    if source.kind == LINE:
        columns = _line_columns(source)
        _refuse_empty(source, len(columns["x"]))
        if not heights_needed and not np.isfinite(columns.get("z", np.nan)).any():
            columns["z"] = np.zeros(len(columns["x"]))
        return core.survey.trajectory.reader.trajectory_from_columns(columns, crs or source.stored_crs, label=source.label)
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
    trajectory = core.survey.trajectory.reader.trajectory_from_rows(
        source.names, rows, coordinates, crs or source.stored_crs, source.label, heights_needed)
    # Estimate trajectory writes the ridge of a cloud without times with its uncertainty, and does not know which way it was driven
    estimated = {column.name for column in ESTIMATED_TRAJECTORY} <= set(source.names)
    return replace(trajectory, way_known=False) if estimated and not trajectory.has_time else trajectory


def _refuse_empty(source, count):
    if not count:
        raise RoadExtractionError(tr("{label} has no rows. Choose the layer that holds the driven positions.", label=source.label))


def _line_columns(source):
    """Vertices in drawing order; M, where there is one, is the time."""
    rows = [vertices_of(wkb) for wkb, _ in source.stored_rows(measures=True) if wkb]
    x, y, z, time = np.concatenate([np.empty((0, 4)), *rows]).T
    return {"x": x, "y": y, **({"z": z} if source.has_z else {}), **({"time": time} if source.has_m else {})}


def trajectory_features(trajectory, **further):
    """A cleaned trajectory as a point layer, each row with its road, pass and station where it has one.

    `further` columns, name to (N,) values, belong to an estimated trajectory.
    """
    placed = [(None, None, None)] * len(trajectory)
    if not trajectory.crs or not core.io.crs.parse_crs(trajectory.crs).is_geographic:
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
    locations = [(None, None, None)] * len(trajectory)
    for driven in core.survey.frame.road_frame.build_frame(trajectory).passes:
        rows = np.flatnonzero((trajectory.time >= driven.time[0]) & (trajectory.time <= driven.time[-1]))
        for row, station in zip(rows, driven.station_at(trajectory.time[rows])):
            locations[row] = (driven.road, driven.number, float(station))
    return locations


SURVEY_SETTINGS = settings_of("core.survey.open_survey:SurveySettings",
    "CORRIDOR* SCANNER_FIELD* TIME* INTENSITY_FROM* FIT_PASSES* TRAJECTORY_SIGMA*")
# of those who draw no lines
READING_SETTINGS = tuple(spec for spec in SURVEY_SETTINGS if spec.name != "TRAJECTORY_SIGMA")

EXECUTION_SETTINGS = settings_of("core.execution.choice:ExecutionSettings", "WORKERS* SCHEDULER* INSECURE*")


def estimated_trajectory(call, progress):
    """The EstimatedTrajectory of POINT_CLOUDS where TRAJECTORY was left out, None where it was given; says so in the log."""
    if call.given("TRAJECTORY"):
        return None
    progress.info(tr("No trajectory was given; it is estimated from the points …"))
    scanner_field = call.settings(SURVEY_SETTINGS).scanner_field
    estimate = core.survey.estimation.estimate.estimate_trajectory(call.point_clouds(), call.crs(), scanner_field, progress)
    progress.warn_all(estimate.notes)
    progress.info(estimate.summary())
    return estimate


def add_execution(algorithm):
    """Who does the work, and where finished work is kept."""
    algorithm.add_settings(EXECUTION_SETTINGS)
    algorithm.add_input("folder", "WORK_FOLDER", optional=True, advanced=True)


def execution_of(call):
    folder = call.file("WORK_FOLDER") if call.algorithm.parameter("WORK_FOLDER") is not None else ""
    return call.settings(EXECUTION_SETTINGS, work_folder=folder)


def survey_inputs(call):
    """Paths of POINT_CLOUDS, and TRAJECTORY brought to the clouds' CRS."""
    paths = call.point_clouds()
    clouds = next((header.crs for header in core.survey.las.reader.read_headers(paths) if header.crs), "") or call.crs()
    return paths, core.survey.trajectory.trajectory.reproject_trajectory(call.trajectory(), clouds)


def open_survey_of(call, progress, **reading):
    """The survey of POINT_CLOUDS and TRAJECTORY, open until the run ends; `reading` are settings that users are not asked for."""
    paths, trajectory = survey_inputs(call)
    settings = call.settings(SURVEY_SETTINGS, crs=call.crs(), **reading)
    survey = core.survey.open_survey.open_survey(paths, trajectory, settings, progress, execution_of(call))
    call.at_end(survey.store.close)
    return survey


def open_survey_with(call, layers, progress, **reading):
    """The survey as of `open_survey_of`, on whose roads and in whose CRS the layers lie; of `layers`, those without features become None."""
    for name, features in layers.items():
        if features is not None and not len(features):
            progress.warn(tr("{label} holds no features and is not used.", label=call.label(name)))
            layers[name] = None
    survey = open_survey_of(call, progress, **reading)
    for name, features in layers.items():
        if features is not None:
            core.io.crs.check_same_crs(features.crs, survey.crs, shapely.get_coordinates(features.geometries[0])[0], call.label(name))
    check_layers_on_roads(call, layers, survey.frame, progress)
    return survey


def check_layers_on_roads(call, layers, frame, progress):
    """Raise RoadExtractionError where a layer of `layers`, parameter name to Features, was made with another trajectory than the frame's.

    What lies far from its roads is left out, with a warning.
    """
    for name, features in layers.items():
        if features is not None:
            core.survey.consistency.check_features_on_roads(features, frame, call.label(name))
            if note := core.survey.consistency.keep_near_roads(features, frame, call.label(name)):
                progress.warn(note)


def frame_of(call, crs, progress, road_points=None, layers=None):
    """The road frame of TRAJECTORY for data in `crs`; with road points given, on their clock.

    `layers` (parameter name to Features) and the road points must have been made with this trajectory.
    """
    trajectory = core.survey.trajectory.trajectory.reproject_trajectory(call.trajectory(), crs)
    has_time = trajectory.has_time
    if road_points is not None and has_time:
        trajectory, has_time = _on_clock_of(road_points, trajectory, progress)
    frame = core.survey.frame.road_frame.build_frame(trajectory)
    frame.crs, frame.has_time = crs or trajectory.crs, has_time
    # what passes differ by is seen where the points are read; here it comes with what was made of them
    known = [road_points.pass_sigma] if road_points is not None else []
    known += [core.survey.adjustment.register.sigma_of_layer(layer) for layer in (layers or {}).values() if layer is not None]
    frame.pass_sigma = {road: sigma for sigmas in known for road, sigma in sigmas.items()}
    check_layers_on_roads(call, layers or {}, frame, progress)
    if road_points is not None:
        core.survey.consistency.check_road_points_on_roads(road_points, frame, tr("The points"))
    return frame


def _on_clock_of(road_points, trajectory, progress):
    """The trajectory in the points' time system, and whether the points have time at all."""
    first, last = float("inf"), float("-inf")
    for road, number in road_points.all_sections():
        time = road_points.section(road, number).time
        if len(time):
            first, last = min(first, float(time.min())), max(last, float(time.max()))
        if first < last and trajectory.time.min() <= first and last <= trajectory.time.max():
            return trajectory, True
    if not first < last:
        return trajectory, not len(road_points)
    offset, note = core.survey.trajectory.time_systems.align_time(trajectory.time, (first, last))
    if note:
        progress.info(note)
    return trajectory.shifted(offset), True


def road_points_of(call, name, progress):
    """A LAZ file made by Extract road surface or Correct intensity, as RoadPoints."""
    return core.survey.road_points_las.read_road_points(call.cloud(name), progress)


def bright_road_points_of(call, name, progress):
    """The same for stages that look at intensity; refused where there is none."""
    road_points = road_points_of(call, name, progress)
    sections = (road_points.section(*key).intensity for key in road_points.all_sections())
    values = [(section.min(), section.max()) for section in sections if len(section)]
    if values and min(low for low, _ in values) == max(high for _, high in values):
        raise RoadExtractionError(tr("{path} has no intensity (all values are the same), so it shows no paint. Export the point clouds with "
                                     "intensity, or make the points again with INTENSITY_FROM set to rgb.", path=call.cloud(name)))
    return road_points


def paint_of(call, name, progress):
    """A LAZ file of marking points; a road without paint gives one without points, and that is a result too."""
    with core.survey.las.reader.open_cloud(call.cloud(name)) as reader:
        if reader.header.point_count:
            return road_points_of(call, name, progress)
        columns = set(reader.header.point_format.dimension_names)
        crs = core.survey.las.reader.cloud_crs(reader.header)
        points = core.survey.store.road_points.RoadPoints.empty_like(origin=reader.header.offsets, crs=crs)
        points.has_corrected, points.has_cluster = "intensity_corrected" in columns, "cluster" in columns
        progress.warn(tr("{label} holds no points: no paint was found on this road.", label=call.label(name)))
        return points


def imported_trajectory(call, progress):
    """INPUT in TARGET_CRS (or the clouds' CRS) and, with POINT_CLOUDS given, on the clouds' clock."""
    trajectory = call.trajectory("INPUT", call.crs("INPUT_CRS"), columns=call.value("COLUMNS"))
    headers = core.survey.las.reader.read_headers(call.point_clouds()) if call.given("POINT_CLOUDS") else []
    target = call.crs("TARGET_CRS") or next((header.crs for header in headers if header.crs), "")
    if target and not trajectory.crs:
        progress.warn(tr("The trajectory says no CRS; its coordinates are taken to be those of the target CRS as they are."))
        trajectory = replace(core.survey.trajectory.trajectory.taken_to_be_in(trajectory, target), crs=target)
    trajectory = core.survey.trajectory.trajectory.reproject_trajectory(trajectory, target)
    if headers:
        trajectory, note, *_ = core.survey.open_survey.match_clocks(headers, trajectory, call.settings(SURVEY_SETTINGS), progress)
        if note:
            progress.info(note)
    return trajectory


# The layer CORRECTIONS as an input: points, lines or a table, of whatever program.

NEEDED = ("action", "target")


def corrections_of(call):
    """The layer as Features; None where none was given."""
    source = call.source("CORRECTIONS")
    return None if source is None else read_corrections(source)


def read_corrections(source):
    """A VectorSource as Features with the fields of CORRECTIONS, of which only `action` and `target` have to be there.

    Raises RoadExtractionError if one of these two is missing.
    """
    index = {name.lower(): k for k, name in enumerate(source.names)}
    missing = [name for name in NEEDED if name not in index]
    if missing:
        raise RoadExtractionError(tr("{label} lacks the field(s) {fields}. Make the layer with the buttons of the window of doubtful places, or give "
                                     "it the fields action and target.", label=source.label, fields=", ".join(missing)))
    columns = [column for column in CORRECTIONS if column.name in index]
    result = Features("any", list(CORRECTIONS), crs=source.crs)
    for wkb, values in source.rows(check_validity=False):
        row = {column.name: values[index[column.name]] for column in columns}
        result.add(None if wkb is None else shapely.from_wkb(wkb), **row)
    return result
