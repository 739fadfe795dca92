"""Figures that are painted on roads, drawn here as strokes: the bicycle and the word BUS.

They are much alike in all countries, so the catalogue has them once. Each is drawn upright, as the driver sees it, 1 high; on the road it is
stretched along the lane, by two to five times for drivers and little for cyclists. The standards leave the thickness of strokes and the
details to the drawing, so that agreement with a painted one is never complete.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Stroke = tuple[tuple[float, float], ...]   # places that it runs through, to the right and up


@dataclass(frozen=True)
class PaintedSymbol:
    """A figure, 1 high."""

    kind: str   # class of a marking that shows it
    strokes: tuple[Stroke, ...]   # lines through places, right and up
    stroke_width: float   # of all of them
    height: tuple[float, float]   # height, width: (least, greatest) m on the road, along the way it is read and across it
    width: tuple[float, float]
    stretch: tuple[float, float]   # (least, greatest) height over width on the road, times the same of the drawing


def _arc(x: float, y: float, radius: float, first: float, last: float, squeeze: float = 1.0) -> Stroke:
    """Part of a circle between two angles, degrees; its height is squeezed."""
    angles = np.radians(np.linspace(first, last, max(int(abs(last - first) / 15.0), 2) + 1))
    return tuple(zip((x + radius * np.cos(angles)).tolist(), (y + squeeze * radius * np.sin(angles)).tolist()))


# Wheels, frame, fork with handlebar, saddle
_BICYCLE = (
    _arc(0.34, 0.34, 0.30, 0.0, 360.0), _arc(1.30, 0.34, 0.30, 0.0, 360.0),
    ((0.34, 0.34), (0.76, 0.36), (1.12, 0.78), (0.62, 0.76), (0.34, 0.34)), ((0.76, 0.36), (0.59, 0.88)),
    ((1.30, 0.34), (1.10, 0.96), (1.28, 0.96)), ((0.46, 0.92), (0.72, 0.92)))

# On the bicycle, seen from the side: head, trunk with arms, leg
_RIDER = (
    _arc(0.21, 0.20, 0.17, 0.0, 360.0), _arc(0.73, 0.20, 0.17, 0.0, 360.0),
    ((0.21, 0.20), (0.44, 0.22), (0.66, 0.44), (0.37, 0.44), (0.21, 0.20)), ((0.73, 0.20), (0.64, 0.52)),
    ((0.34, 0.52), (0.52, 0.80), (0.60, 0.60), (0.70, 0.56)), ((0.36, 0.52), (0.54, 0.44), (0.47, 0.22)), _arc(0.60, 0.90, 0.05, 0.0, 360.0))

# Letters, 0.6 wide, 0.85 from one to the next
_BUS = (
    ((0.0, 0.0), (0.0, 1.0), (0.35, 1.0), *_arc(0.35, 0.76, 0.24, 90.0, -90.0), (0.0, 0.52)),
    ((0.35, 0.52), *_arc(0.34, 0.26, 0.26, 90.0, -90.0), (0.0, 0.0)),
    ((0.85, 1.0), *_arc(1.15, 0.3, 0.3, 180.0, 360.0), (1.45, 1.0)),
    (*_arc(2.0, 0.75, 0.28, 30.0, 270.0, 0.9), *_arc(2.0, 0.25, 0.28, 90.0, -150.0, 0.9)))

# The same with square corners, as stencils have them, and 1.05 from one to the next
_SQUARE_BUS = (
    ((0.0, 0.0), (0.6, 0.0), (0.6, 1.0), (0.0, 1.0), (0.0, 0.0)), ((0.0, 0.5), (0.6, 0.5)),
    ((1.05, 1.0), (1.05, 0.0), (1.65, 0.0), (1.65, 1.0)),
    ((2.7, 1.0), (2.1, 1.0), (2.1, 0.5), (2.7, 0.5), (2.7, 0.0), (2.1, 0.0)))

SYMBOLS: Sequence[PaintedSymbol] = (
    # the bicycle of the Vienna Convention on Road Signs and Signals (1968), as painted after RMS (Germany) and TSM chapter 5 (United Kingdom,
    # diagram 1057); bicycle with rider of the MUTCD (2009), figure 9C-3; word for a bus lane of RMS, TSM chapter 5 and MUTCD 3D
    PaintedSymbol("bicycle", _BICYCLE, 0.09, (0.6, 3.6), (0.6, 2.4), (0.7, 4.0)),
    PaintedSymbol("bicycle", _RIDER, 0.07, (0.9, 3.6), (0.6, 2.4), (0.7, 3.5)),
    PaintedSymbol("bus", _BUS, 0.16, (0.9, 4.5), (0.75, 2.7), (0.7, 7.0)),
    PaintedSymbol("bus", _SQUARE_BUS, 0.16, (0.9, 4.5), (0.75, 2.7), (0.7, 7.0)),
)
