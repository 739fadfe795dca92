"""Where normalized scanlines come from: cut from a survey section by section."""

from .point_scanlines import point_scanlines

INTERVAL, CORRIDOR = 0.10, 15.0  # m between section planes; m either side


class SurveyScanlines:
    """The scanlines of a survey, made when they are asked for."""

    def __init__(self, survey, interval=INTERVAL, corridor=CORRIDOR):
        self.survey, self.interval, self.corridor = survey, interval, corridor
        self.frame, self.crs = survey.frame, survey.crs

    def roads(self):
        return self.survey.store.roads()

    def span(self, road):
        return self.survey.store.span(road)

    def road_height(self, road, s):
        return self.survey.road_height(road, s)

    def scanlines(self, road, start, end):
        """Scanlines with start <= station < end."""
        return point_scanlines(self.survey, road, start, end, self.interval, self.corridor)
