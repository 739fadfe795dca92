"""Reports on images laid on the map: a georeferenced image with its residuals, and proposed control points with their cut-outs."""

from __future__ import annotations

import numpy as np

from ...core.common.texts import word
from ...core.io.crs import NO_PLACE, horizontal_part, parse_crs, place_of_raster
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.lazy import cv2, gdal
from ..overlay.control_points import CHECK, CONTROL, DISABLED
from ..overlay.georeference import Georeferencing, drawn_area, output_grid
from ..overlay.matching.propose import Proposal
from ..overlay.rough_place import pair_cutouts
from .page import html_page, round_down

RESIDUAL_PICTURE_SIDE = 1300  # px, longer side of the picture
MAX_ARROW_LENGTH = 0.06       # of the longest arrow, as a share of that side
ROLE_COLOURS = {CONTROL: (60, 60, 230), CHECK: (230, 190, 40), DISABLED: (150, 150, 150)}  # blue, green, red
ROLE_CSS = {role: f"#{red:02x}{green:02x}{blue:02x}" for role, (blue, green, red) in ROLE_COLOURS.items()}
CUT_SIDE = 110       # px, of a cut-out
PAIRS_PER_ROW = 5    # pairs side by side
_GAP, _TEXT = 8, 20
_ACCEPTED, _REFUSED = (80, 150, 40), (50, 50, 210)  # blue, green, red


def georeferencing_report(result: Georeferencing, drawn: str, departure: float) -> str:
    """The report of a Georeferencing as HTML.

    `drawn`: path of the GeoTIFF that was drawn. `departure`: pixels between it and the polynomial, from `draw_image`.
    """
    points, crs = result.points, result.points.crs
    control, check = points.having(CONTROL), points.having(CHECK)
    picture, magnification = _residual_picture(result, drawn)
    return html_page(
        "georeferencing", result=result, notes=result.notes, grid=output_grid(result)[1:], crs=horizontal_part(parse_crs(crs)).name if crs else "",
        departure=departure, residuals=picture, magnification=magnification,
        sizes=(np.hypot(*result.errors.T), np.hypot(*result.left_out.T)),
        errors=[(len(control), result.rmse(), _largest(result.errors[control])),
                (len(control), result.left_out_rmse, _largest(result.left_out[control])),
                (len(check), result.rmse(CHECK), _largest(result.errors[check]))],
        colours=[(ROLE_CSS[role], word(role)) for role in (CONTROL, CHECK, DISABLED) if len(points.having(role))])


def _largest(vectors):
    finite = vectors[np.isfinite(vectors).all(axis=1)]
    return float(np.hypot(*finite.T).max()) if len(finite) else float("nan")


def _residual_picture(result: Georeferencing, drawn: str) -> tuple[np.ndarray, float]:
    """((H, W, 3) uint8, blue, green, red; magnification) of the drawn image, a GeoTIFF, with the residuals as arrows."""
    canvas, scale, corner = _reduced_copy(drawn)
    points = result.points

    def at(x, y):
        return np.column_stack([(np.asarray(x) - corner[0]) * scale, (corner[1] - np.asarray(y)) * scale])

    if result.hull is not None:
        hull = np.array(drawn_area(result).exterior.coords) if result.cut else np.array(result.hull.exterior.segmentize(50.0).coords)
        outline = at(*result.fit.polynomial.to_map(hull[:, 0], hull[:, 1]))
        cv2.polylines(canvas, [np.rint(outline * 16).astype(np.int32)], True, (255, 255, 255), 1, cv2.LINE_AA, 4)
    judged = points.roles != DISABLED
    longest = np.hypot(*result.errors[judged].T).max() if judged.any() else 0.0
    magnification = round_down(MAX_ARROW_LENGTH * max(canvas.shape[:2]) / (longest * scale)) if longest * scale > 1e-6 else 1.0
    # An arrow starts where the polynomial puts the point and is lengthened from there
    starts = at(points.easting - result.errors[:, 0], points.northing - result.errors[:, 1])
    tips = starts + result.errors * np.array([1.0, -1.0]) * scale * magnification
    for start, tip, role in sorted(zip(starts, tips, points.roles), key=lambda one: one[2] != DISABLED):
        colour = ROLE_COLOURS[str(role)]
        if role == DISABLED:
            cv2.drawMarker(canvas, _whole(start), colour, cv2.MARKER_TILTED_CROSS, 10, 2, cv2.LINE_AA)
            continue
        for tint, width in (((20, 20, 20), 5), (colour, 2)):
            cv2.arrowedLine(canvas, _whole(start), _whole(tip), tint, width, cv2.LINE_AA, tipLength=0.25)
        cv2.circle(canvas, _whole(start), 4, colour, -1, cv2.LINE_AA)
    return canvas, magnification


def _whole(place):
    return tuple(int(v) for v in np.clip(np.rint(place), -10_000, 10_000))


@gdal_exceptions()
def _reduced_copy(path):
    """((H, W, 3) small copy of the drawn image, pixels per metre, map coordinates of its north-west corner)."""
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


def proposed_points_report(proposal: Proposal) -> str:
    return html_page("proposed_points", proposal=proposal, notes=proposal.notes, cut_outs=_pairs_picture(proposal),
                  rival=None if proposal.rival is None else np.hypot(proposal.rival.dx, proposal.rival.dy))


def _pairs_picture(proposal: Proposal) -> np.ndarray:
    """(H, W, 3) uint8, blue, green, red: all pairs of cut-outs in rows."""
    width, height = 2 * CUT_SIDE + 3 * _GAP, CUT_SIDE + _TEXT + 2 * _GAP
    rows = -(-len(proposal) // PAIRS_PER_ROW)
    canvas = np.full((rows * height, PAIRS_PER_ROW * width, 3), 255, np.uint8)
    cuts = pair_cutouts(proposal.image, proposal.intensity, proposal.pixel, proposal.line, proposal.easting, proposal.northing, side=CUT_SIDE)
    for k, pair in enumerate(cuts):
        left, top = (k % PAIRS_PER_ROW) * width + _GAP, (k // PAIRS_PER_ROW) * height + _GAP
        tint = _ACCEPTED if proposal.accepted[k] else _REFUSED
        for number, cut in enumerate(pair):
            x = left + number * (CUT_SIDE + _GAP // 2)
            canvas[top:top + CUT_SIDE, x:x + CUT_SIDE] = cut[..., ::-1]
            middle = (x + CUT_SIDE // 2, top + CUT_SIDE // 2)
            cv2.drawMarker(canvas, middle, (0, 220, 255), cv2.MARKER_CROSS, 16, 1, cv2.LINE_AA)
        cv2.rectangle(canvas, (left - 2, top - 2), (left + 2 * CUT_SIDE + _GAP // 2 + 1, top + CUT_SIDE + 1), tint, 2)
        text = f"{k + 1}   {proposal.score[k]:.2f}   {100 * proposal.residual[k]:.1f} cm"
        cv2.putText(canvas, text, (left, top + CUT_SIDE + _TEXT - 4), cv2.FONT_HERSHEY_SIMPLEX, 0.42, tint, 1, cv2.LINE_AA)
    return canvas
