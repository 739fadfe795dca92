"""Where normalized scanlines come from: cut from a survey section by section, or read from a layer."""

from functools import partial

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...survey.lattice.scan_lattice import find_lattice
from ...survey.sensor_height import DEFAULT_HEIGHT, height_above
from .grid import LINE_SEPARATION
from .section_planes import ScanlineSettings, scanline_runs


class SurveyScanlines:
    """The scanlines of a survey, made when they are asked for.

    settings : ScanlineSettings
    sensor_height : m from the trajectory down to the road, 0 = from the data
    lattice : ScanLattice; found here where it is not given
    level : function of road, pass number, start and end (metres): the LevelStrip that is left out; None leaves nothing out
    """

    def __init__(self, survey, settings=ScanlineSettings(), sensor_height=0.0, lattice=None, progress=Progress(), level=None):
        self.settings, self.sensor_height, self.level = settings, sensor_height, level
        self.survey, self.interval, self.corridor = survey, self.settings.interval, self.settings.corridor
        self.lattice = find_lattice(survey, self.settings.rotation_frequency, progress) if lattice is None else lattice
        self.frame, self.crs = survey.frame, survey.crs

    def roads(self):
        return self.survey.store.roads()

    def span(self, road):
        return self.survey.store.span(road)

    def road_height(self, road, s):
        """(N,) local z at which the road is expected."""
        if self.sensor_height:
            return self.frame.track_height(road, s) - self.sensor_height
        return self.survey.road_height(road, s)

    def runs(self, road, start, end):
        """List of Scanlines with start <= station < end, each of one pass and scanner; intensity is left out."""
        level = None if self.level is None else partial(self.level, road)
        return scanline_runs(self.survey, road, start, end, self.settings, self.lattice, intensity=False, level=level)


class LayerScanlines:
    """The scanlines of a layer, with the frame of the trajectory they were made along.

    Parameters
    ----------
    lines : dict of road number to Scanlines, each ordered by station
    frame : RoadFrame
    interval : m between their section planes
    crs : WKT
    sensor_height : m from the trajectory down to the road, 0 = from the data

    Raises
    ------
    RoadExtractionError
        If no road has scanlines on two planes.
    """

    def __init__(self, lines, frame, interval, crs, sensor_height=0.0):
        self.lines, self.level = {road: found for road, found in sorted(lines.items()) if len(found)}, None
        self.frame, self.interval, self.crs = frame, interval, crs
        if not any(len(np.unique(found.station)) > 1 for found in self.lines.values()):
            raise RoadExtractionError("The scanlines lie on fewer than two section planes of one road, so no curb can be followed from one "
                                      "to the next. Make them with Normalized scanlines along the whole trajectory.")
        self.corridor = max(float(np.abs(found.d).max()) for found in self.lines.values())
        self.heights = {p.number: sensor_height for p in frame.passes} if sensor_height else self._sensor_heights()

    def _sensor_heights(self):
        """m from the trajectory down to the road, by pass, where its scanlines cross its own track."""
        known = {}
        for p in self.frame.passes:
            drops = []
            if p.road in self.lines:
                lines = self.lines[p.road]
                lines = lines[lines.pass_number == p.number]
                drops = _drops(lines, *p.at_station(lines.station))
            height = height_above(drops)
            if height is not None:
                known[p.number] = height
        usual = float(np.median(list(known.values()))) if known else DEFAULT_HEIGHT
        return {p.number: known.get(p.number, usual) for p in self.frame.passes}

    def roads(self):
        return list(self.lines)

    def span(self, road):
        stations = self.lines[road].station
        return float(stations[0]), float(stations[-1])

    def road_height(self, road, s):
        """(N,) local z at which the road is expected."""
        return self.frame.track_height(road, s, self.heights)

    def runs(self, road, start, end):
        """List of Scanlines with start <= station < end, each of one pass and scanner."""
        first, last = np.searchsorted(self.lines[road].station, (start, end))
        return self.lines[road][first:last].runs()


def _drops(lines, track_d, track_z):
    """Metres from the track down to every line that passes under it."""
    if not len(lines):
        return np.empty(0)
    under = (lines.d[lines.first[:-1]] <= track_d) & (lines.d[lines.first[1:] - 1] >= track_d)
    number = np.arange(len(lines)) * LINE_SEPARATION
    z = np.interp(number + track_d, np.repeat(number, np.diff(lines.first)) + lines.d, lines.z)
    return (track_z - z)[under]
