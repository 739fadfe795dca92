"""What every inventory is made of: a survey, and the layers of its road map that say where carriageway and lanes end."""

from ...core.common.features import DRIVING_LINES, LANES, MARKING_LINES, ROAD_EDGES
from ..survey_input import check_layers_on_roads, open_survey_of
from ..texts import tr

# parameter -> its label, fields and geometry, in the order of BorderLayers
BORDER_LAYERS = {
    "ROAD_EDGES": (tr("Road edges"), ROAD_EDGES, "LineStringZ"),
    "MARKING_LINES": (tr("Marking lines"), MARKING_LINES, "LineStringZ"),
    "DRIVING_LINES": (tr("Driving lines"), DRIVING_LINES, "LineStringZ"),
    "LANES": (tr("Lanes"), LANES, "PolygonZ"),
}


def add_borders(algorithm, *helps):
    """Declare the layers of the road map, each with what it is good for."""
    for (name, (label, _, geometry)), text in zip(BORDER_LAYERS.items(), helps, strict=True):
        algorithm.add_input("layer", name, label, text, geometry, optional=True)


def survey_with_borders(call, progress, above_road):
    """The survey, with points up to `above_road` metres above the road, and the BorderLayers, which lie on its roads and in its CRS.

    A layer without features, as a step before may have found nothing, counts as not given.
    """
    from shapely import get_coordinates

    from ...core.io.crs import check_same_crs
    from ...products.inventory.borders import BorderLayers

    layers = {name: call.features(name, schema, geometry) for name, (_, schema, geometry) in BORDER_LAYERS.items()}
    for name, features in layers.items():
        if features is not None and not len(features):
            progress.warn(tr("{label} holds no features and is not used.").format(label=call.label(name)))
            layers[name] = None
    survey = open_survey_of(call, progress, above_road=above_road)
    for name, features in layers.items():
        if features is not None:
            check_same_crs(features.crs, survey.crs, get_coordinates(features.geometries[0])[0], call.label(name))
    check_layers_on_roads(call, layers, survey.frame, progress)
    return survey, BorderLayers(*layers.values())
