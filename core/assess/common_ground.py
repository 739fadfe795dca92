"""Layers of any origin brought together: one CRS in metres, the right kind of geometry, a place in common."""

from dataclasses import dataclass, field

import numpy as np
import shapely

from ..errors import RoadExtractionError
from ..survey.crs import check_metric, horizontal, parse_crs, same_place

APART = 100.0  # m between the extents of two layers of one road


@dataclass
class AssessedLayer:
    """Geometries of a layer with its attributes; `label` is how messages call it, `crs` WKT or ""."""

    label: str
    geometries: list
    rows: list = field(default_factory=list)
    crs: str = ""

    def column(self, name):
        """Values of a field whatever the case of its name, None where the layer or the row has none."""
        found = next((key for row in self.rows[:1] for key in row if key.lower() == name.lower()), None)
        return [None if found is None else row.get(found) for row in self.rows]

    def only(self, mask):
        kept = np.flatnonzero(mask)
        return AssessedLayer(self.label, [self.geometries[k] for k in kept], [self.rows[k] for k in kept] if self.rows else [], self.crs)


def check_kind(layer, kinds, needed):
    """Refuse a layer that holds none of the wanted geometries, and one that holds others.

    Raises
    ------
    RoadExtractionError
        If the layer holds geometries of another kind.
    """
    names = {"Point": "points", "LineString": "lines", "Polygon": "polygons"}
    found = {g.geom_type.removeprefix("Multi") for g in layer.geometries}
    wrong = sorted(names.get(kind, kind) for kind in found - set(kinds))
    if wrong:
        raise RoadExtractionError(f"{layer.label} holds {', '.join(wrong)}; {needed} are needed. Choose another layer.")


def common_crs(layers):
    """WKT of the CRS to work in: of the first layer that has one in metres; "" where no layer tells any.

    Raises
    ------
    RoadExtractionError
        If no layer is in metres, by its CRS or, where it has none, by its coordinates.
    """
    refused = None
    for layer in layers:
        crs = parse_crs(layer.crs)
        if crs is None:
            continue
        try:
            check_metric(crs, layer.label)
            return layer.crs
        except RoadExtractionError as problem:
            refused = refused or problem
    if refused is not None:
        raise refused
    for layer in layers:
        if len(layer.geometries) and _looks_like_degrees(layer.geometries):
            raise RoadExtractionError(
                f"{layer.label} has no CRS and coordinates that look like degrees. Distances need metres: set the layer's CRS and "
                "reproject it to a projected one.")
    return ""


def in_crs(layer, wkt, warn=lambda text: None):
    """The layer in the CRS; one that tells none is taken to lie in it already, and that is said.

    Raises
    ------
    RoadExtractionError
        If it has no CRS but coordinates in degrees, or cannot be brought there.
    """
    source, target = parse_crs(layer.crs), parse_crs(wkt)
    if target is None or not len(layer.geometries):
        return layer
    if source is None:
        if _looks_like_degrees(layer.geometries):
            raise RoadExtractionError(
                f"{layer.label} has no CRS and coordinates that look like degrees, while the others are in {horizontal(target).name}. "
                "Set the layer's CRS and run again.")
        warn(f"{layer.label} has no CRS; its coordinates are taken to be in {horizontal(target).name}.")
        return AssessedLayer(layer.label, layer.geometries, layer.rows, wkt)
    if same_place(source, target):
        return AssessedLayer(layer.label, layer.geometries, layer.rows, wkt)
    from pyproj import Transformer

    move = Transformer.from_crs(horizontal(source), horizontal(target), always_xy=True)
    moved = shapely.transform(np.asarray(layer.geometries, object), lambda xy: np.column_stack(move.transform(*xy.T)))
    moved = [_with_heights_of(old, new) for old, new in zip(layer.geometries, moved)]
    if not np.isfinite(shapely.get_coordinates(moved)).all():
        raise RoadExtractionError(
            f"{layer.label} is in {horizontal(source).name} and cannot be brought to {horizontal(target).name}. Check its CRS.")
    return AssessedLayer(layer.label, moved, layer.rows, wkt)


def check_overlap(result, reference):
    """Refuse a result that lies nowhere near the reference.

    Raises
    ------
    RoadExtractionError
        If their extents are more than 100 m apart.
    """
    if not result.geometries or not reference.geometries:
        return
    a, b = (shapely.total_bounds(np.asarray(layer.geometries, object)) for layer in (result, reference))
    gap = np.maximum(np.maximum(a[:2] - b[2:], b[:2] - a[2:]), 0.0)
    if np.hypot(*gap) > APART:
        def place(box):
            return f"x {box[0]:.0f} to {box[2]:.0f}, y {box[1]:.0f} to {box[3]:.0f}"

        raise RoadExtractionError(
            f"{result.label} and {reference.label} lie {np.hypot(*gap):.0f} m apart ({place(a)} against {place(b)}), so nothing can be "
            "compared. Check that both show the same road and that their CRSs are right.")


def _with_heights_of(old, new):
    """`shapely.transform` of x and y drops the heights: put them back."""
    if not old.has_z:
        return new
    z = shapely.get_coordinates(old, include_z=True)[:, 2]
    return shapely.transform(shapely.force_3d(new), lambda xyz: np.column_stack([xyz[:, :2], z]), include_z=True)


def _looks_like_degrees(geometries):
    x0, y0, x1, y1 = shapely.total_bounds(np.asarray(geometries, object))
    return bool(max(abs(x0), abs(x1)) <= 180 and max(abs(y0), abs(y1)) <= 90 and max(x1 - x0, y1 - y0) < 1.0)
