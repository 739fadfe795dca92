"""A window of the road as an array: along the road and across it, so that a bend is straight."""

import numpy as np

from ..survey.points import UNIT

CELL = 400        # units of 0.1 mm: cells of 4 cm


class RoadGrid:
    """A window of the road in cells of 4 cm: rows along the road, columns across it."""

    def __init__(self, first, last, low, high):
        self.first, self.last, self.low, self.high = first, last, low, high

    @property
    def shape(self):
        return self.last - self.first, self.high - self.low

    def stations(self):
        return (np.arange(self.first, self.last) + 0.5) * CELL * UNIT

    def offsets(self):
        return (np.arange(self.low, self.high) + 0.5) * CELL * UNIT

    def read(self, image, frame, road):
        """(rows, columns) float32 brightness, NaN where nothing was scanned."""
        x, y = frame.road(road).to_map(self.stations()[:, None], self.offsets())
        return np.asarray(image.sample(x.ravel(), y.ravel(), frame.origin), np.float32).reshape(self.shape)
