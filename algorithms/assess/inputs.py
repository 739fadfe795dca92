"""Layers of any software as the assessments take them."""

import re

from ...core.common.errors import RoadExtractionError
from ..parameters import settings_class
from ..texts import tr

NOT_THERE = ("dropped", "none")  # values of the field `edge` or `kind` of a reference that mean: no curb to be found here


def add_excluded(algorithm):
    algorithm.add_input("expression", "EXCLUDED", tr("Rows of the reference that are not judged"),
                        tr("An expression, such as \"type\" = 'driveway': where it holds, a result is neither right nor wrong. Empty leaves out the "
                           "rows whose field edge or kind says dropped or none."), optional=True, advanced=True, default="", of="REFERENCE")


def add_area(algorithm):
    algorithm.add_input("layer", "AREA", tr("Area"),
                        tr("Polygons. What lies outside is left out of both layers; without it a result beyond the ends of the reference is false."),
                        "PolygonZ", optional=True)


def add_tolerances(algorithm, settings, label, text):
    """The list of tolerances as text: a model can hand it on, and any number of them will do. `settings` names the class, as in SettingSpec."""
    owner = settings_class(settings)
    if owner is not None:
        algorithm.add_input("text", "TOLERANCES", label, text, default=", ".join(f"{number:g}" for number in owner().tolerances))


def tolerances(call, name="TOLERANCES"):
    """The numbers of a list such as 0.05, 0.10 or 0,05; 0,10."""
    text = call.value(name)
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
    return None if source is None else _read(source)[0]


def layer_and_excluded(call, name):
    """(AssessedLayer, whether each row is excluded, why) of a reference."""
    source = call.source(name)
    excluded = call.rows_where("EXCLUDED", source)
    layer, indices = _read(source)
    # `edge` says what an edge is, and `kind` where it runs; layers without `edge` say in `kind` what it is
    kinds = ["" if kind is None and edge is None else str(kind if edge is None else edge)
             for kind, edge in zip(layer.column("kind"), layer.column("edge"))]
    if excluded is None:
        kinds = [kind.lower() for kind in kinds]
        return layer, [kind in NOT_THERE for kind in kinds], kinds
    return layer, [excluded[k] for k in indices], kinds


def _read(source):
    """(AssessedLayer, place of each of its rows among those of the source)."""
    import shapely

    from ...products.assess.inputs import AssessedLayer

    layer, indices = AssessedLayer(source.label, [], [], source.crs), []
    for k, (wkb, values) in enumerate(source.rows()):
        if wkb is not None:
            layer.geometries.append(shapely.from_wkb(wkb))
            layer.rows.append(dict(zip(source.names, values)))
            indices.append(k)
    return layer, indices


def compared_lines(result, reference, progress):
    """(result, reference, their CRS) of two layers of lines, in one CRS and without stray vertices; refused where they do not overlap."""
    from ...products.assess.inputs import check_kind, check_overlap, common_crs, in_crs, without_stray_vertices

    for layer in (result, reference):
        check_kind(layer, ("LineString", "Polygon"), tr("lines"))
    crs = common_crs((reference, result))
    result, reference = (without_stray_vertices(in_crs(layer, crs, progress.warn), progress.warn) for layer in (result, reference))
    check_overlap(result, reference)
    return result, reference, crs


def painted_of(call, name, progress):
    """(AssessedLayer of polygons and lines, whether it was a raster) of a vector or raster layer."""
    import shapely

    from ...core.io.crs import in_metres
    from ...products.assess.inputs import AssessedLayer, polygons_of_raster

    source, path, crs = call.painted(name)
    if source is not None:
        return _read(source)[0], False
    polygons, values, _ = polygons_of_raster(path, progress)
    crs, units = in_metres(crs)
    if not units.metric:
        polygons = [shapely.transform(polygon, units.in_metres) for polygon in polygons]
    has_classes = len(set(values.tolist())) > 1
    return AssessedLayer(call.label(name), polygons, [{"class": str(value)} if has_classes else {} for value in values], crs), True


def frame_of_drive(call, crs):
    """The road frame of TRAJECTORY in the CRS; None where it was not given. Heights are not needed."""
    from ...core.survey.frame.road_frame import build_frame
    from ...core.survey.trajectory.trajectory import reproject_trajectory

    trajectory = call.trajectory(heights_needed=False)
    if trajectory is None:
        return None
    return build_frame(reproject_trajectory(trajectory, crs))


def area_of(call, crs, warn):
    """The union of AREA's polygons in the CRS; None where it was not given."""
    import shapely

    from ...products.assess.inputs import check_kind, in_crs

    layer = layer_of(call, "AREA")
    if layer is None:
        return None
    check_kind(layer, ("Polygon",), "polygons")
    if not layer.geometries:
        raise RoadExtractionError(tr("{label} has no polygons. Leave it empty to judge everywhere.").format(label=layer.label))
    return shapely.union_all(shapely.make_valid(shapely.force_2d(in_crs(layer, crs, warn).geometries)))


def found_numbers(numbers):
    """The numbers that there are: a share of nothing is left out."""
    return {name: float(value) for name, value in numbers.items() if value is not None and value == value}


def shares_of(numbers, names):
    """Shares as the log tells them: precision 99.5 %, recall 98.0 %."""
    shares = [f"{name.split('_')[0].capitalize() if name.startswith('F1') else name.split('_')[0].lower()} {numbers[name]:.1f} %"
              for name in names if name in numbers]
    return ", ".join(shares)
