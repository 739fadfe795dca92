"""Point cloud files: their headers, and their points in blocks."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ...common.errors import Cancelled, RoadExtractionError
from ...common.parallel import check_cancelled
from ...io.crs import METRES, FileUnits, horizontal_part, in_metres, moved_by
from ...io.weights import IO
from ...lazy import laspy, pyproj
from ..weights import LAS
from .header import find_damage, mend, opened, places_here_and_there, points_per_chunk, with_points_of_chunks

CLOUD_SUFFIXES = (".las", ".laz")
MAX_INTENSITY = 2**16 - 1   # derived: of 16 bits
NOT_FILE_ERRORS = (KeyboardInterrupt, SystemExit, GeneratorExit, Cancelled, MemoryError)  # they say nothing about the file


@dataclass(frozen=True)
class CloudHeader:
    """The header of one LAS, LAZ or COPC file."""

    path: str
    version: str   # such as "1.4"
    point_format: int   # number of the ASPRS point data record format
    count: int   # points
    minimum: tuple[float, ...]   # minimum, maximum: (3,) map coordinates
    maximum: tuple[float, ...]
    scales: tuple[float, ...]   # (3,) metres
    crs: str   # WKT, metric, "" where the file has none
    has_time: bool   # has_time, has_colour: whether the points have gps_time and colours
    adjusted_time: bool   # whether gps_time is adjusted standard GPS time (global encoding bit 0), not seconds of the GPS week
    chunk: int = 0   # points that are compressed together; 1 in a LAS file, 0 where the number varies
    has_colour: bool = False
    notes: tuple[str, ...] = ()   # sentences about what the header states otherwise than the file shows
    units: FileUnits = METRES   # of the coordinates in the file; all others here are in metres
    crs_problem: str = ""   # why what the file says about its coordinates is not used, "" for nothing
    brightness: int = 1   # by which intensities are multiplied, so that they have the scale of other files, see `in_one_scale`


def states_of(files: Sequence[CloudHeader]) -> list[tuple[str, int, int]]:
    """Path, size and time of change of each file; RoadExtractionError where one is gone."""
    states = []
    for file in files:
        with _file_errors(f"{file.path} cannot be read any more"):
            states.append((os.path.abspath(file.path), os.path.getsize(file.path), os.stat(file.path).st_mtime_ns))
    return states


def open_cloud(path: str | os.PathLike[str], layers: Iterable[str] | None = None, known: CloudHeader | None = None,
               units: FileUnits = METRES) -> Any:
    """Open a LAS, LAZ or COPC file with laspy: a LasReader whose header has scales, offsets and bounds in metres.

    layers : names of the layers of a LAZ 1.4 file that are decoded beside x, y and the return numbers ("z", "intensity" ...); all by default
    known : the file's header, where it was read and its points were counted before
    units : of its coordinates, where it does not state them by its CRS

    Raises RoadExtractionError if the file is missing, is not a LAS or LAZ file, is damaged, or cannot be read.
    """
    reader = _open(path, _mended(path) if known is None else _undamaged(path).with_count(known.count), layers)
    _to_metres(reader.header, _stated_units(reader.header, units) if known is None else known.units)
    return reader


def cloud_crs(header: Any) -> str:
    """WKT, metric, of the CRS that a laspy header states; "" where there is none that is understood and does not contradict itself."""
    crs, problem = _crs_of_records(header)
    return "" if problem else in_metres(crs)[0]


def _stated_units(header, otherwise):
    """The FileUnits of the CRS that a header states, and `otherwise` where it states none."""
    crs = cloud_crs(header)
    return in_metres(crs)[1] if crs else otherwise


def _to_metres(header, units):
    """Bring what a header says about coordinates from the units of its file to metres."""
    if not units.metric:
        header.scales, header.offsets, header.mins, header.maxs = (
            units.in_metres(numbers) for numbers in (header.scales, header.offsets, header.mins, header.maxs))


def _mended(path):
    """What is read in place of some bytes of a file, whose points are counted; raises as `open_cloud`."""
    return with_points_of_chunks(path, _undamaged(path))


def _undamaged(path):
    """The same of a file that is checked for damage; the decoder ends the program where lengths are wrong."""
    path = str(path)
    if not Path(path).exists():
        raise RoadExtractionError(f"There is no file {path}. Check the path of the point cloud.")
    if not path.lower().endswith(CLOUD_SUFFIXES):
        raise RoadExtractionError(f"{path} is not a LAS or LAZ file. Lanewright reads .las, .laz, .copc.laz and .vpc; convert other formats first.")
    mended = mend(path)
    if damage := find_damage(path, mended):
        raise RoadExtractionError(f"{path} is damaged or cut off: {damage}. Copy or export the file again.")
    return mended


def _open(path, mended, layers):
    """laspy.LasReader of a file that is read as it was mended."""
    with _file_errors(f"{path} cannot be read as a LAS/LAZ file"):
        return laspy.open(opened(path, mended) if mended.patches else str(path), decompression_selection=layer_selection(layers))


def layer_selection(layers: Iterable[str] | None) -> Any:
    """laspy's DecompressionSelection of the layers with these names; of all layers for None."""
    if layers is None:
        return laspy.DecompressionSelection.all()
    selection = laspy.DecompressionSelection.base()
    for name in layers:
        selection = getattr(selection, f"decompress_{name}")()
    return selection


