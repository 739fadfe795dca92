"""Where each place of the map lies in the photo, by a polynomial, and the photo drawn onto the map by it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...lazy import cv2
from ..polynomial import ImagePolynomial, fit_image_polynomial
from .photo import reduced

if TYPE_CHECKING:
    from .photo import Photo

_NODE = 16  # cells between places whose pixels are computed; between them they are interpolated


@dataclass(frozen=True)
class Placement:
    """From local map coordinates to pixel and line.

    Attributes
    ----------
    polynomial : ImagePolynomial whose input is x and y, m, and whose output is pixel and line
    sign : -1 where paint is darker than the road
    """

    polynomial: ImagePolynomial
    sign: int = 1

    @classmethod
    def fitted(cls, x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray, order: int, sign: int = 1) -> Placement:
        """The least-squares placement of (N,) places; N at least MIN_CONTROL_POINTS[order], not on a line."""
        return cls(fit_image_polynomial(x, y, pixel, line, order).polynomial, sign)

    @classmethod
    def similarity(cls, x: float, y: float, turn: float, size: float, middle: tuple[float, float], sign: int = 1) -> Placement:
        """From a place (m) that lies at a `middle` (pixel and line), the turn (radians) and the size (m) of the pixels."""
        along, up = np.array([-1.0, 1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0, 1.0])
        across, down = middle[0] + along / size, middle[1] - up / size
        cos, sin = np.cos(turn), np.sin(turn)
        return cls.fitted(x + along * cos - up * sin, y + along * sin + up * cos, across, down, 1, sign)

    def pixels(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixel and line, (N,) each, of (N,) places."""
        return self.polynomial.to_map(x, y)

    def metres(self, x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray) -> np.ndarray:
        """How far on the map pixels lie from those of places.

        Parameters
        ----------
        x, y, pixel, line : (N,)

        Returns
        -------
        (N, 2) m, to first order
        """
        at = np.column_stack(self.pixels(x, y))
        slope = self.polynomial.jacobian(x, y)
        return np.linalg.solve(slope, (np.column_stack([pixel, line]) - at)[..., None])[..., 0]

    def drawn(self, values: np.ndarray, photo: Photo, cell: float, shape: tuple[int, ...], corner: tuple[int, int] = (0, 0),
              reduction: int = 1) -> np.ndarray:
        """The photo on cells of the map.

        Parameters
        ----------
        values : (h, w) float32, contrast or luminance of the photo
        photo : Photo that they belong to
        cell : m
        shape : rows and columns of cells
        corner : first column and row, counted from local 0, 0 to the east and to the south
        reduction : pixels of the photo that are averaged first, where cells are larger than they

        Returns
        -------
        (H, W) float32, 0 outside the photo
        """
        height, width = shape
        across = np.linspace(0, width, max(2, -(-width // _NODE) + 1))
        down = np.linspace(0, height, max(2, -(-height // _NODE) + 1))
        x, y = np.meshgrid((corner[0] + across) * cell, -(corner[1] + down) * cell)
        pixel, line = (axis.reshape(x.shape) for axis in self.pixels(x.ravel(), y.ravel()))
        factor = photo.factor * reduction
        nodes = [(at / factor - 0.5).astype(np.float32) for at in (pixel, line)]
        # of the middles of the cells: linear between the nodes
        wanted = np.meshgrid((np.arange(width) + 0.5) * (len(across) - 1) / width, (np.arange(height) + 0.5) * (len(down) - 1) / height)
        maps = [cv2.remap(node, *(axis.astype(np.float32) for axis in wanted), cv2.INTER_LINEAR) for node in nodes]
        return cv2.remap(reduced(values, reduction), *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0.0)

    def reduction(self, photo: Photo, cell: float) -> int:
        """Pixels of a photo that a cell (m) covers side by side, at least 1."""
        centre = self.polynomial.centre
        per_metre = np.sqrt(abs(np.linalg.det(self.polynomial.jacobian(centre[:1], centre[1:])[0])))
        return max(1, int(cell * per_metre / photo.factor + 0.25))
