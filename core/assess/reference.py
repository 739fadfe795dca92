"""What a reference must have to be judged against."""

import numpy as np
import shapely

from ..errors import RoadExtractionError
from .places import places_along, single_lines
from .stationing import AlongTrajectory

TURNED = ("corner", "side_street", "island")  # values of the field `kind` of curbs that do not run along the road


def bottoms_only(layer, warn=lambda text: None):
    """(the layer without the tops of curbs where it has bottoms too, rows kept)."""
    parts = [str(part).lower() if part is not None else "" for part in layer.column("part")]
    if "bottom" not in parts or "top" not in parts:
        return layer, list(range(len(layer.geometries)))
    kept = [k for k, part in enumerate(parts) if part != "top"]
    warn(f"{layer.label} holds tops and bottoms of curbs; the bottoms are assessed.")
    mask = np.zeros(len(parts), bool)
    mask[kept] = True
    return layer.only(mask), kept


def along_the_road_only(layer, warn=lambda text: None):
    """(the layer without corners, side streets and islands, rows kept): intervals along a road do not tell of them."""
    turned = np.array([str(kind).lower() in TURNED for kind in layer.column("kind")], bool)
    if not turned.any() or turned.all():
        return layer, list(range(len(layer.geometries)))
    length = sum(layer.geometries[k].length for k in np.flatnonzero(turned))
    warn(f"{layer.label} holds {length:.0f} m of corners, side streets and islands; they are not judged.")
    return layer.only(~turned), list(np.flatnonzero(~turned))


def check_reference(reference, result, frame=None, area=None, corridor=30.0, warn=lambda text: None):
    """Refuse a reference with nothing to judge; say where the result has nothing.

    Raises
    ------
    RoadExtractionError
        If the reference has no line, none in the area, or none beside the trajectory.
    """
    lines, _ = single_lines(reference.geometries)
    if not lines:
        raise RoadExtractionError(
            f"{reference.label} has no lines to judge by. Choose the layer of reference lines, and see that not all of its rows are excluded.")
    places = places_along(lines, 1.0)
    inside = places.inside(area)
    if not len(inside):
        raise RoadExtractionError(f"{reference.label} has no lines inside the area. Check that the area covers the road, or leave it empty.")
    if frame is not None and (AlongTrajectory(frame, corridor).of_reference(inside).unit < 0).all():
        raise RoadExtractionError(
            f"The trajectory does not pass {reference.label}: none of it lies within {corridor:g} m. Check that both show the same road, and their "
            "CRSs, or leave the trajectory empty to measure along the reference.")
    if not single_lines(result.geometries)[0]:
        warn(f"{result.label} has no lines: everything is missed.")


def check_paint(reference, result, area=None, warn=lambda text: None):
    """The same for polygons.

    Raises
    ------
    RoadExtractionError
        If the reference has no area, or none inside the area given.
    """
    shapes = np.asarray(reference.geometries, object)
    if not len(shapes) or not (shapely.area(shapes) > 0).any():
        raise RoadExtractionError(
            f"{reference.label} has no polygons, lines or cells that are painted. Choose the layer of reference markings.")
    if area is not None and not shapely.intersects(area, shapes).any():
        raise RoadExtractionError(f"{reference.label} has nothing inside the area. Check that the area covers the road, or leave it empty.")
    if not len(result.geometries):
        warn(f"{result.label} shows no paint: everything is missed.")