def read_header(path: str | os.PathLike[str], given: str = "") -> CloudHeader:
    """The header of a file; bounds that it does not give, or outside of which points lie, are computed from the points.

    given : WKT of the CRS, where the file states none. RoadExtractionError if the file is missing, is not LAS or LAZ, or cannot be read.
    """
    mended = _mended(path)
    with _open(path, mended, None) as reader:
        header = reader.header
        names = set(header.point_format.dimension_names)
        scales, offsets = np.abs(header.scales), np.abs(header.offsets)
        if not ((scales > 0) & (scales < LAS.max_header_scale) & (offsets < LAS.max_header_offset)).all():
            raise RoadExtractionError(f"{path} gives its points no coordinates: its header says scales of {_listed(header.scales)} and offsets of "
                                      f"{_listed(header.offsets)}. Export the file again, with a scale such as 0.001 m.")
        overflow = _overflow(header)
        count, units, bounds_hold = int(header.point_count), _stated_units(header, in_metres(given)[1]), _bounds_hold(path, mended, header)
        _to_metres(header, units)
        low, high = _bounds_of_points(path, units) if count > 1 and not bounds_hold else (header.mins, header.maxs)
        return CloudHeader(
            str(path), str(header.version), header.point_format.id, count,
            tuple(map(float, low)), tuple(map(float, high)), tuple(map(float, header.scales)),
            cloud_crs(header), "gps_time" in names,
            bool(header.global_encoding.gps_time_type.value), points_per_chunk(path), "red" in names,
            tuple(f"The file {path} contradicts its header: {note}." for note in (*mended.notes, *overflow)), units, _crs_of_records(header)[1])


def _overflow(header):
    """What to tell of coordinates that the integers of a file cannot hold, by the bounds that its header states; () where they can."""
    reach = 2.0**31 * np.abs(header.scales)   # of coordinates stored as 32-bit integers
    for axis, low, high, least, most in zip("xyz", header.mins, header.maxs, header.offsets - reach, header.offsets + reach):
        held = least - LAS.bounds_tolerance <= low and high <= most + LAS.bounds_tolerance
        if -LAS.farthest_place < low < high < LAS.farthest_place and not held:
            return (f"its header says that {axis} runs from {low:.1f} to {high:.1f}, and its scale and offset can hold {least:.1f} to "
                    f"{most:.1f} alone. Export it again with an offset near the survey",)
    return ()


def _bounds_hold(path, mended, header):
    """Whether the bounds that a header states are some, can be, and hold the points at which it is looked."""
    low, high = header.mins, header.maxs
    reach = 2.0**31 * np.abs(header.scales)  # of coordinates stored as 32-bit integers
    plausible = (header.offsets - reach <= low) & (low <= high) & (high <= header.offsets + reach)
    if not (plausible.all() and (low < high).any()):
        return False
    places, margin = places_here_and_there(path, mended), np.abs(header.scales) + LAS.bounds_tolerance
    return bool(((places >= low - margin) & (places <= high + margin)).all())


def _listed(numbers):
    return ", ".join(f"{number:g}" for number in numbers)


