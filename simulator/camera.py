"""The camera of the simulated UAV image: places in the image, on the ground and along the road, with a known distortion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .streets.street import Scene

MAX_IMAGE_LENGTH = 150.0  # m of road in an image
IMAGE_MARGIN = 7.0   # m of ground beyond the edges of the carriageway
GROUND_PIXEL = 0.04  # m, size of a pixel on the ground
_END = 2.0           # m of ground before and after the road
_TILT = (0.022, -0.013)     # change of scale per half diagonal, along and across: a camera that is not quite vertical
_LENS = (0.0016, -0.0009)   # distortion with the second and fourth power of the distance from the middle


@dataclass(frozen=True)
class Camera:
    """A vertical image whose rows lie along the chord of the road."""

    middle: np.ndarray   # (2,) m, local coordinates of the middle of the image
    heading: float   # radians, direction of the rows, counter-clockwise from east
    width: int   # width, height: pixels
    height: int
    stations: tuple[float, float]   # (start, end) m, of the road in the image

    @property
    def half_diagonal(self) -> float:
        """Half the diagonal of the image, pixels."""
        return float(np.hypot(self.width, self.height)) / 2.0

    def to_map(self, pixel: np.ndarray, line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and y, m, local, on the ground of (N,) places in the image; 0, 0 is the outer corner of the first pixel.

        With u, v the place relative to the middle in half diagonals, and r its distance from the middle, the ground lies at
        (u, v)(1 + a u + b v + c r² + d r⁴): tilt and lens distortion.
        """
        u, v = (pixel - self.width / 2) / self.half_diagonal, (line - self.height / 2) / self.half_diagonal
        square = u * u + v * v
        far = (1.0 + _TILT[0] * u + _TILT[1] * v + _LENS[0] * square + _LENS[1] * square**2) * self.half_diagonal * GROUND_PIXEL
        along, across = u * far, -v * far
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        return self.middle[0] + along * cos - across * sin, self.middle[1] + along * sin + across * cos

    def to_pixel(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixel and line in the image of (N,) places x and y, m, local, to a millionth of a pixel."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        dx, dy = np.asarray(x) - self.middle[0], np.asarray(y) - self.middle[1]
        goal = (dx * cos + dy * sin) / GROUND_PIXEL + self.width / 2, -(dy * cos - dx * sin) / GROUND_PIXEL + self.height / 2
        pixel, line = goal
        for _ in range(20):
            # the distortion is a few percent, so this iteration converges fast
            at_x, at_y = self.to_map(pixel, line)
            dx, dy = np.asarray(x) - at_x, np.asarray(y) - at_y
            pixel, line = pixel + (dx * cos + dy * sin) / GROUND_PIXEL, line - (dy * cos - dx * sin) / GROUND_PIXEL
        return pixel, line

    def to_road(self, scene: Scene, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Station and offset, (N,) m, of (N,) places x and y, m, local, in the image."""
        stations = np.arange(max(scene.axis.start, -30.0), min(scene.axis.end, self.stations[1] + 30.0), 1.0)
        axis_x, axis_y = scene.axis.to_map(stations, np.zeros(len(stations)))
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        # the heading stays within a right angle of the chord, so the station increases along it
        s, d, *_ = scene.axis.locate(x, y, np.interp(x * cos + y * sin, axis_x * cos + axis_y * sin, stations), steps=4)
        return s, d


def camera_over(scene: Scene) -> Camera:
    """The Camera over the first 150 m of a road."""
    length = min(scene.length, MAX_IMAGE_LENGTH)
    s = np.linspace(0.0, length, 200)
    x, y = scene.axis.to_map(s, np.zeros(200))
    heading = float(np.arctan2(y[-1] - y[0], x[-1] - x[0]))
    cos, sin = np.cos(heading), np.sin(heading)
    rims = [scene.axis.to_map(s, np.full(200, d)) for d in (scene.left.edge + IMAGE_MARGIN, -scene.right.edge - IMAGE_MARGIN)]
    x, y = (np.concatenate([rim[k] for rim in rims]) for k in (0, 1))
    along, across = x * cos + y * sin, y * cos - x * sin
    low = np.array([along.min() - _END, across.min()])
    high = np.array([along.max() + _END, across.max()])
    a, b = (low + high) / 2
    width, height = (int(np.ceil(side / GROUND_PIXEL)) for side in high - low)
    return Camera(np.array([a * cos - b * sin, a * sin + b * cos]), heading, width, height, (0.0, length))
