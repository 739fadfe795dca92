"""Evenly spaced points along normalized scanlines: a point cloud whose density does not depend on the range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.setting import check_limits, setting
from ...survey.las.writer import metres_of_file, new_laz, place_in_file
from ...survey.store.records import COORDINATE_SCALE
from .grid import Scanlines

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame

SCANLINE_DIMENSIONS = [("road", "uint16", "Road", None), ("pass", "uint16", "Pass", None), ("scanner", "uint8", "Scanner", None),
         ("station_m", "int32", "Station along the road", COORDINATE_SCALE), ("offset_m", "int32", "Offset, left positive", COORDINATE_SCALE)]


@dataclass(frozen=True)
class ResamplingSettings:
    """Points along scanlines.

    Attributes
    ----------
    spacing : m between points along a scanline
    """

    spacing: float = setting(0.05, 0.005, 5.0, "The point spacing", "m")

    def __post_init__(self):
        """Check the limits of all settings."""
        check_limits(self)


def resample_scanlines(lines: Scanlines, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points at equal steps along every scanline, from its first vertex.

    Parameters
    ----------
    lines : Scanlines
    spacing : m along the line

    Returns
    -------
    line : (N,) int, number of the line
    d, z : (N,) m, offset and local height
    intensity : (N,) raw counts
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
    at = np.minimum(along[first][line] + within * spacing, along[last][line])
    d, z, intensity = (np.interp(at, along, values) for values in (lines.d, lines.z, lines.intensity))
    return line, d, z, intensity


class ResampledPoints:
    """A LAZ or LAS file of points along scanlines, used as a context manager.

    The file appears when it is complete, and not at all after an error.

    Parameters
    ----------
    path : of the file
    origin : (3,) m, map coordinates of the local origin
    crs : WKT, "" where unknown
    settings : ResamplingSettings
    farthest : m in x or y from the origin, of the farthest point; beyond 214 km coordinates are rounded to 1 mm
    """

    def __init__(self, path: str, origin: np.ndarray, crs: str, settings: ResamplingSettings = ResamplingSettings(), farthest: float = 0.0):
        import laspy

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
        """Append points of the scanlines of a road.

        Parameters
        ----------
        lines : Scanlines
        frame : RoadFrame
        road : number of the road
        """
        import laspy

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
