"""What a survey needs to know of a scene, be it a street along one axis or a plan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from .materials import Texture
    from .truth import Truth


@dataclass
class Hits:
    """The first intersection of each of N pulses."""

    distance: np.ndarray   # (N,) m, inf where a pulse meets nothing
    station: np.ndarray   # station, offset: (N,) m, as the scene locates places
    offset: np.ndarray
    cosine: np.ndarray   # (N,) of the incidence angle
    strip: np.ndarray   # (N,) integer, 0 for the carriageway, others for the strips beside it, OBSTACLE for obstacles
    label: np.ndarray   # (N,) uint8 of obstacles, 0 for the ground
    brightness: np.ndarray   # (N,) 0 to 1, of obstacles


class Followed(Protocol):
    """What a vehicle follows."""

    @property
    def length(self) -> float:
        """m, of the surveyed stretch."""

    def place(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and y (m, local) at stations and offsets."""

    def under(self, s: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Height of the ground (m), its slope along the stations and its slope to the left (m per m)."""


class SurveyedScene(Protocol):
    """A scene. It locates places by two coordinates of its own, called station and offset here: those of a street, x and y of a plan."""

    texture: Texture
    obstacles: list[Any]

    def passes_driven(self) -> list[tuple[Any, int, float, float]]:
        """(Followed, direction, offset in m, factor of the speed) of each pass."""

    def meet(self, origin: np.ndarray, direction: np.ndarray, station: float, reach: float) -> Hits:
        """Intersect pulses with the ground: (3, N) local origins, m, and unit directions, from a scanner near a station."""

    def labels(self, strip: np.ndarray, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) uint8 labels of places on the ground, whose strips are known."""

    def repaired(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) factors of the brightness of asphalt."""

    def located(self, x: np.ndarray, y: np.ndarray, station: float) -> tuple[np.ndarray, np.ndarray]:
        """Station and offset of places near a station, m."""

    def surveyed(self, s: np.ndarray, d: np.ndarray, reach: float) -> np.ndarray:
        """(N,) bool, places that belong to the survey."""

    def truth(self, origin: Sequence[float], crs: str) -> Truth:
        """The true layers, in map coordinates."""
