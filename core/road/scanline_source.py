"""Where normalized scanlines come from: cut from a survey section by section."""

from dataclasses import replace

from ..progress import Progress
from ..survey.scan_lattice import find_lattice
from .section_planes import ScanlineSettings, scanlines_of


class SurveyScanlines:
    """The scanlines of a survey, made when they are asked for.

    interval, corridor : metres, those of `settings` where they are not given
    sensor_height : m from the trajectory down to the road, 0 = from the data
    lattice : ScanLattice; found here where it is not given
    """

    def __init__(self, survey, interval=None, corridor=None, sensor_height=0.0, settings=ScanlineSettings(), lattice=None,
                 progress=Progress()):
        given = {name: value for name, value in (("interval", interval), ("corridor", corridor)) if value is not None}
        self.settings = replace(settings, **given)
        self.survey, self.interval, self.corridor = survey, self.settings.interval, self.settings.corridor
        self.sensor_height = sensor_height
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

    def scanlines(self, road, start, end):
        """Scanlines with start <= station < end."""
        return scanlines_of(self.survey, road, start, end, self.settings, self.lattice)