def _bounds_of_points(path, units):
    """Least and largest coordinates of the points, (3,) each."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for block in read_blocks(path, units=units):
        places = np.stack([np.asarray(block[name], float) for name in "xyz"])
        low, high = np.minimum(low, places.min(axis=1)), np.maximum(high, places.max(axis=1))
    return low, high


def read_headers(paths: Iterable[str | os.PathLike[str] | CloudHeader], warn: Callable[[str], None] = lambda note: None,
                 given: str = "") -> list[CloudHeader]:
    """The headers of several files, in the order given; a file that is given twice, by whatever path, is read once.

    paths : of the files; a header that was read before stays as it is
    warn : is told what headers state otherwise than their files show
    given : WKT of the CRS of those that state none

    Raises RoadExtractionError if there is no file, a file cannot be read, or all files are empty.
    """
    unique: dict[str, Any] = {}
    for path in paths:
        unique.setdefault(os.path.realpath(path.path if isinstance(path, CloudHeader) else path), path)
    if not unique:
        raise RoadExtractionError("No point cloud was given. Choose one or more LAS, LAZ or COPC files.")
    files = [path if isinstance(path, CloudHeader) else read_header(Path(path), given) for path in unique.values()]
    if not any(file.count for file in files):
        named = f"The file {files[0].path} holds" if len(files) == 1 else f"The files {', '.join(file.path for file in files[:3])} hold"
        raise RoadExtractionError(f"{named} no points. Check the export of the survey.")
    for note in (note for file in files for note in file.notes):
        warn(note)
    return files


def read_blocks(path: str | os.PathLike[str], size: int = LAS.points_per_block, layers: Sequence[str] | None = None,
                units: FileUnits = METRES) -> Iterator[Any]:
    """Yield the points of a file in blocks of `size` points, as laspy.ScaleAwarePointRecord in file order.

    layers, units : as in `open_cloud`. RoadExtractionError if the file ends early or is damaged.
    """
    with open_cloud(path, layers, units=units) as reader:
        promised, read = reader.header.point_count, 0
        while read < promised:
            check_cancelled()
            with damage_from(path, promised, read):
                points = reader.read_points(size)
            if len(points) < min(size, promised - read):
                raise truncated_file_error(path, promised, read + len(points))
            read += len(points)
            yield points


def truncated_file_error(path: str | os.PathLike[str], promised: int, present: int) -> RoadExtractionError:
    """The error for a file that ends before its last point."""
    return RoadExtractionError(f"{path} is cut off: its header promises {promised} points, {present} are there. Copy or export the file again.")


def damage_from(path: str | os.PathLike[str], promised: int, first: int) -> AbstractContextManager[None]:
    """While points of a file are read from `first` on: errors of the file become a RoadExtractionError of one sentence."""
    return _file_errors(f"{path} is damaged: its header promises {promised} points, and from number {first + 1} on they cannot be read")


@contextmanager
def _file_errors(what):
    try:
        yield
    except BaseException as problem:  # decoders raise many types for a damaged file, some of them not Exceptions
        if isinstance(problem, NOT_FILE_ERRORS):
            raise
        raise RoadExtractionError(f"{what} ({problem}). Copy or export the file again.") from problem


# The CRS of a LAS file from its WKT and GeoKeys records, which may contradict each other.

RECORDS_OF = "LASF_Projection"  # user id of the records
WKT_RECORD, KEYS_RECORD, DOUBLES_RECORD = 2112, 34735, 34736   # source: LAS 1.4 R15, georeferencing records
PROJECTED, GEODETIC, LENGTH_UNIT, LENGTH_SIZE, VERTICAL, HEIGHT_UNIT = 3072, 2048, 3076, 3077, 4096, 4099   # source: GeoKeys, OGC 19-008r4
EPSG_CODES = range(1024, 32767)   # source: OGC 19-008r4, as are those of the records and keys above


def _crs_of_records(header: Any) -> tuple[str, str]:
    """The CRS that a laspy header states, as WKT with the unit of its heights, and a sentence on why it cannot be used; "" for either."""
    records = [record for record in [*header.vlrs, *(header.evlrs or ())] if record.user_id == RECORDS_OF]
    middle = (header.mins + header.maxs) / 2
    contents = (next((record.record_data_bytes() for record in records if record.record_id == number), b"")
                for number in (WKT_RECORD, KEYS_RECORD, DOUBLES_RECORD))
    return _stated(*contents, tuple(middle[:2].tolist()))


@lru_cache(maxsize=256)
def _stated(text, keys, doubles, place):
    """As of `_crs_of_records`, of the contents of the records."""
    # text that is not understood counts as none: the user is then asked for the CRS
    written = _crs(pyproj.CRS.from_wkt, text.split(b"\0")[0].decode("utf-8", "replace").strip() or None)
    plane, vertical, problem = _of_keys(_key_values(keys, doubles))
    if _of_heights(written):
        written, vertical = plane, written
        if written is None:
            return "", problem or ("" if _same_unit(vertical, 1.0) else f"only the CRS of its heights is known ({vertical.name})")
    if written is None:
        return _joined(plane, vertical), problem
    heights = written.sub_crs_list[-1] if written.is_compound else None
    return _joined(written, vertical if heights is None else None), problem or _contradiction(written, heights, plane, vertical, place)


def _key_values(keys, doubles):
    """{GeoKey: number} of the contents of the records of keys and of doubles."""
    table = np.frombuffer(keys[:len(keys) // 8 * 8], "<u2").reshape(-1, 4)[1:].tolist()
    sizes = np.frombuffer(doubles[:len(doubles) // 8 * 8], "<f8").tolist()
    return {key: value if location == 0 else sizes[value] for key, location, _, value in table
            if location == 0 or location == DOUBLES_RECORD and value < len(sizes)}


def _contradiction(written, heights, plane, vertical, place):
    """What the GeoKeys, which name `plane` and `vertical`, say otherwise than the CRS that was written as WKT, and its heights; "" for nothing."""
    if plane is not None and moved_by(plane, horizontal_part(written), place) > IO.same_datum:
        return f"its WKT says {horizontal_part(written).name}, its GeoKeys say {plane.name}"
    if heights is not None and vertical is not None and not _same_unit(heights, vertical.axis_info[0].unit_conversion_factor):
        return f"its WKT says that heights are in {heights.axis_info[0].unit_name}, its GeoKeys say {vertical.axis_info[0].unit_name}"
    return ""


def _of_keys(values):
    """The horizontal and vertical CRS that GeoKeys name, None where they do not, and what contradicts itself in them."""
    plane, vertical = _coded(values.get(PROJECTED)) or _coded(values.get(GEODETIC)), _coded(values.get(VERTICAL))
    if _of_heights(plane):
        plane = None
    if not _of_heights(vertical):   # codes of datums, which older files have there
        vertical = None
    factor, unit = _length(values.get(HEIGHT_UNIT), None)
    if factor and (vertical is None or not _same_unit(vertical, factor)):
        vertical = _vertical(vertical, factor, unit)
    return plane, vertical, _problem_of_units(plane, vertical, *_length(values.get(LENGTH_UNIT), values.get(LENGTH_SIZE)))


def _problem_of_units(plane, vertical, factor, unit):
    """What contradicts itself where x and y have a unit of `factor` metres, None where that is not said."""
    if plane is None:
        if factor and abs(factor - 1.0) > IO.same_unit:
            return f"its x and y are in {unit}, and the CRS that they lie in is not known"
        if vertical is not None and not _same_unit(vertical, 1.0):
            return f"its heights are in {vertical.axis_info[0].unit_name}, and the CRS of its x and y is not known"
    elif factor and not plane.is_geographic and not _same_unit(plane, factor):
        return f"its code says {plane.name}, whose unit is {plane.axis_info[0].unit_name}, and its unit key says {unit}"
    return ""


def _joined(plane, vertical):
    """WKT of a compound CRS where heights have another unit than x and y, else of the horizontal one; "" without one."""
    from pyproj.crs import CompoundCRS

    if plane is None:
        return ""
    across = 1.0 if plane.is_geographic else plane.axis_info[0].unit_conversion_factor
    if vertical is None or plane.is_compound or _same_unit(vertical, across):
        return plane.to_wkt()
    return CompoundCRS(name=f"{plane.name} + {vertical.name}", components=[plane, vertical]).to_wkt()


def _vertical(crs, factor, unit):
    """A vertical CRS with another unit, or of an unknown datum."""
    content = {"type": "VerticalCRS", "name": "height", "datum": {"type": "VerticalReferenceFrame", "name": "unknown"}, "coordinate_system": {
        "subtype": "vertical", "axis": [{"name": "Height", "abbreviation": "H", "direction": "up"}]}} if crs is None else crs.to_json_dict()
    content.pop("id", None)
    content["name"] += f" ({unit})"
    content["coordinate_system"]["axis"][0]["unit"] = {"type": "LinearUnit", "name": unit, "conversion_factor": factor}
    return pyproj.CRS.from_json_dict(content)


def _of_heights(crs):
    """Whether a CRS is one of heights alone."""
    return crs is not None and crs.is_vertical and not crs.is_compound


def _same_unit(crs, factor):
    """Whether the first axis of a CRS has a unit of `factor` metres."""
    return abs(crs.axis_info[0].unit_conversion_factor / factor - 1.0) < IO.same_unit


@lru_cache(maxsize=256)
def _length(code, size):
    """(metres, name) of a unit of length by its EPSG code, or its size where it has none; (None, "") where it is not said."""
    from pyproj.database import get_units_map

    for unit in get_units_map("EPSG", "linear").values() if code in EPSG_CODES else ():
        if unit.code == str(code):
            return unit.conv_factor, unit.name
    return (float(size), f"units of {size:g} m") if size else (None, "")


def _coded(code):
    """The CRS of an EPSG code, None where it is none."""
    return _crs(pyproj.CRS.from_epsg, code if code in EPSG_CODES else None)


@lru_cache(maxsize=256)
def _crs(read, given):
    """The CRS that a reader of pyproj makes of what is given; None for None, or where it is not understood."""
    try:
        return None if given is None else read(given)
    except pyproj.exceptions.CRSError:
        return None
