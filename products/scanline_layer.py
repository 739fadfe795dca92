"""Normalized scanlines as a layer of simplified lines in map coordinates with the intensity as M, and back."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ..core.common.errors import RoadExtractionError
from ..core.common.features import SCANLINES, Features, Field
from ..core.common.progress import Progress
from ..core.common.setting import Limited, setting
from ..core.lazy import laspy
from ..core.road.scanlines.grid import Scanlines
from ..core.road.scanlines.section_planes import ScanlineSettings, all_scanlines
from ..core.survey.frame.road_frame import RoadFrame
from ..core.survey.lattice.scan_lattice import find_lattice
from ..core.survey.road_points_las import metres_of_file, new_laz, place_in_file
from ..core.survey.store.records import COORDINATE_SCALE
from ..core.survey.survey import Survey

SPOOL_MEMORY = 32 * 2**20  # bytes of lines in memory before a temporary file is used
WKB_TYPE = 3002           # ISO WKB: LineString with Z and M
MIN_LAYER_LINE = 0.10      # m: shorter lines, of leaves and railings, are left out of the layer
MAX_LAYER_OFFSET = 200.0   # m: vertices of a layer are searched up to here from the reference line
MAX_STATION_ERROR = 0.05   # m between the station of a line and those of its vertices,
MIN_MATCHING_SHARE = 0.9   # and the vertices that must be within it: else the layer belongs to another trajectory
WKB_HEADER = np.dtype([("order", "u1"), ("type", "<u4"), ("count", "<u4")])


@dataclass(frozen=True)
class ScanlineLayerSettings(Limited):
    """How scanlines, and points along them, are written."""

    simplify: float = setting(0.002, 0.0, 1.0, "The simplification", "m")   # from the measured line; 0 = none
    spacing: float = setting(0.05, 0.005, 5.0, "The point spacing", "m")   # between points along a scanline


def write_scanlines(survey: Survey, settings: ScanlineSettings = ScanlineSettings(), layer: ScanlineLayerSettings | None = None,
                    points: ResampledPoints | None = None, progress: Progress = Progress()) -> tuple[LineSpool, int]:
    """(LineSpool with the fields SCANLINES, number of scanlines) of a survey, and evenly spaced points of them in a cloud, section by section.

    Without `layer` the LineSpool is empty; without `points`, ResampledPoints open for writing, there is no cloud.
    """
    lattice = find_lattice(survey, settings.rotation_frequency, progress.part(0.0, 0.2))
    spool, count = LineSpool("LineStringZM", SCANLINES, survey.crs), 0
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        part = progress.part(0.2 + 0.8 * i / len(roads), 0.2 + 0.8 * (i + 1) / len(roads))
        for lines in all_scanlines(survey, road, settings, lattice, part):
            count += len(lines)
            if layer is not None and len(lines):
                _add_to_layer(spool, lines, survey.frame, road, settings.interval, layer.simplify)
            if points is not None:
                points.add(lines, survey.frame, road)
    short = count - len(spool) if layer is not None else 0
    progress.info(f"Scanlines: {count:,}, {settings.interval:g} m apart"
                 + (f"; {short:,} lines shorter than {MIN_LAYER_LINE:g} m are not in the layer." if short else "."))
    return spool, count


def _add_to_layer(spool: LineSpool, lines: Scanlines, frame: RoadFrame, road: int, interval: float, simplify: float) -> None:
    """Append scanlines of a road, which lie in planes `interval` m apart, to a LineSpool."""
    length = line_lengths(lines)
    lines, length = lines[length >= MIN_LAYER_LINE], length[length >= MIN_LAYER_LINE]
    lines = simplified_lines(lines, simplify)
    x, y, z = frame.to_map(road, np.repeat(lines.station, np.diff(lines.first)), lines.d, lines.z)
    spool.add(np.c_[x, y, z, lines.intensity], lines.first, road=road, station_m=np.round(lines.station, 4), length_m=np.round(length, 3),
              interval_m=interval, scanner=lines.scanner, pass_sig_m=frame.passes_sigma(road, lines.station) if road in frame.pass_sigma else None,
              **{"pass": lines.pass_number})


def line_lengths(lines: Scanlines) -> np.ndarray:
    """(L,) m, lengths of L scanlines."""
    step = np.hypot(np.diff(lines.d), np.diff(lines.z))
    step[lines.first[1:-1] - 1] = 0.0
    along = np.r_[0.0, np.cumsum(step)]
    return along[lines.first[1:] - 1] - along[lines.first[:-1]]


def simplified_lines(lines: Scanlines, tolerance: float) -> Scanlines:
    """Scanlines without vertices nearer than `tolerance` m to the simplified line, by the algorithm of Douglas and Peucker (1973); 0 keeps all."""
    if tolerance <= 0 or not len(lines):
        return lines
    number = np.arange(len(lines.d), dtype=np.float64)
    shapes = shapely.linestrings(np.c_[lines.d, lines.z, number], indices=lines.line_of_vertex())
    vertices, line = shapely.get_coordinates(shapely.simplify(shapes, tolerance, preserve_topology=False), include_z=True, return_index=True)
    remaining = vertices[:, 2].astype(np.int64)
    first = np.searchsorted(line, np.arange(len(lines) + 1))
    return Scanlines(lines.station, lines.pass_number, lines.scanner, first,
                     lines.d[remaining], lines.z[remaining], lines.intensity[remaining])


def scanlines_from_features(features: Features, frame: RoadFrame) -> tuple[dict[int, Scanlines], float]:
    """({road: Scanlines}, m between section planes) of a layer that Lanewright wrote, ISO WKB, in the road frame of its trajectory.

    Raises RoadExtractionError if there are none, their intervals differ, or they do not lie across the roads of the trajectory.
    """
    intervals = set(features.column("interval_m"))
    if len(intervals) != 1:
        raise RoadExtractionError(
            "The layer of scanlines is empty. Run Normalized scanlines again." if not intervals else
            f"The scanlines have different intervals ({', '.join(f'{value:g}' for value in sorted(intervals))} m). "
            "Give the layer of one run of Normalized scanlines.")
    roads = np.array(features.column("road"), np.int64)
    if roads.max() >= len(frame.roads):
        raise RoadExtractionError(f"The scanlines belong to {roads.max() + 1} roads, but the trajectory has {len(frame.roads)}. "
                                  "Give both steps the same trajectory.")
    scanlines = {}
    for road in np.unique(roads):
        rows = np.flatnonzero(roads == road)
        scanlines[int(road)] = _in_frame(frame, int(road), [features.geometries[k] for k in rows], [features.rows[k] for k in rows])
    return scanlines, float(intervals.pop())


def _in_frame(frame, road, geometries, rows):
    """Scanlines of one road from the WKB and the rows of its lines."""
    parts = [coordinates_of(geometry) for geometry in geometries]
    first = np.r_[0, np.cumsum([len(part) for part in parts])]
    x, y, z, intensity = np.concatenate(parts).T
    station, number, scanner = (np.array([row[name] for row in rows]) for name in ("station_m", "pass", "scanner"))
    x, y, z = frame.to_local(x, y, z)
    s = np.repeat(station, np.diff(first))
    foot, d = frame.road(road).locate(x, y, s, corridor=MAX_LAYER_OFFSET)
    # vertices beyond the centre of a bend have no station
    if not np.mean(np.abs(foot - s) < MAX_STATION_ERROR) > MIN_MATCHING_SHARE:
        raise RoadExtractionError("The scanlines do not lie across the road of the trajectory. Give both steps the same trajectory.")
    good = np.isfinite(d)
    d = np.where(good, d, 0.0)
    # lines with such vertices are left out
    whole = np.add.reduceat(~good, first[:-1]) == 0
    lines = Scanlines(station, number, scanner, first, d, z, np.nan_to_num(intensity).astype(np.float32))[whole]
    return lines[np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, lines.station))]


class LineSpool:
    """Lines with Z and M in a temporary file, which can be written like a Features layer; iterating gives (WKB, row) pairs."""

    def __init__(self, geometry_type: str, schema: Sequence[Field], crs: str = ""):
        self.geometry_type, self.schema, self.crs = geometry_type, list(schema), crs
        self._file = tempfile.SpooledTemporaryFile(SPOOL_MEMORY, prefix="lanewright-")
        self._chunks: list[tuple[np.ndarray, dict[str, np.ndarray]]] = []

    def add(self, coordinates: np.ndarray, first: np.ndarray, **columns: Any) -> None:
        """Append L lines with V vertices, (V, 4) map x, y, z in m, and M.

        first : (L + 1,) int, vertices first[i]:first[i + 1] belong to line i
        columns : by field name, (L,) values or one for all
        """
        if len(first) > 1:
            for line in np.split(np.asarray(coordinates, "<f8"), first[1:-1]):
                self._file.write(np.array((1, WKB_TYPE, len(line)), WKB_HEADER).tobytes() + line.tobytes())
            rows = {name: np.broadcast_to(values, len(first) - 1) for name, values in columns.items()}
            self._chunks.append((np.diff(first), rows))

    def __del__(self) -> None:
        self._file.close()

    def __len__(self) -> int:
        return sum(len(counts) for counts, _ in self._chunks)

    def __iter__(self) -> Iterator[tuple[bytes, dict[str, Any]]]:
        self._file.seek(0)
        for counts, columns in self._chunks:
            sizes = WKB_HEADER.itemsize + 32 * counts
            data = memoryview(self._file.read(int(sizes.sum())))
            ends = np.cumsum(sizes).tolist()
            names = list(columns)
            for first, end, values in zip([0, *ends], ends, zip(*(columns[name].tolist() for name in names))):
                yield bytes(data[first:end]), dict(zip(names, values))


def coordinates_of(wkb: bytes) -> np.ndarray:
    """(V, 4) x, y, z, M of the little-endian ISO WKB of a LineString with Z and M, as QGIS and LineSpool write it; ValueError for another."""
    header = np.frombuffer(wkb, WKB_HEADER, 1)[0]
    if header["order"] != 1 or header["type"] != WKB_TYPE:
        raise ValueError(f"not a LineString with Z and M: WKB type {header['type']}")
    return np.frombuffer(wkb, "<f8", 4 * int(header["count"]), WKB_HEADER.itemsize).reshape(-1, 4)


# Evenly spaced points along normalized scanlines: a point cloud whose density does not depend on the range.

SCANLINE_DIMENSIONS = [("road", "uint16", "Road", None), ("pass", "uint16", "Pass", None), ("scanner", "uint8", "Scanner", None),
         ("station_m", "int32", "Station along the road", COORDINATE_SCALE), ("offset_m", "int32", "Offset, left positive", COORDINATE_SCALE)]


def resample_scanlines(lines: Scanlines, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points at equal steps of `spacing` m along every scanline, from its first vertex: (N,) number of the line, offset and local height, m,
    and raw intensity.
    """
    if not len(lines):
        return np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0)
    first, last = lines.first[:-1], lines.first[1:] - 1
    step = np.hypot(np.diff(lines.d), np.diff(lines.z))
    # a long step from one line to the next, so that no point lies between them
    step[last[:-1]] = 2 * spacing
    along = np.r_[0.0, np.cumsum(step)]
    number = np.floor((along[last] - along[first]) / spacing + 1e-9).astype(np.int64) + 1
    line = np.repeat(np.arange(len(lines)), number)
    within = np.arange(number.sum()) - np.repeat(np.cumsum(number) - number, number)
    distances = np.minimum(along[first][line] + within * spacing, along[last][line])
    d, z, intensity = (np.interp(distances, along, values) for values in (lines.d, lines.z, lines.intensity))
    return line, d, z, intensity


