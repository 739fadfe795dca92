"""Whether an intensity image shows the road points it is used with."""

from __future__ import annotations

import numpy as np

from ..common.errors import RoadExtractionError
from ..io.geotiff import IntensityImage
from ..survey.consistency import sample_road_points
from ..survey.store.road_points import RoadPoints

MIN_SHOWN_SHARE = 0.5  # of the sample_road_points points: must lie on a pixel with a value


def check_image_shows(image: IntensityImage, road_points: RoadPoints) -> None:
    """Refuse an image of another road, and the 8-bit picture for viewing.

    Parameters
    ----------
    image : IntensityImage
    road_points : RoadPoints

    Raises
    ------
    RoadExtractionError
        If fewer than half of the sample_road_points road points lie on pixels with a value, or the image is of 8 bits.
    """
    if image.eight_bit:
        raise RoadExtractionError(
            f"{image.path} is the 8-bit picture for viewing; its grey values are stretched and cut off. Give the intensity image itself.")
    places = [(x, y) for _, x, y, *_ in sample_road_points(road_points)]
    if not places:
        return
    x, y = (np.concatenate(part) for part in zip(*places))
    left, size, _, top, _, _ = image.geotransform
    seen = np.isfinite(image.sample(x, y))
    if seen.mean() < MIN_SHOWN_SHARE:
        raise RoadExtractionError(
            f"{image.path} does not show these road points: it covers x {left:.1f} to {left + size * image.width:.1f}, "
            f"y {top - size * image.height:.1f} to {top:.1f}, the points lie over x {x.min():.1f} to {x.max():.1f}, "
            f"y {y.min():.1f} to {y.max():.1f}, and {100 * seen.mean():.0f} % of them are on it. Give the intensity image that "
            "was made from these points.")
