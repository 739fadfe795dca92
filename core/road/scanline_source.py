"""Where normalized scanlines come from: cut from a survey section by section."""

from .point_scanlines import point_scanlines

INTERVAL, CORRIDOR = 0.10, 15.0  # m between section planes; m either side


class SurveyScanlines:
    """The scanlines of a survey, made when they are asked for.

    interval, corridor : metres; sensor_height : m from the trajectory down to the road, 0 = from the data
    """

    def __init__(self, survey, interval=INTERVAL, corridor=CORRIDOR, sensor_height=0.0):
        self.survey, self.interval, self.corridor, self.sensor_height = survey, interval, corridor, sensor_height
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
        return point_scanlines(self.survey, road, start, end, self.interval, self.corridor)
