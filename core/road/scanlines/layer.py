"""Normalized scanlines as a layer: simplified lines in map coordinates, intensity as measure, and back again."""

import tempfile
from dataclasses import dataclass

import numpy as np
import shapely

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...common.schemas import SCANLINES
from ...common.setting import check_limits, setting
from ...survey.lattice.scan_lattice import find_lattice
from .scanlines import Scanlines
from .section_planes import ScanlineSettings, all_scanlines

# Many long lines on their way into a layer: written down as they come, read back one by one.

SPOOL_MEMORY = 32 * 2**20  # bytes before a temporary file is used
WKB_TYPE = 3002         # ISO: LineString with Z and M
WKB_HEADER = np.dtype([("order", "u1"), ("type", "<u4"), ("count", "<u4")])


class LineSpool:
    """Lines with Z and M, kept as WKB; to a layer's writer the same as Features.

    Attributes: geometry_type, schema, crs as in Features. Iterating gives (WKB, row) pairs.
    """

    def __init__(self, geometry_type, schema, crs=""):
        self.geometry_type, self.schema, self.crs = geometry_type, list(schema), crs
        self._file = tempfile.SpooledTemporaryFile(SPOOL_MEMORY, prefix="lanewright-")
        self._chunks = []

    def add(self, coordinates, first, **columns):
        """Append L lines.

        Parameters
        ----------
        coordinates : (V, 4) map x, y, z and m
        first : (L + 1,) vertices first[i]:first[i + 1] are those of line i
        columns : by field name, (L,) values or one for all
        """
        if len(first) > 1:
            self._file.write(lines_as_wkb(coordinates, first).tobytes())
            rows = {name: np.broadcast_to(values, len(first) - 1) for name, values in columns.items()}
            self._chunks.append((np.diff(first), rows))

    def __del__(self):
        self._file.close()

    def __len__(self):
        return sum(len(counts) for counts, _ in self._chunks)

    def __iter__(self):
        self._file.seek(0)
        for counts, columns in self._chunks:
            sizes = WKB_HEADER.itemsize + 32 * counts
            data = memoryview(self._file.read(int(sizes.sum())))
            ends = np.cumsum(sizes).tolist()
            names = list(columns)
            for first, end, values in zip([0, *ends], ends, zip(*(columns[name].tolist() for name in names))):
                yield bytes(data[first:end]), dict(zip(names, values))


def lines_as_wkb(coordinates, first):
    """(bytes,) uint8: the WKB of lines, one after the other."""
    counts = np.diff(first)
    headers = np.empty(len(counts), WKB_HEADER)
    headers["order"], headers["type"], headers["count"] = 1, WKB_TYPE, counts
    size = WKB_HEADER.itemsize
    out = np.empty(size * len(counts) + 32 * len(coordinates), np.uint8)
    in_header = np.zeros(len(out), bool)
    begins = 32 * np.asarray(first[:-1]) + size * np.arange(len(counts))
    in_header[(begins[:, None] + np.arange(size)).ravel()] = True
    out[in_header] = headers.view(np.uint8)
    out[~in_header] = np.ascontiguousarray(coordinates, "<f8").view(np.uint8).ravel()
    return out


def coordinates_of(wkb):
    """(V, 4) x, y, z, m of a line's WKB (little endian, ISO), as QGIS and LineSpool write it."""
    header = np.frombuffer(wkb, WKB_HEADER, 1)[0]
    if header["order"] != 1 or header["type"] != WKB_TYPE:
        raise ValueError(f"not a LineString with Z and M: WKB type {header['type']}")
    return np.frombuffer(wkb, "<f8", 4 * int(header["count"]), WKB_HEADER.itemsize).reshape(-1, 4)

MIN_LAYER_LINE = 0.10    # m: pieces of leaves and railings are left out of the layer


@dataclass(frozen=True)
class ScanlineLayerSettings:
    """How scanlines are written. simplify : m that a simplified line may deviate from the measured one; 0 = not simplified."""

    simplify: float = setting(0.002, 0.0, 1.0, "The simplification", "m")

    def __post_init__(self):
        check_limits(self)


def write_scanlines(survey, settings=ScanlineSettings(), layer=None, points=None, progress=Progress()):
    """The scanlines of a survey into a layer, and evenly spaced points of them into a cloud, section by section.

    Parameters
    ----------
    survey : Survey
    settings : ScanlineSettings
    layer : ScanlineLayerSettings, or None where no layer is wanted
    points : ResampledPoints open for writing, or None

    Returns
    -------
    LineSpool of SCANLINES (empty where no layer is wanted), number of scanlines
    """
    lattice = find_lattice(survey, settings.rotation_frequency, progress.part(0.0, 0.2))
    spool, count = LineSpool("LineStringZM", SCANLINES, survey.crs), 0
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        part = progress.part(0.2 + 0.8 * i / len(roads), 0.2 + 0.8 * (i + 1) / len(roads))
        for lines in all_scanlines(survey, road, settings, lattice, part):
            count += len(lines)
            if layer is not None and len(lines):
                add_to_layer(spool, lines, survey.frame, road, settings.interval, layer.simplify)
            if points is not None:
                points.add(lines, survey.frame, road)
    short = count - len(spool) if layer is not None else 0
    progress.info(f"Scanlines: {count:,}, {settings.interval:g} m apart"
                 + (f"; {short:,} pieces shorter than {MIN_LAYER_LINE:g} m are not in the layer." if short else "."))
    return spool, count


