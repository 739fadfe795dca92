"""LAS and LAZ files that are written whole or not at all, above all road points, whose extra fields hold the road frame for later stages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..io.crs import as_in_file, parse_crs
from ..io.local_files import unfinished_path
from ..lazy import laspy
from .adjustment.register import PassCorrections, sigma_of_records, sigma_to_record
from .las.copc_writer import write_copc
from .las.point_fields import packed_returns
from .las.reader import cloud_crs, open_cloud, read_blocks
from .store.records import COORDINATE_SCALE, ROAD_POINT, point_dtype
from .store.road_points import RoadPoints
from .store.section_store import SectionStore
from .weights import LAS, READING

MAX_LAS_INTEGER = 2**31 - 2    # derived: largest coordinate, as an integer about the offset, in a LAS file


def scale_for(farthest: float) -> float:
    """The coordinate scale of a LAS file, metres per integer: 0.1 mm, or the least power of ten times it with which all points fit.

    farthest : metres, the largest coordinate counted from the offset of the file. RoadExtractionError if even 0.1 m is too fine.
    """
    for per_metre in (10_000, 1_000, 100, 10):
        if farthest * per_metre <= MAX_LAS_INTEGER:
            return COORDINATE_SCALE if per_metre == 10_000 else 1 / per_metre
    raise RoadExtractionError(f"The points lie up to {farthest / 1000:,.0f} km from the start of the survey, farther than a LAS file can hold. "
                              "Process the files of each region separately.")


def place_in_file(header: Any, origin: np.ndarray, crs: str, farthest: float) -> None:
    """Set the scales, offsets and CRS of a new laspy header, in the units of the survey's own CRS.

    origin : (3,) metres, map coordinates of the local origin; crs : WKT, metric, "" where unknown; farthest : metres, the largest local coordinate
    """
    file_wkt, units = as_in_file(crs)
    header.scales = np.full(3, scale_for(farthest / min(units.across, units.up)))
    header.offsets = np.asarray(origin, float) if units.metric else units.in_file(origin)
    if file_wkt:
        header.add_crs(parse_crs(file_wkt))


def metres_of_file(header: Any, crs: str) -> list[float]:
    """Metres per integer of x, y and z in a new file of a survey."""
    units = as_in_file(crs)[1]
    return (header.scales if units.metric else units.in_metres(header.scales)).tolist()


def is_copc(path: str | os.PathLike[str]) -> bool:
    """Whether a path is that of a COPC, by its ending."""
    return str(path).lower().endswith(".copc.laz")


@contextmanager
def new_laz(path: str | os.PathLike[str], header: Any) -> Iterator[Any]:
    """A laspy writer of a new file, which appears at its path only when all is written; compressed unless the path ends in .las.

    At a path that ends in .copc.laz a COPC appears, for which all points lie in a LAS file beside it until they are in order.
    RoadExtractionError if the file cannot be written.
    """
    octree = is_copc(path)
    suffix = ".las" if octree or str(path).lower().endswith(".las") else ".laz"
    unfinished = unfinished_path(path, suffix)
    ordered = unfinished_path(path, ".laz") if octree else unfinished
    try:
        # A file that laspy opened itself would stay open when its last points cannot be written.
        with open(unfinished, "wb") as stream, laspy.open(
                stream, mode="w", header=header, do_compress=suffix == ".laz", closefd=False) as writer:
            yield writer
        if octree:
            with laspy.mmap(unfinished) as cloud:
                write_copc(cloud, ordered)
        os.replace(ordered, path)
    except (OSError, RuntimeError) as problem:  # lazrs raises RuntimeErrors
        raise RoadExtractionError(f"{path} cannot be written ({problem}). Choose another folder or free some disk space.") from problem
    finally:
        unfinished.unlink(missing_ok=True)
        ordered.unlink(missing_ok=True)


# Road points as a LAZ file, with the road frame in extra fields for the later stages.

ROAD_CLASS = 11  # source: ASPRS, road surface
COLOURS_USER_ID = "LanewrightRGB"   # of a LAS record that says that intensities are the brightness of colours
MILLIMETRE = 1e-3   # source: definition; m of widths and spacings in the file

# stations and offsets are integers of 0.1 mm, so that reading returns exactly the records that were written
# a column of the records, its field in the file, m of a whole number of it (None for what is no length), and of extra fields type and description
FIELDS = (("time", "gps_time", None), ("intensity", "intensity", None), ("source", "point_source_id", None), ("", "road", None, "uint16", "Road"),
          ("pass_number", "pass", None, "uint16", "Pass"), ("scanner", "scanner", None, "uint8", "Scanner"),
          ("s", "station_m", COORDINATE_SCALE, "int32", "Station along the road"),
          ("d", "offset_m", COORDINATE_SCALE, "int32", "Offset, left positive"),
          ("half_width", "half_width", MILLIMETRE, "uint16", "Half width of the road"),
          ("covered", "covered", None, "uint8", "Beneath something on the road"),
          ("corrected", "intensity_corrected", None, "float32", "Intensity, range corrected"),
          ("cluster", "cluster", None, "int32", "Cluster of paint"), ("spacing", "spacing", MILLIMETRE, "uint16", "Spacing across the road"))
REQUIRED_FIELDS = ("road", "pass", "station_m", "offset_m", "half_width")


def write_road_points(road_points: RoadPoints, path: str | Path, progress: Progress = Progress()) -> None:
    """Write road points as LAS 1.4, class 11, in road order; a failed run leaves no file. RoadExtractionError if it cannot be written.

    Coordinates are written as measured, in the units of the survey's own CRS; in metres with a scale of 0.1 mm, of 1 mm beyond 214 km from
    the origin and of 1 cm beyond 2,147 km. Corrections of passes are written beside them and applied again on reading.
    """
    sections = road_points.all_sections()
    header = _header(road_points)
    with new_laz(path, header) as writer:
        for k, (road, number) in enumerate(sections):
            writer.write_points(_record(road_points, road, number, header))
            progress.report((k + 1) / len(sections))


def _header(road_points):
    header = laspy.LasHeader(point_format=6, version="1.4")
    # times are written as they were read
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    header.generating_software = "Lanewright"
    there = {"corrected": road_points.has_corrected, "cluster": road_points.has_cluster, "spacing": road_points.has_spacing}
    header.add_extra_dims([
        laspy.ExtraBytesParams(name=name, type=extra[0], description=extra[1],
                               **({} if scale is None else dict(scales=np.array([scale]), offsets=np.array([0.0]))))
        for column, name, scale, *extra in FIELDS if extra and there.get(column, True)])
    if road_points.moves is not None:
        header.vlrs.extend(road_points.moves.to_records())
    header.vlrs.extend(sigma_to_record(road_points.pass_sigma))
    if road_points.of_colours:
        header.vlrs.append(laspy.VLR(COLOURS_USER_ID, 1, "Brightness is of colours"))
    place_in_file(header, road_points.origin, road_points.crs, _farthest(road_points))
    return header


def _farthest(road_points):
    """The largest |local x| or |local y| of a point, m; 0 where x and y have 32 bits, which need no coarser scale in metres."""
    if road_points.store.dtype["x"] == np.int32 and as_in_file(road_points.crs)[1].metric:
        return 0.0
    ends = [int(np.abs(road_points.store.section(road, number)[name]).max(initial=0))
            for road, number in road_points.all_sections() for name in "xy"]
    return max(ends, default=0) * COORDINATE_SCALE + READING.max_correction


def _whole(numbers, share):
    """Whole numbers in another unit, of which one of theirs is `share`."""
    return numbers if abs(share - 1.0) < 1e-12 else np.rint(numbers * share)


def _record(road_points, road, number, header):
    records = road_points.store.section(road, number)
    out = laspy.ScaleAwarePointRecord.zeros(len(records), header=header)
    off = (0, 0, 0) if road_points.moves is None else road_points.moves.units(records)
    for name, moved, metres in zip("xyz", off, metres_of_file(header, road_points.crs)):
        out.array[name.upper()] = _whole(records[name] - moved, COORDINATE_SCALE / metres)
    out["return_number"], out["number_of_returns"] = records["returns"] & 15, records["returns"] >> 4
    out["classification"] = np.full(len(records), ROAD_CLASS, np.uint8)
    out.array["road"] = road
    for name, field, *_ in FIELDS:
        if name and field in out.array.dtype.names:
            out.array[field] = records[name]
    return out


def read_road_points(path: str | Path, progress: Progress = Progress()) -> RoadPoints:
    """Read a LAZ file written by `write_road_points`; RoadExtractionError if it lacks the extra fields of road points, or holds no points."""
    with open_cloud(path) as reader:
        header = reader.header
        names = set(header.point_format.dimension_names)
        missing = [name for name in REQUIRED_FIELDS if name not in names]
        if missing:
            raise RoadExtractionError(f"{path} lacks the extra field(s) {', '.join(missing)} that tell where on the road a point lies. Give it the "
                                      "road points written by “Extract road surface” or a stage after it.")
        origin, scales, total = np.asarray(header.offsets, float), np.asarray(header.scales), header.point_count
        # where the file says its points lie; 32 bits of x and y reach beyond where they change to 64
        farthest = max((np.abs(np.r_[header.mins, header.maxs][[0, 1, 3, 4]] - origin[[0, 1, 0, 1]])).max(), 0.0) if total else 0.0
        crs, moves, sigma = cloud_crs(header), PassCorrections.of_records(header.vlrs), sigma_of_records(header.vlrs)
        of_colours = any(record.user_id.rstrip("\0") == COLOURS_USER_ID for record in header.vlrs)
    store = SectionStore(point_dtype(ROAD_POINT, farthest))
    count = 0
    for block in read_blocks(path, LAS.points_per_block):
        records = _read_records(block, names, scales, store.dtype)
        if moves is not None:
            for name, moved in zip("xyz", moves.units(records)):
                records[name] += moved
        roads = np.asarray(block["road"])
        for road in np.unique(roads):
            store.append(int(road), records[roads == road])
        count += len(block)
        progress.report(count / max(total, 1))
    if not store.count:
        raise RoadExtractionError(f"{path} holds no points. Run the stage that made it again with other settings.")
    return RoadPoints(store, origin, crs, "intensity_corrected" in names, "cluster" in names, moves, "spacing" in names, sigma,
                      of_colours=of_colours)


def _read_records(block, names, scales, dtype):
    """The records of a laspy block, of which the file has the fields `names`; those that it lacks have their defaults."""
    records = np.zeros(len(block), dtype)
    # another program may have rewritten the file with its own scale
    for name, scale in zip("xyz", scales):
        records[name] = _whole(np.asarray(block[name.upper()]), scale / COORDINATE_SCALE)
    records["corrected"] = np.nan
    for name, field, unit, *_ in FIELDS:
        if name and field in names:
            records[name] = block[field] if unit is None else np.rint(np.asarray(block[field], float) / unit)
    records["returns"] = packed_returns(block)
    return records
