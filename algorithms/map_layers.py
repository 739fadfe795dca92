"""The layers of the road map: what each is called, its fields and its geometry, for every algorithm that takes or gives it."""

from typing import NamedTuple

from ..core.common import features
from .texts import help_texts


class MapLayer(NamedTuple):
    """A layer of the road map; the geometry is that of Features."""

    label: str
    schema: tuple
    geometry: str


MAP_LAYERS = {name: MapLayer(help_texts()[name][0], getattr(features, name), geometry) for name, geometry in dict(
    SCANLINES="LineStringZM", CURB_POINTS="PointZ", ROAD_EDGES="LineStringZ", ROAD_SURFACE="PolygonZ", MARKINGS="PolygonZ",
    MARKING_LINES="LineStringZ", DRIVING_LINES="LineStringZ", LANES="PolygonZ", CURVE_ELEMENTS="None", PASSES="LineStringZ",
    ROADSIDE="LineStringZ", ROADSIDE_OBJECTS="PointZ", CROSS_SECTIONS="LineStringZ", SIGNALS="PointZ").items()}