class ResampledPoints:
    """A LAZ or LAS file of points along scanlines, a context manager: the file appears when it is complete, and not at all after an error.

    origin : (3,) m, map coordinates of the local origin
    crs : WKT, "" where unknown
    farthest : m in x or y from the origin, of the farthest point; beyond 214 km coordinates are rounded to 1 mm
    """

    def __init__(self, path: str, origin: np.ndarray, crs: str, settings: ScanlineLayerSettings = ScanlineLayerSettings(), farthest: float = 0.0):
        self.path, self.settings = str(path), settings
        self._header = laspy.LasHeader(point_format=6, version="1.4")
        self._header.generating_software = "Lanewright"
        self._header.add_extra_dims([
            laspy.ExtraBytesParams(name=name, type=kind, description=text,
                                   **({} if scale is None else dict(scales=np.array([scale]), offsets=np.array([0.0]))))
            for name, kind, text, scale in SCANLINE_DIMENSIONS])
        place_in_file(self._header, origin, crs, farthest)
        self._metres = metres_of_file(self._header, crs)
        self.count = 0

    def __enter__(self) -> ResampledPoints:
        self._file = new_laz(self.path, self._header)
        self._writer = self._file.__enter__()
        return self

    def add(self, lines: Scanlines, frame: RoadFrame, road: int) -> None:
        """Append points of the scanlines of a road."""
        line, d, z, intensity = resample_scanlines(lines, self.settings.spacing)
        if not len(line):
            return
        s = lines.station[line]
        x, y = frame.road(road).to_map(s, d)
        out = laspy.ScaleAwarePointRecord.zeros(len(line), header=self._header)
        for name, values, metres in zip("XYZ", (x, y, z), self._metres):
            out.array[name] = np.rint(values / metres)
        out["intensity"] = np.clip(np.rint(intensity), 0, 65535)
        out["return_number"] = out["number_of_returns"] = np.ones(len(line), np.uint8)
        out["point_source_id"] = lines.scanner[line] + 1
        out.array["road"], out.array["pass"], out.array["scanner"] = road, lines.pass_number[line], lines.scanner[line]
        out.array["station_m"], out.array["offset_m"] = np.rint(s / COORDINATE_SCALE), np.rint(d / COORDINATE_SCALE)
        self._writer.write_points(out)
        self.count += len(line)

    def __exit__(self, *problem: Any) -> bool | None:
        return self._file.__exit__(*problem)
