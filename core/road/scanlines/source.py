"""Sources of normalized scanlines: sections of a survey, computed on demand, or a layer."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...execution.phase import THREADS, Executor, Recipe
from ...survey.lattice.scan_lattice import ScanLattice, find_lattice
from ...survey.reading.sensor_height import DEFAULT_SENSOR_HEIGHT, sensor_height_of
from .grid import LINE_SEPARATION
from .scanlines import Scanlines
from .section_planes import ScanlineSettings, scanline_runs

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.survey import Survey
    from ..common.decimation import LevelGround


class SurveyScanlines:
    """The scanlines of a survey, computed on demand.

    Parameters
    ----------
    survey : Survey
    settings : ScanlineSettings
    sensor_height : m from the trajectory down to the road, 0 = from the data
    lattice : ScanLattice, or None to find it here
    progress : Progress of finding it
    level : LevelGround that is left out; None uses all points

    Attributes
    ----------
    frame : RoadFrame
    crs : WKT
    interval, corridor : m, of the settings
    """

    def __init__(self, survey: Survey, settings: ScanlineSettings = ScanlineSettings(), sensor_height: float = 0.0,
                 lattice: ScanLattice | None = None, progress: Progress = Progress(), level: LevelGround | None = None):
        self.settings, self.sensor_height, self.level = settings, sensor_height, level
        self.survey, self.interval, self.corridor = survey, self.settings.interval, self.settings.corridor
        self.lattice = find_lattice(survey, self.settings.rotation_frequency, progress) if lattice is None else lattice
        self.frame, self.crs = survey.frame, survey.crs

    @property
    def executor(self) -> Executor:
        """Who runs the phases that read these scanlines."""
        return self.survey.executor

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the scanlines."""
        level = None if self.level is None else self.level.recipe(folder)
        return Recipe("road.scanlines.source:SurveyScanlines", dict(survey=self.survey.recipe(folder), settings=self.settings, level=level,
                                                                    sensor_height=self.sensor_height, lattice=self.lattice))

    def stretch(self, road: int, start: float, end: float) -> str:
        """What messages call the road between two stations, m."""
        return self.survey.stretch(road, start, end)

    def points_between(self, road: int, start: float, end: float) -> int:
        """About how many points lie between two stations (m)."""
        return self.survey.store.points_between(road, start, end)

    def roads(self) -> list[int]:
        """Numbers of the roads."""
        return self.survey.store.roads()

    def span(self, road: int) -> tuple[float, float]:
        """Stations at which a road begins and ends, m."""
        return self.survey.store.span(road)

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """Expected local z of the road at (N,) stations, (N,) m."""
        if self.sensor_height:
            return self.frame.track_height(road, s) - self.sensor_height
        return self.survey.road_height(road, s)

    def runs(self, road: int, start: float, end: float) -> list[Scanlines]:
        """The scanlines with start <= station < end, apart for each pass and scanner; their intensity is 0."""
        level = None if self.level is None else partial(self.level, road)
        return scanline_runs(self.survey, road, start, end, self.settings, self.lattice, intensity=False, level=level)


class LayerScanlines:
    """The scanlines of a layer, in the road frame of the trajectory they were made with.

    Parameters
    ----------
    lines : dict of road number to Scanlines, each sorted by station
    frame : RoadFrame
    interval : m between section planes
    crs : WKT
    sensor_height : m from the trajectory down to the road, 0 = from the data

    Attributes
    ----------
    frame, interval, crs : as given
    corridor : m, greatest offset of a vertex
    level : None; all points are used

    Raises
    ------
    RoadExtractionError
        If no road has scanlines on two planes.
    """

    def __init__(self, lines: dict[int, Scanlines], frame: RoadFrame, interval: float, crs: str, sensor_height: float = 0.0):
        self.lines = {road: found for road, found in sorted(lines.items()) if len(found)}
        self.level: LevelGround | None = None
        self.executor: Executor = THREADS
        self.frame, self.interval, self.crs = frame, interval, crs
        if not any(len(np.unique(found.station)) > 1 for found in self.lines.values()):
            raise RoadExtractionError("The scanlines of every road lie on fewer than two section planes, so no curb can be followed along "
                                      "the road. Make them with Normalized scanlines along the whole trajectory.")
        self.corridor = max(float(np.abs(found.d).max()) for found in self.lines.values())
        self.heights = {p.number: sensor_height for p in frame.passes} if sensor_height else self._sensor_heights()

    def _sensor_heights(self):
        """m from the trajectory down to the road by pass, where its scanlines cross its own track."""
        known = {}
        for p in self.frame.passes:
            drops = []
            if p.road in self.lines:
                lines = self.lines[p.road]
                lines = lines[lines.pass_number == p.number]
                drops = _drops(lines, *p.at_station(lines.station))
            height = sensor_height_of(drops)
            if height is not None:
                known[p.number] = height
        typical = float(np.median(list(known.values()))) if known else DEFAULT_SENSOR_HEIGHT
        return {p.number: known.get(p.number, typical) for p in self.frame.passes}

    def stretch(self, road: int, start: float, end: float) -> str:
        """What messages call the road between two stations, m."""
        return f"road {road}, {start:.0f} to {end:.0f} m"

    def points_between(self, road: int, start: float, end: float) -> int:
        """Points are not known; 0."""
        return 0

    def roads(self) -> list[int]:
        """Numbers of the roads."""
        return list(self.lines)

    def span(self, road: int) -> tuple[float, float]:
        """Stations at which a road begins and ends, m."""
        stations = self.lines[road].station
        return float(stations[0]), float(stations[-1])

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """Expected local z of the road at (N,) stations, (N,) m."""
        return self.frame.track_height(road, s, self.heights)

    def runs(self, road: int, start: float, end: float) -> list[Scanlines]:
        """The scanlines with start <= station < end, apart for each pass and scanner."""
        first, last = np.searchsorted(self.lines[road].station, (start, end))
        return self.lines[road][first:last].runs()


def _drops(lines, track_d, track_z):
    """m from the track down to every line that it crosses."""
    if not len(lines):
        return np.empty(0)
    under = (lines.d[lines.first[:-1]] <= track_d) & (lines.d[lines.first[1:] - 1] >= track_d)
    number = np.arange(len(lines)) * LINE_SEPARATION
    z = np.interp(number + track_d, np.repeat(number, np.diff(lines.first)) + lines.d, lines.z)
    return (track_z - z)[under]
