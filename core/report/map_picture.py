"""A small map as a picture: the intensity image below, lines and polygons above.

For reports only; a map to print is made by QGIS. Colours are blue, green, red, as
OpenCV wants them.
"""

import cv2
import numpy as np
import shapely

LONGEST = 1800  # pixels of the longer side

# What is drawn, from below: layer, rule (field, value or None), colour, width in pixels, filled
STYLE = (
    ("markings", None, (80, 220, 255), 1, True),
    ("edges", ("status", "measured"), (60, 60, 230), 3, False),
    ("edges", ("status", "bridged"), (60, 150, 255), 3, False),
    ("differences", None, (255, 60, 230), 7, False),
    ("marking_lines", None, (230, 200, 60), 2, False),
    ("driving_lines", ("status", "measured"), (90, 220, 60), 3, False),
    ("driving_lines", ("status", "bridged"), (60, 255, 190), 3, False),
    ("driving_lines", ("status", "inferred"), (220, 120, 200), 3, False),
)


def draw_map(layers, background=None, bounds=None, longest=LONGEST, style=STYLE, paper=28):
    """Draw layers over an image.

    Parameters
    ----------
    layers : dict of Features by the names in `style`; missing ones are left out
    background : (grey image (H, W) uint8 with 0 where empty, (min x, min y, max x, max y)) or None
    bounds : map area; by default that of the layers with a margin of 3 m
    style : what is drawn and how, as STYLE
    paper : grey of what no layer and no image covers

    Returns
    -------
    (H, W, 3) uint8, or None where there is nothing to draw
    """
    shapes = [g for features in layers.values() if features is not None for g in features.geometries if g is not None]
    if bounds is None:
        if not shapes:
            return None
        bounds = shapely.total_bounds(np.array(shapes, object)) + np.array([-3, -3, 3, 3])
    scale = longest / max(bounds[2] - bounds[0], bounds[3] - bounds[1])
    width, height = (max(int(np.ceil(side * scale)), 2) for side in (bounds[2] - bounds[0], bounds[3] - bounds[1]))
    canvas = np.full((height, width, 3), paper, np.uint8)
    if background is not None:
        _paste(canvas, *background, bounds, scale)
    for name, rule, colour, thickness, filled in style:
        for geometry, row in layers.get(name) or ():
            if geometry is not None and (rule is None or row.get(rule[0]) == rule[1]):
                _draw(canvas, geometry, bounds, scale, colour, thickness, filled)
    return canvas


def png(image):
    """The bytes of a PNG file."""
    return cv2.imencode(".png", image)[1].tobytes()


def _paste(canvas, grey, extent, bounds, scale):
    """Put an image where it belongs on the canvas."""
    height, width = canvas.shape[:2]
    column = (bounds[0] + (np.arange(width) + 0.5) / scale - extent[0]) / (extent[2] - extent[0]) * grey.shape[1]
    row = (extent[3] - bounds[3] + (np.arange(height) + 0.5) / scale) / (extent[3] - extent[1]) * grey.shape[0]
    inside_c, inside_r = (column >= 0) & (column < grey.shape[1]), (row >= 0) & (row < grey.shape[0])
    part = grey[np.ix_(row[inside_r].astype(int), column[inside_c].astype(int))]
    target = canvas[np.ix_(inside_r, inside_c)]
    canvas[np.ix_(inside_r, inside_c)] = np.where(part[..., None] > 0, part[..., None], target)


def _draw(canvas, geometry, bounds, scale, colour, thickness, filled):
    shift = 4  # bits of sub-pixel position
    for part in getattr(geometry, "geoms", [geometry]):
        rings = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
        drawn = []
        for ring in rings:
            xy = shapely.get_coordinates(ring)
            xy = np.c_[(xy[:, 0] - bounds[0]) * scale, (bounds[3] - xy[:, 1]) * scale]
            drawn.append(np.rint(xy * 2**shift).astype(np.int32))
        if filled:
            cv2.fillPoly(canvas, drawn, colour, cv2.LINE_AA, shift)
        else:
            cv2.polylines(canvas, drawn, part.geom_type == "Polygon", colour, thickness, cv2.LINE_AA, shift)
