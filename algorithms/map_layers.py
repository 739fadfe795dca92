"""The layers of the road map: what each is called, its fields and its geometry, for every algorithm that takes or gives it."""

from typing import NamedTuple

from ..core.common import features
from .texts import tr


class MapLayer(NamedTuple):
    """A layer of the road map; the geometry is that of Features."""

    label: str
    schema: tuple
    geometry: str


MAP_LAYERS = {name: MapLayer(label, getattr(features, name), geometry) for name, label, geometry in (
    ("SCANLINES", tr("Normalized scanlines"), "LineStringZM"),
    ("CURB_POINTS", tr("Curb points"), "PointZ"),
    ("ROAD_EDGES", tr("Road edges"), "LineStringZ"),
    ("ROAD_SURFACE", tr("Road surface"), "PolygonZ"),
    ("MARKINGS", tr("Markings"), "PolygonZ"),
    ("MARKING_LINES", tr("Marking lines"), "LineStringZ"),
    ("DRIVING_LINES", tr("Driving lines"), "LineStringZ"),
    ("LANES", tr("Lanes"), "PolygonZ"),
    ("CURVE_ELEMENTS", tr("Curve elements"), "None"),
    ("PASSES", tr("Passes (the trajectory)"), "LineStringZ"),
    ("ROADSIDE", tr("Roadside"), "LineStringZ"),
    ("ROADSIDE_OBJECTS", tr("Poles, signs and trunks"), "PointZ"),
    ("CROSS_SECTIONS", tr("Cross-sections"), "LineStringZ"),
    ("SIGNALS", tr("Signals and poles"), "PointZ"),
)}
