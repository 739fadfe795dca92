"""The report on a georeferenced image: errors, residuals point by point, and a picture of the residuals."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..common.texts import told, tr, word
from ..io.crs import NO_PLACE, horizontal_part, parse_crs, place_of_raster
from ..io.local_files import gdal_exceptions, open_raster
from ..lazy import cv2
from ..overlay.control_points import CHECK, CONTROL, DISABLED
from ..overlay.warp import drawn_area, output_grid
from .map_figure import png
from .page import Page, number

if TYPE_CHECKING:
    from ..overlay.georeference import Georeferencing

RESIDUAL_PICTURE_SIDE = 1300  # px, longer side of the picture
MAX_ARROW_LENGTH = 0.06       # of the longest arrow, as a share of that side
ROLE_COLOURS = {CONTROL: (60, 60, 230), CHECK: (230, 190, 40), DISABLED: (150, 150, 150)}  # blue, green, red
ROLE_CSS = {role: f"#{red:02x}{green:02x}{blue:02x}" for role, (blue, green, red) in ROLE_COLOURS.items()}


def georeferencing_report(found: Georeferencing, drawn: str, departure: float) -> str:
    """The report of a Georeferencing as HTML.

    Parameters
    ----------
    found : Georeferencing
    drawn : path of the GeoTIFF that was drawn
    departure : pixels between the drawn image and the polynomial, from `draw_image`
    """
    page = Page(tr("Georeferenced image"), tr("How well the image lies on its control points."))
    for note in found.notes:
        page.warning(told(note))
    image, crs = found.image, found.points.crs
    _, width, height = output_grid(found)
    page.heading(tr("Image"))
    outside = tr("{share:.0f} % of the image, left out") if found.cut else tr("{share:.0f} % of the image")
    page.facts((
        (tr("Image"), image.path), (tr("Pixels and lines"), f"{image.width} × {image.height}"), (tr("Placed by"), _polynomial(found.settings.order)),
        (tr("CRS"), horizontal_part(parse_crs(crs)).name if crs else tr("no CRS")),
        (tr("Result"), tr("{width} × {height} pixels of {size:g} m").format(width=width, height=height, size=found.pixel_size)),
        (tr("Drawn within"), tr("{departure:.2f} pixels of the polynomial, everywhere").format(departure=departure)),
        (tr("Outside the hull of the control points"), outside.format(share=100 * found.outside))))
    _errors(page, found)
    picture, magnification = residual_picture(found, drawn)
    page.heading(tr("Residuals"))
    page.picture(png(picture), tr("From where the polynomial puts each point to where it was measured, {times} times as long as on "
                                  "the ground. North is up; the thin line is the hull of the control points.").format(
                                      times=number(round(magnification)) if magnification >= 1 else f"{magnification:g}"))
    page.colour_key([(ROLE_CSS[role], word(role)) for role in (CONTROL, CHECK, DISABLED) if len(found.points.having(role))])
    _points(page, found)
    return page.html()


def _polynomial(order):
    return {0: tr("shift (order 0)"), 1: tr("polynomial of order 1 (affine)"), 2: tr("polynomial of order 2"), 3: tr("polynomial of order 3")}[order]


def _errors(page, found):
    fit, pixel = found.fit, found.pixel_size
    rows = [(tr("Control points"), len(found.points.having(CONTROL)), found.rmse()),
            (tr("Control points, each left out in turn"), len(found.points.having(CONTROL)), found.left_out_rmse),
            (tr("Check points"), len(found.points.having(CHECK)), found.rmse(CHECK))]
    page.heading(tr("Errors"))
    page.table(("", tr("Points"), "RMSE (m)", tr("RMSE (pixels)"), tr("Largest (m)")),
               [(title, count, error, error / pixel, _largest(vectors)) for (title, count, error), vectors in zip(
                   rows, (found.errors[found.points.having(CONTROL)], found.left_out[found.points.having(CONTROL)],
                          found.errors[found.points.having(CHECK)]))])
    page.note(tr("RMSE = √(Σ(dx² + dy²) / n). The residuals of control points are too small, since the polynomial was fitted to them; "
                 "there are {free} more than it needs. Points measured in the laser point cloud itself show how well the image fits "
                 "the cloud, not how well either fits the ground.").format(free=fit.free))


def _largest(vectors):
    known = vectors[np.isfinite(vectors).all(axis=1)]
    return float(np.hypot(*known.T).max()) if len(known) else float("nan")


def _points(page, found):
    page.heading(tr("Points"))
    points = found.points
    page.table(
        (tr("Point"), tr("Role"), tr("Pixel"), tr("Line, downwards"), tr("East (m)"), tr("North (m)"), tr("Residual (m)"),
         tr("Without this point (m)")),
        [(points.names[k], word(points.roles[k]), round(float(points.pixel[k]), 2), round(float(points.line[k]), 2),
          *(float(error) for error in found.errors[k]), float(np.hypot(*found.errors[k])), float(np.hypot(*found.left_out[k])))
         for k in range(len(points))])


def residual_picture(found: Georeferencing, drawn: str) -> tuple[np.ndarray, float]:
    """The drawn image with the residuals as arrows.

    Parameters
    ----------
    found : Georeferencing
    drawn : path of the GeoTIFF that was drawn

    Returns
    -------
    picture : (H, W, 3) uint8, blue, green, red
    magnification : of the residuals, relative to the ground
    """
    canvas, scale, corner = _reduced_copy(drawn)
    points = found.points

    def at(x, y):
        return np.column_stack([(np.asarray(x) - corner[0]) * scale, (corner[1] - np.asarray(y)) * scale])

    if found.hull is not None:
        hull = np.array(drawn_area(found).exterior.coords) if found.cut else np.array(found.hull.exterior.segmentize(50.0).coords)
        outline = at(*found.fit.polynomial.to_map(hull[:, 0], hull[:, 1]))
        cv2.polylines(canvas, [np.rint(outline * 16).astype(np.int32)], True, (255, 255, 255), 1, cv2.LINE_AA, 4)
    judged = points.roles != DISABLED
    longest = np.hypot(*found.errors[judged].T).max() if judged.any() else 0.0
    magnification = _round_down(MAX_ARROW_LENGTH * max(canvas.shape[:2]) / (longest * scale)) if longest * scale > 1e-6 else 1.0
    # An arrow starts where the polynomial puts the point and is lengthened from there
    starts = at(points.easting - found.errors[:, 0], points.northing - found.errors[:, 1])
    tips = starts + found.errors * np.array([1.0, -1.0]) * scale * magnification
    for place, tip, role in sorted(zip(starts, tips, points.roles), key=lambda one: one[2] != DISABLED):
        colour = ROLE_COLOURS[str(role)]
        if role == DISABLED:
            cv2.drawMarker(canvas, _whole(place), colour, cv2.MARKER_TILTED_CROSS, 10, 2, cv2.LINE_AA)
            continue
        for tint, width in (((20, 20, 20), 5), (colour, 2)):
            cv2.arrowedLine(canvas, _whole(place), _whole(tip), tint, width, cv2.LINE_AA, tipLength=0.25)
        cv2.circle(canvas, _whole(place), 4, colour, -1, cv2.LINE_AA)
    return canvas, magnification


def _whole(place):
    return tuple(int(v) for v in np.clip(np.rint(place), -10_000, 10_000))


def _round_down(value):
    """1, 2 or 5 times a power of ten."""
    ten = 10.0 ** np.floor(np.log10(value))
    return float(max(step * ten for step in (1, 2, 5) if step * ten <= value * (1 + 1e-9)))


@gdal_exceptions()
def _reduced_copy(path):
    """((H, W, 3) small copy of the drawn image, pixels per metre, map coordinates of its north-west corner)."""
    from osgeo import gdal

    dataset = open_raster(path)
    share = min(1.0, RESIDUAL_PICTURE_SIDE / max(dataset.RasterXSize, dataset.RasterYSize))
    width, height = (max(int(n * share), 1) for n in (dataset.RasterXSize, dataset.RasterYSize))
    colours = (3, 2, 1) if dataset.RasterCount >= 3 else (1, 1, 1)
    bands = []
    for channel in colours:
        band = dataset.GetRasterBand(channel)
        data = band.ReadRaster(0, 0, dataset.RasterXSize, dataset.RasterYSize, width, height, gdal.GDT_Float32,
                               resample_alg=gdal.GRIORA_Average)
        bands.append(np.frombuffer(data, np.float32).reshape(height, width))
    mask = dataset.GetRasterBand(1).GetMaskBand().ReadRaster(0, 0, dataset.RasterXSize, dataset.RasterYSize, width, height, gdal.GDT_Byte)
    drawn = (np.frombuffer(mask, np.uint8).reshape(height, width) > 127) & np.isfinite(bands[0])
    values = np.stack(bands, axis=2)
    if dataset.GetRasterBand(1).DataType != gdal.GDT_Byte and drawn.any():
        low, high = np.percentile(values[drawn], [1, 99])
        values = 255.0 * (values - low) / max(float(high - low), 1e-9)
    canvas = np.full((height, width, 3), 28, np.uint8)
    canvas[drawn] = np.clip(np.rint(values[drawn]), 0, 255).astype(np.uint8)
    x0, size, _, y0, _, _ = place_of_raster(dataset)[0] or NO_PLACE
    return canvas, width / (dataset.RasterXSize * size), (x0, y0)
