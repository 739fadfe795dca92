"""Bicycles and the word BUS as polygons of paint, in stations and offsets.

They are drawn in centimetres, as stencils have them, and other than the drawings that markings are compared with.
"""

from __future__ import annotations

import numpy as np

# Letters with square corners, 50 cm wide and 100 cm high: outer ring, then holes
_LETTERS: dict[str, tuple[tuple[tuple[float, float], ...], ...]] = {
    "B": (((0, 0), (40, 0), (50, 8), (50, 42), (44, 50), (50, 58), (50, 92), (40, 100), (0, 100)),
          ((14, 12), (36, 12), (36, 43), (14, 43)), ((14, 57), (36, 57), (36, 88), (14, 88))),
    "U": (((0, 12), (10, 0), (40, 0), (50, 12), (50, 100), (36, 100), (36, 14), (14, 14), (14, 100), (0, 100)),),
    "S": (((0, 0), (42, 0), (50, 8), (50, 48), (42, 57), (14, 57), (14, 88), (50, 88), (50, 100), (8, 100), (0, 92), (0, 52), (8, 43), (36, 43),
           (36, 12), (0, 12)),),
}
_PITCH = 72.0    # cm from one letter to the next

# Strokes of a bicycle of 170 cm by 102 cm and their breadth
_WHEELS, _RADIUS, _BREADTH = ((31.0, 31.0), (139.0, 31.0)), 26.0, 9.0
_STROKES = (((31, 31), (60, 72), (116, 74), (78, 31), (31, 31)), ((56, 84), (78, 31)), ((139, 31), (117, 90), (136, 97)), ((42, 86), (68, 86)))


def bus_word(start: float, offset: float, direction: int, length: float = 2.4, width: float = 1.8) -> tuple[np.ndarray, ...]:
    """The word BUS as polygons that do not overlap, its letters standing at station `start`, read along the road (direction 1) or against it; m."""
    import shapely
    from shapely import affinity

    letters = [affinity.translate(shapely.Polygon(rings[0], rings[1:]), k * _PITCH) for k, rings in enumerate(_LETTERS.values())]
    return _painted(shapely.union_all(letters), start, offset, direction, length, width)


def bicycle(start: float, offset: float, direction: int, length: float = 1.4, width: float = 1.2) -> tuple[np.ndarray, ...]:
    """A bicycle seen from the side, drawn across the way it is read; parameters and result as of `bus_word`."""
    import shapely

    wheels = [shapely.Point(hub).buffer(_RADIUS).exterior.buffer(_BREADTH / 2) for hub in _WHEELS]
    frame = [shapely.LineString(stroke).buffer(_BREADTH / 2, cap_style="flat", join_style="mitre") for stroke in _STROKES]
    return _painted(shapely.union_all([*wheels, *frame]).simplify(0.5), start, offset, direction, length, width)


def _painted(drawing, start, offset, direction, length, width):
    """A drawing, to the right and up, laid on the road in pieces without holes."""
    import shapely
    from shapely import affinity, ops

    pieces = [drawing]
    for polygon in shapely.get_parts(drawing):
        for hole in polygon.interiors:
            x = hole.centroid.x
            cut = shapely.LineString([(x, -1.0), (x, drawing.bounds[3] + 1.0)])
            pieces = [part for piece in pieces for part in shapely.get_parts(ops.split(piece, cut) if piece.intersects(cut) else piece)]
    low, foot, high, top = drawing.bounds
    result = []
    for piece in pieces:
        for part in shapely.get_parts(affinity.affine_transform(piece, [width / (high - low), 0, 0, length / (top - foot), 0, 0])):
            across, up = shapely.get_coordinates(part.exterior)[:-1].T
            middle = (low + high) / 2 * width / (high - low)
            result.append(np.column_stack([start + direction * (up - foot * length / (top - foot)), offset - direction * (across - middle)]))
    return tuple(result)
