"""Where the pixels of the made UAV image lie on the map: an image along the road, with lens-like distortion."""

from dataclasses import dataclass

import numpy as np

LONGEST = 150.0    # m of road that one image shows
BESIDE = 7.0       # m of ground shown beyond the edges of the carriageway
GROUND_PIXEL = 0.04  # m
_END = 2.0         # m of ground before and after the road
_TILT = (0.022, -0.013)   # share of the half diagonal: what a camera not quite upright does
_LENS = (0.0016, -0.0009)  # of the third and fifth power of the distance from the middle


@dataclass(frozen=True)
class Camera:
    """A picture of width by height pixels, its rows along the road's chord, its columns across.

    Attributes
    ----------
    middle : (2,) local map coordinates of the image's middle
    heading : radians, direction of the rows, counter-clockwise from east
    width, height : pixels
    stations : (start, end) of the road that is shown
    """

    middle: np.ndarray
    heading: float
    width: int
    height: int
    stations: tuple

    @property
    def half_diagonal(self):
        return np.hypot(self.width, self.height) / 2.0

    def to_map(self, pixel, line):
        """x, y (local) of places in the image; 0, 0 is the outer corner of the first pixel.

        With u, v the place relative to the middle in half diagonals, and r its distance, the ground lies
        at (u, v)(1 + a u + b v + c r² + d r⁴): tilt and lens.
        """
        u, v = (pixel - self.width / 2) / self.half_diagonal, (line - self.height / 2) / self.half_diagonal
        square = u * u + v * v
        far = (1.0 + _TILT[0] * u + _TILT[1] * v + _LENS[0] * square + _LENS[1] * square**2) * self.half_diagonal * GROUND_PIXEL
        along, across = u * far, -v * far
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        return self.middle[0] + along * cos - across * sin, self.middle[1] + along * sin + across * cos

    def to_pixel(self, x, y):
        """Pixel and line of places on the ground (local x, y), to a millionth of a pixel."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        dx, dy = np.asarray(x) - self.middle[0], np.asarray(y) - self.middle[1]
        goal = (dx * cos + dy * sin) / GROUND_PIXEL + self.width / 2, -(dy * cos - dx * sin) / GROUND_PIXEL + self.height / 2
        pixel, line = goal
        for _ in range(20):
            # The distortion is a few percent, so that correcting by what is left converges fast
            at_x, at_y = self.to_map(pixel, line)
            dx, dy = np.asarray(x) - at_x, np.asarray(y) - at_y
            pixel, line = pixel + (dx * cos + dy * sin) / GROUND_PIXEL, line - (dy * cos - dx * sin) / GROUND_PIXEL
        return pixel, line

    def to_road(self, scene, x, y):
        """Station and offset of local places in the image."""
        stations = np.arange(max(scene.axis.start, -30.0), min(scene.axis.end, self.stations[1] + 30.0), 1.0)
        axis_x, axis_y = scene.axis.to_map(stations, np.zeros(len(stations)))
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        # Heading turns less than a right angle from the chord, so that the way along it only grows
        s, d, *_ = scene.axis.locate(x, y, np.interp(x * cos + y * sin, axis_x * cos + axis_y * sin, stations), steps=4)
        return s, d


def camera_over(scene):
    """The Camera that shows the beginning of a road, 150 m of it at most."""
    length = min(scene.length, LONGEST)
    s = np.linspace(0.0, length, 200)
    x, y = scene.axis.to_map(s, np.zeros(200))
    heading = float(np.arctan2(y[-1] - y[0], x[-1] - x[0]))
    cos, sin = np.cos(heading), np.sin(heading)
    rims = [scene.axis.to_map(s, np.full(200, d)) for d in (scene.left.edge + BESIDE, -scene.right.edge - BESIDE)]
    x, y = (np.concatenate([rim[k] for rim in rims]) for k in (0, 1))
    along, across = x * cos + y * sin, y * cos - x * sin
    low = np.array([along.min() - _END, across.min()])
    high = np.array([along.max() + _END, across.max()])
    a, b = (low + high) / 2
    width, height = (int(np.ceil(side / GROUND_PIXEL)) for side in high - low)
    return Camera(np.array([a * cos - b * sin, a * sin + b * cos]), heading, width, height, (0.0, length))
