"""What is searched: the part of the intensity image where a photo may lie."""

from __future__ import annotations

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.geotiff import IntensityImage
from ..rough_place import RoughPlace
from ..source_image import SourceImage
from .coarse import Bounds
from .photo import SurveyedPaint, read_paint

MOST_GROUND = 500.0     # m, longest side of an image: beyond, every turn of a fraction of a degree would have to be tried
MOST_SEARCHED = 1000.0  # m, longest side of an intensity image that is searched without any position


def paint_about(image: SourceImage, intensity: IntensityImage, rough: RoughPlace) -> tuple[SurveyedPaint, Bounds]:
    """The paint where an image may lie, and what is to be tried there.

    Parameters
    ----------
    image : SourceImage
    intensity : IntensityImage
    rough : RoughPlace in its CRS

    Returns
    -------
    SurveyedPaint, Bounds in its local coordinates, for the pixels of the image itself

    Raises
    ------
    RoadExtractionError
        If the image covers too much ground, the intensity image has nothing there, or too much would have to be searched.
    """
    ground = max(image.width, image.height) * rough.size
    if ground > MOST_GROUND:
        raise RoadExtractionError(
            f"{image.path} covers {ground:.0f} m by its pixel size of {rough.size:.3g} m; images of up to {MOST_GROUND:.0f} m are "
            "matched. Give the single photo or a part of the mosaic, or the right pixel size.")
    known = bool(np.isfinite(rough.reach))
    far = 0.5 * float(np.hypot(image.width, image.height)) * rough.size * (1.0 + rough.size_range) + (rough.reach if known else 0.0)
    sides = intensity.width * intensity.cell_size, intensity.height * intensity.cell_size
    if not known and max(sides) > MOST_SEARCHED:
        raise RoadExtractionError(
            f"The intensity image is {max(sides):.0f} m long; without any position an image is looked for within {MOST_SEARCHED:.0f} m. Give two "
            "points or a world file, or cut the intensity image.")
    paint = read_paint(intensity, (rough.x - far, rough.y - far, rough.x + far, rough.y + far) if known else None)
    if not paint.known.any():
        raise RoadExtractionError(_no_overlap(image, intensity, rough, sides))
    turns = (rough.turn - rough.turn_range, rough.turn + rough.turn_range)
    sizes = (rough.size / (1.0 + rough.size_range), rough.size * (1.0 + rough.size_range))
    x, y = (rough.x - paint.left, rough.y - paint.top) if known else (0.0, 0.0)
    return paint, Bounds(float(x), float(y), rough.reach, turns, sizes)


def _no_overlap(image, intensity, rough, sides):
    west, north = intensity.geotransform[0], intensity.geotransform[3]
    x = np.clip(rough.x, west, west + sides[0]) - rough.x
    y = np.clip(rough.y, north - sides[1], north) - rough.y
    away = float(np.hypot(x, y))
    where = f"{away / 1000:,.1f} km" if away >= 1000 else f"{away:.0f} m"
    return (f"{image.path} and the intensity image do not overlap: by {rough.source} the middle of the image lies at {rough.x:.0f}, {rough.y:.0f}, "
            f"{where} from the intensity image's border, and no road was surveyed there. Is it an image of another road, or its position in "
            "another CRS?")
