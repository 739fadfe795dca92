"""Layers of any software as the assessments take them."""

import re

from qgis.core import (
    QgsExpression,
    QgsGeometry,
    QgsProcessingException,
    QgsProcessingParameterExpression,
    QgsProcessingParameterString,
    QgsRasterLayer,
    QgsWkbTypes,
)

from ...core.common.errors import RoadExtractionError
from ..call import existing_file
from ..layers import crs_text
from ..texts import tr

NOT_THERE = ("dropped", "none")  # values of the field `kind` of a reference that mean: no curb to be found here


def add_excluded(algorithm):
    algorithm.add(
        QgsProcessingParameterExpression("EXCLUDED", tr("Rows of the reference that are not judged"), "", "REFERENCE", optional=True),
        tr("An expression, such as \"type\" = 'driveway': where it holds, a result is neither right nor wrong. Empty leaves out the rows "
           "whose field kind says dropped or none."),
        advanced=True,
    )


def add_area(algorithm):
    algorithm.add_layer(
        "AREA", tr("Area"),
        tr("Polygons. What lies outside is left out of both layers; without it a result beyond the ends of the reference is false."),
        "PolygonZ", optional=True,
    )


def add_tolerances(algorithm, settings, label, text):
    """The list of tolerances as text: a model can hand it on, and any number of them will do."""
    algorithm.add(QgsProcessingParameterString("TOLERANCES", label, listed(settings.tolerances)), text)


def listed(numbers):
    return ", ".join(f"{number:g}" for number in numbers)


def tolerances(call, name="TOLERANCES"):
    """The numbers of a list such as 0.05, 0.10 or 0,05; 0,10."""
    text = call.algorithm.parameterAsString(call.parameters, name, call.context)
    if ";" in text or re.fullmatch(r"\s*\d+,\d+\s*", text) and text.strip().startswith("0,"):
        text = text.replace(",", ".")
    parts = [part for part in re.split(r"[;,\s]+", text) if part]
    try:
        return tuple(float(part) for part in parts)
    except ValueError:
        raise RoadExtractionError(
            tr("{label} is {text!r}; give numbers with commas between them, such as 0.05, 0.10, 0.20.").format(label=call.label(name), text=text)
        ) from None


def layer_of(call, name):
    """A vector input as AssessedLayer, whatever its fields, heights and parts; None where the optional parameter is empty."""
    source = call.source(name)
    return None if source is None else _read(source, call.label(name))


def layer_and_excluded(call, name):
    """(AssessedLayer, whether each row is excluded, why) of a reference."""
    source = call.source(name)
    text = call.algorithm.parameterAsString(call.parameters, "EXCLUDED", call.context)  # parameterAsExpression hides a faulty one
    if not text:
        layer = _read(source, call.label(name))
        kinds = [str(kind).lower() if kind is not None else "" for kind in layer.column("kind")]
        return layer, [kind in NOT_THERE for kind in kinds], kinds
    expression = QgsExpression(text)
    scope = call.algorithm.createExpressionContext(call.parameters, call.context, source)
    if expression.hasParserError() or not expression.prepare(scope):
        raise RoadExtractionError(
            tr("{label} cannot be used: {problem}").format(
                label=call.label("EXCLUDED"), problem=expression.parserErrorString() or expression.evalErrorString()))
    excluded = []

    def judge(feature):
        scope.setFeature(feature)
        excluded.append(bool(expression.evaluate(scope)))

    layer = _read(source, call.label(name), judge)
    if expression.hasEvalError():
        raise RoadExtractionError(tr("{label} cannot be used: {problem}").format(label=call.label("EXCLUDED"), problem=expression.evalErrorString()))
    kinds = layer.column("kind")
    return layer, excluded, [str(kind) if kind is not None else "" for kind in kinds]


def _read(source, label, each=lambda feature: None):
    import shapely

    from ...core.assess.inputs import AssessedLayer

    names = [field.name() for field in source.fields()]
    layer = AssessedLayer(label, [], [], crs_text(source.sourceCrs() if hasattr(source, "sourceCrs") else source.crs()))
    for feature in source.getFeatures():
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            continue
        each(feature)
        layer.geometries.append(shapely.from_wkb(_plain_wkb(geometry)))
        layer.rows.append({name: _plain(value) for name, value in zip(names, feature.attributes())})
    return layer


def _plain_wkb(geometry):
    """WKB without curves and measures, which the core does not know."""
    kind = geometry.wkbType()
    if QgsWkbTypes.isCurvedType(kind):
        geometry = QgsGeometry(geometry.constGet().segmentize())
    if QgsWkbTypes.hasM(kind):
        geometry.get().dropMValue()
    return bytes(geometry.asWkb())


def _plain(value):
    return None if value is None or (hasattr(value, "isNull") and value.isNull()) else value


def painted_of(call, name, progress):
    """(AssessedLayer of polygons and lines, whether it was a raster) of a vector or raster layer."""
    from ...core.assess.inputs import AssessedLayer, polygons_of_raster

    layer = call.algorithm.parameterAsLayer(call.parameters, name, call.context)
    if layer is None:
        raise QgsProcessingException(
            tr("{label}: {value} cannot be opened as a layer. Check the name and the folder.").format(
                label=call.label(name), value=call.parameters.get(name)))
    if isinstance(layer, QgsRasterLayer):
        polygons, values, _ = polygons_of_raster(existing_file(layer.source(), call.label(name)), progress)
        several = len(set(values.tolist())) > 1
        return AssessedLayer(call.label(name), polygons, [{"class": str(value)} if several else {} for value in values], crs_text(layer.crs())), True
    return _read(layer, call.label(name)), False


def frame_of_drive(call, crs):
    """The road frame of TRAJECTORY in the CRS; None where it was not given. Heights are not needed."""
    from ...core.io.crs import reproject_trajectory
    from ...core.survey.frame.road_frame import build_frame

    trajectory = call.trajectory(heights_needed=False)
    if trajectory is None:
        return None
    return build_frame(reproject_trajectory(trajectory, crs))


def area_of(call, crs, warn):
    """The union of AREA's polygons in the CRS; None where it was not given."""
    import shapely

    from ...core.assess.inputs import check_kind, in_crs

    layer = layer_of(call, "AREA")
    if layer is None:
        return None
    check_kind(layer, ("Polygon",), "polygons")
    if not layer.geometries:
        raise RoadExtractionError(tr("{label} has no polygons. Leave it empty to judge everywhere.").format(label=layer.label))
    return shapely.union_all(shapely.make_valid(shapely.force_2d(in_crs(layer, crs, warn).geometries)))


def layer_name(call, name):
    """What the user calls a layer."""
    layer = call.algorithm.parameterAsLayer(call.parameters, name, call.context)
    value = layer.name() if layer is not None else str(call.parameters.get(name))
    return value or call.label(name)


def found_numbers(numbers):
    """The numbers that there are: a share of nothing is left out."""
    return {name: float(value) for name, value in numbers.items() if value is not None and value == value}


def shares_of(numbers, names):
    """Shares as the log tells them: precision 99.5 %, recall 98.0 %."""
    told = [f"{name.split('_')[0].capitalize() if name.startswith('F1') else name.split('_')[0].lower()} {numbers[name]:.1f} %"
            for name in names if name in numbers]
    return ", ".join(told)