def add_to_layer(spool, lines, frame, road, interval, simplify):
    """Append the scanlines of a road to a LineSpool."""
    length = line_lengths(lines)
    lines, length = lines[length >= MIN_LAYER_LINE], length[length >= MIN_LAYER_LINE]
    lines = simplified_lines(lines, simplify)
    x, y, z = frame.to_map(road, np.repeat(lines.station, np.diff(lines.first)), lines.d, lines.z)
    spool.add(np.c_[x, y, z, lines.intensity], lines.first, road=road, station_m=np.round(lines.station, 4), length_m=np.round(length, 3),
              interval_m=interval, scanner=lines.scanner, **{"pass": lines.pass_number})


def line_lengths(lines):
    """(L,) metres along each line."""
    step = np.hypot(np.diff(lines.d), np.diff(lines.z))
    step[lines.first[1:-1] - 1] = 0.0
    along = np.r_[0.0, np.cumsum(step)]
    return along[lines.first[1:] - 1] - along[lines.first[:-1]]


def simplified_lines(lines, tolerance):
    """The lines without the vertices that lie within `tolerance` metres of the line through the others (Douglas-Peucker)."""
    if tolerance <= 0 or not len(lines):
        return lines
    number = np.arange(len(lines.d), dtype=np.float64)
    shapes = shapely.linestrings(np.c_[lines.d, lines.z, number], indices=lines.line_of_vertex())
    found, line = shapely.get_coordinates(shapely.simplify(shapes, tolerance, preserve_topology=False), include_z=True, return_index=True)
    kept = found[:, 2].astype(np.int64)
    first = np.searchsorted(line, np.arange(len(lines) + 1))
    return Scanlines(lines.station, lines.pass_number, lines.scanner, first, lines.d[kept], lines.z[kept], lines.intensity[kept])


def scanlines_from_features(features, frame):
    """The scanlines of a layer that Lanewright wrote, in the road frame of its trajectory.

    Parameters
    ----------
    features : geometries LineStringZM as WKB (see spool) with the fields SCANLINES
    frame : RoadFrame

    Returns
    -------
    ({road: Scanlines}, interval in metres)

    Raises
    ------
    RoadExtractionError
        If there are none, their intervals differ, or they do not lie across the trajectory's roads.
    """
    intervals = set(features.column("interval_m"))
    if len(intervals) != 1:
        raise RoadExtractionError(
            "The scanlines layer is empty. Make the normalized scanlines again." if not intervals else
            f"The scanlines lie at different intervals ({', '.join(f'{value:g}' for value in sorted(intervals))} m). "
            "Give it the layer of one run of normalized scanlines.")
    roads = np.array(features.column("road"), np.int64)
    if roads.max() >= len(frame.roads):
        raise RoadExtractionError(f"The scanlines belong to {roads.max() + 1} roads, the trajectory has {len(frame.roads)}. "
                                  "Give both steps the same trajectory.")
    found = {}
    for road in np.unique(roads):
        own = np.flatnonzero(roads == road)
        found[int(road)] = _in_frame(frame, int(road), [features.geometries[k] for k in own], [features.rows[k] for k in own])
    return found, float(intervals.pop())


def _in_frame(frame, road, geometries, rows):
    parts = [coordinates_of(geometry) for geometry in geometries]
    first = np.r_[0, np.cumsum([len(part) for part in parts])]
    x, y, z, intensity = np.concatenate(parts).T
    station, number, scanner = (np.array([row[name] for row in rows]) for name in ("station_m", "pass", "scanner"))
    x, y, z = frame.to_local(x, y, z)
    s = np.repeat(station, np.diff(first))
    foot, d = frame.road(road).locate(x, y, s, corridor=200.0)
    # a vertex beyond the centre of a bend has no foot; one far from its station has another trajectory's
    if not np.mean(np.abs(foot - s) < 0.05) > 0.9:
        raise RoadExtractionError("The scanlines do not lie across the trajectory's road. Give both steps the same trajectory.")
    good = np.isfinite(d)
    d = np.where(good, d, 0.0)
    # of simplified lines those that lost vertices are left out whole
    whole = np.add.reduceat(~good, first[:-1]) == 0
    lines = Scanlines(station, number, scanner, first, d, z, np.nan_to_num(intensity).astype(np.float32))[whole]
    return lines[np.lexsort((lines.d[lines.first[:-1]], lines.scanner, lines.pass_number, lines.station))]
