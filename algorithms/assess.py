"""How good a result is: boundaries, markings and driving lines against a reference, from layers of any software."""

import re
from contextlib import nullcontext
from dataclasses import replace

from ..core.common.errors import RoadExtractionError
from ..core.common.features import ASSESSED_BOUNDARIES, ASSESSED_DRIVING_LINES, ASSESSED_MARKINGS
from ..core.lazy import shapely
from .algorithm import Algorithm, settings_class, settings_of
from .rooms import core, products
from .texts import tr

NOT_THERE = ("dropped", "none")  # values of the field `edge` or `kind` of a reference that mean: no curb to be found here


def add_tolerances(algorithm, specs):
    """The list of tolerances as text: a model can hand it on, and any number of them will do. `specs` are settings of its class."""
    owner = settings_class(specs[0].settings)
    if owner is not None:
        algorithm.add_input("text", "TOLERANCES", default=", ".join(f"{number:g}" for number in owner().tolerances))


def tolerances(call, name="TOLERANCES"):
    """The numbers of a list such as 0.05, 0.10 or 0,05; 0,10."""
    text = call.value(name)
    if ";" in text or re.fullmatch(r"\s*\d+,\d+\s*", text) and text.strip().startswith("0,"):
        text = text.replace(",", ".")
    parts = [part for part in re.split(r"[;,\s]+", text) if part]
    try:
        return tuple(float(part) for part in parts)
    except ValueError:
        raise RoadExtractionError(tr("{label} is {text!r}; give numbers with commas between them, such as 0.05, 0.10, 0.20.", label=call.label(name),
                                     text=text)) from None


def layer_of(call, name):
    """A vector input as AssessedLayer, whatever its fields, heights and parts; None where the optional parameter is empty."""
    source = call.source(name)
    return None if source is None else _read(source)[0]


def reference_of(call, name):
    """A reference as AssessedLayer, with why rows are excluded."""
    source = call.source(name)
    excluded = call.rows_where("EXCLUDED", source)
    layer, indices = _read(source)
    # `edge` says what an edge is, and `kind` where it runs; layers without `edge` say in `kind` what it is
    kinds = ["" if kind is None and edge is None else str(kind if edge is None else edge)
             for kind, edge in zip(layer.column("kind"), layer.column("edge"))]
    if excluded is None:
        layer.excluded = [kind.lower() if kind.lower() in NOT_THERE else None for kind in kinds]
    else:
        layer.excluded = [kind if excluded[k] else None for kind, k in zip(kinds, indices)]
    return layer


def _read(source):
    """(AssessedLayer, place of each of its rows among those of the source)."""
    layer, indices = products.assess.layers.AssessedLayer(source.label, [], [], source.crs), []
    for k, (wkb, values) in enumerate(source.rows()):
        if wkb is not None:
            layer.geometries.append(shapely.from_wkb(wkb))
            layer.rows.append(dict(zip(source.names, values)))
            indices.append(k)
    return layer, indices


def compared_lines(result, reference, progress):
    """(result, reference, their CRS) of two layers of lines, in one CRS and without stray vertices; refused where they do not overlap."""
    layers = products.assess.layers
    for layer in (result, reference):
        layers.check_kind(layer, ("LineString", "Polygon"), tr("lines"))
    crs = layers.common_crs((reference, result))
    result, reference = (layers.without_stray_vertices(layers.in_crs(layer, crs, progress.warn), progress.warn) for layer in (result, reference))
    layers.check_overlap(result, reference)
    return result, reference, crs


def painted_of(call, name, progress):
    """(AssessedLayer of polygons and lines, whether it was a raster) of a vector or raster layer."""
    source, path, crs = call.painted(name)
    if source is not None:
        return _read(source)[0], False
    polygons, values, _ = products.assess.layers.polygons_of_raster(path, progress)
    crs, units = core.io.crs.in_metres(crs)
    if not units.metric:
        polygons = [shapely.transform(polygon, units.in_metres) for polygon in polygons]
    has_classes = len(set(values.tolist())) > 1
    rows = [{"class": str(value)} if has_classes else {} for value in values]
    return products.assess.layers.AssessedLayer(call.label(name), polygons, rows, crs), True


def frame_of_drive(call, crs):
    """The road frame of TRAJECTORY in the CRS; None where it was not given. Heights are not needed."""
    trajectory = call.trajectory(heights_needed=False)
    if trajectory is None:
        return None
    return core.survey.frame.road_frame.build_frame(core.survey.trajectory.trajectory.reproject_trajectory(trajectory, crs))


def area_of(call, crs, warn):
    """The union of AREA's polygons in the CRS; None where it was not given."""
    layer = layer_of(call, "AREA")
    if layer is None:
        return None
    products.assess.layers.check_kind(layer, ("Polygon",), "polygons")
    if not layer.geometries:
        raise RoadExtractionError(tr("{label} has no polygons. Leave it empty to judge everywhere.", label=layer.label))
    return shapely.union_all(shapely.make_valid(shapely.force_2d(products.assess.layers.in_crs(layer, crs, warn).geometries)))


def found_numbers(numbers):
    """The numbers that there are: a share of nothing is left out."""
    return {name: float(value) for name, value in numbers.items() if value is not None and value == value}


def shares_of(numbers, names):
    """Shares as the log tells them: precision 99.5 %, recall 98.0 %."""
    shares = [f"{name.split('_')[0].capitalize() if name.startswith('F1') else name.split('_')[0].lower()} {numbers[name]:.1f} %"
              for name in names if name in numbers]
    return ", ".join(shares)


BOUNDARY_SETTINGS = settings_of("products.assess.lines:BoundaryAccuracySettings", "TOLERANCE INTERVAL* CORRIDOR*")


class AssessBoundaries(Algorithm):
    ID, TITLE, GROUP = "assessboundaries", "Assess road boundaries", "Assessment"
    NUMBERS = ("PRECISION RECALL F1 IOU CORRECT MISSED FALSE EXCLUDED_INTERVALS MEAN RMSE P95 MAXIMUM HEIGHT_MEAN HEIGHT_RMSE HEIGHT_P95 "
               "HEIGHT_MAXIMUM PRECISION_LEFT RECALL_LEFT F1_LEFT PRECISION_RIGHT RECALL_RIGHT F1_RIGHT").split()

    def declare(self):
        self.add_input("layer", "INPUT", geometry="LineStringZ")
        self.add_input("layer", "REFERENCE", geometry="LineStringZ")
        self.add_trajectory(optional=True)
        add_tolerances(self, BOUNDARY_SETTINGS)
        self.add_settings(BOUNDARY_SETTINGS)
        self.add_input("choice", "EDGES", default="automatic", choices=("automatic", "all", "curbs"))
        self.add_input("expression", "EXCLUDED", optional=True, advanced=True, default="", of="REFERENCE")
        self.add_input("layer", "AREA", geometry="PolygonZ", optional=True)
        self.add_sink("OUTPUT", fields=ASSESSED_BOUNDARIES, geometry="MultiLineStringZ", look="ASSESSED_LINES")
        self.add_report()

    def work(self, call, progress):
        settings = call.settings(BOUNDARY_SETTINGS, tolerances=tolerances(call))
        reference = reference_of(call, "REFERENCE")
        result, reference, crs = compared_lines(layer_of(call, "INPUT"), reference, progress)
        progress.report(0.2)
        frame, area = frame_of_drive(call, crs), area_of(call, crs, progress.warn)
        for choose in (products.assess.layers.bottoms_only, products.assess.layers.along_the_road_only):
            result, reference = (choose(layer, progress.warn) for layer in (result, reference))
        result, reference = products.assess.layers.edges_that_compare(result, reference, call.value("EDGES"), progress.warn)
        judged, excluded = (reference.subset([(why is None) == is_judged for why in reference.excluded]) for is_judged in (True, False))
        products.assess.layers.check_reference(judged, result, frame, area, progress.warn, settings.corridor)
        progress.report(0.4)
        accuracy = products.assess.lines.assess_boundaries(
            result.geometries, judged.geometries, settings, frame, excluded.geometries, excluded.excluded, area, judged.column("side"),
            progress.part(0.4, 0.8))
        progress.report(0.8)
        layer = products.assess.layers.boundary_layer(accuracy, crs, progress.part(0.8, 0.95))
        call.layer("OUTPUT", layer)
        if call.wants("REPORT"):
            names = call.layer_name("INPUT"), call.layer_name("REFERENCE")
            call.text("REPORT", products.report.assessment.boundary_report(accuracy, layer, names, progress.warnings))
        numbers = found_numbers(_boundary_numbers(accuracy))
        progress.info(tr("Intervals within {tolerance:g} cm: {correct:.0f} correct, {missed:.0f} missed, {false:.0f} false; {rates}.",
                         correct=numbers["CORRECT"], missed=numbers["MISSED"], false=numbers["FALSE"], tolerance=100 * settings.tolerance,
                         rates=shares_of(numbers, ("PRECISION", "RECALL", "F1"))))
        return numbers


def _boundary_numbers(accuracy):
    tolerance = accuracy.settings.tolerance
    total = accuracy.total[tolerance]
    numbers = {
        **_shares(total.rates, "precision recall f1 iou"), "CORRECT": total.rates.right, "MISSED": total.rates.missed, "FALSE": total.rates.false,
        "EXCLUDED_INTERVALS": (accuracy.intervals.excluded != "").sum(), **_errors(total.lateral), **_errors(total.height, "HEIGHT_"),
    }
    for side in ("left", "right"):
        if side in accuracy.by_side:
            numbers |= _shares(accuracy.by_side[side][tolerance].rates, after=f"_{side.upper()}")
    return numbers


def _shares(rates, names="precision recall f1", before="", after=""):
    return {f"{before}{name.upper()}{after}": 100 * getattr(rates, name) for name in names.split()}


def _errors(errors, before=""):
    return {f"{before}{name.upper()}": getattr(errors, name) for name in ("mean", "rmse", "p95", "maximum")}


MARKING_SETTINGS = settings_of("products.assess.markings:MarkingAccuracySettings", "TOLERANCE CELL_SIZE* LINE_WIDTH*")


class AssessMarkings(Algorithm):
    ID, TITLE, GROUP = "assessmarkings", "Assess markings", "Assessment"
    NUMBERS = ("PRECISION RECALL F1 IOU PRECISION_TOLERANT RECALL_TOLERANT F1_TOLERANT OBJECT_PRECISION OBJECT_RECALL OBJECT_F1 HITS MISSES "
               "FALSE_ALARMS").split()
    RETIRED = ("FOUND_SHARE",)

    def declare(self):
        self.add_input("painted", "INPUT")
        self.add_input("painted", "REFERENCE")
        self.add_trajectory(optional=True)
        add_tolerances(self, MARKING_SETTINGS)
        self.add_settings(MARKING_SETTINGS)
        self.add_input("text", "CLASS_FIELD", optional=True, advanced=True, default="class")
        self.add_input("layer", "AREA", geometry="PolygonZ", optional=True)
        self.add_input("raster", "IMAGE", optional=True)
        self.add_sink("OUTPUT", fields=ASSESSED_MARKINGS, geometry="MultiPolygonZ", look="ASSESSED_POLYGONS")
        self.add_output("raster", "CELLS", optional=True, by_default=False, look="ASSESSED_CELLS")
        self.add_report()

    def work(self, call, progress):
        settings = call.settings(MARKING_SETTINGS, tolerances=tolerances(call))
        layers = [painted_of(call, name, progress.part(*part))[0] for name, part in (("INPUT", (0.0, 0.15)), ("REFERENCE", (0.15, 0.3)))]
        crs = products.assess.layers.common_crs(layers[::-1])
        field = call.value("CLASS_FIELD")
        result, reference = (products.assess.layers.marking_polygons(products.assess.layers.in_crs(layer, crs, progress.warn), settings.line_width)
                             for layer in layers)
        products.assess.layers.check_overlap(result, reference)
        frame, area = frame_of_drive(call, crs), area_of(call, crs, progress.warn)
        products.assess.layers.check_marking_reference(reference, result, area, progress.warn)
        classes = [products.assess.layers.classes_of(layer, field) for layer in (result, reference)]
        image = call.raster_in("IMAGE", crs)
        shapes = [*result.geometries, *reference.geometries]
        raster = nullcontext()
        if call.wants("CELLS"):
            raster = products.assess.markings.outcome_raster(call.new_file("CELLS"), shapes, settings.cell_size, crs, max(settings.tolerances))
        with raster as cells:
            accuracy = products.assess.markings.assess_markings(
                result.geometries, reference.geometries, settings, *classes, area, image, cells, progress.part(0.35, 0.9))
        layer = products.assess.layers.marking_layer(accuracy, result.geometries, reference.geometries, *classes, crs)
        call.layer("OUTPUT", layer)
        if call.wants("REPORT"):
            station, along = products.assess.matching.stations_of_blocks(accuracy.blocks, frame)
            names = call.layer_name("INPUT"), call.layer_name("REFERENCE")
            call.text("REPORT", products.report.assessment.marking_report(accuracy, layer, names, station, along, image, progress.warnings))
        numbers = found_numbers(_marking_numbers(accuracy))
        progress.info(tr("Cells, strict: {strict}; with a tolerance of {cells}: {tolerant}.", cells=settings.tolerance,
                         strict=shares_of(numbers, ("PRECISION", "RECALL", "F1")),
                         tolerant=shares_of(numbers, ("PRECISION_TOLERANT", "RECALL_TOLERANT", "F1_TOLERANT"))))
        return numbers


def _marking_numbers(accuracy):
    strict = accuracy.strict
    return {**_shares(strict, "precision recall f1 iou"), **_shares(accuracy.tolerant, after="_TOLERANT"),
            **_shares(accuracy.objects, before="OBJECT_"), "HITS": strict.right, "MISSES": strict.missed, "FALSE_ALARMS": strict.false}


LINE_SETTINGS = settings_of("products.assess.lines:LineAccuracySettings", "TOLERANCE MAX_ANGLE*", TOLERANCE=dict(times=2.0))


class AssessDrivingLines(Algorithm):
    ID, TITLE, GROUP = "assessdrivinglines", "Assess driving lines", "Assessment"
    NUMBERS = ("COMPLETENESS CORRECTNESS QUALITY MISCODING PRECISION RECALL F1 MEAN RMSE P95 MAXIMUM HEIGHT_RMSE GAPS_PER_KM MEAN_GAP "
               "RESULT_LENGTH REFERENCE_LENGTH").split()

    def declare(self):
        self.add_input("layer", "INPUT", geometry="LineStringZ")
        self.add_input("layer", "REFERENCE", geometry="LineStringZ")
        self.add_trajectory(optional=True)
        add_tolerances(self, LINE_SETTINGS)
        self.add_input("choice", "WIDTH", default="half-width", choices=("half-width", "total-width"))
        self.add_settings(LINE_SETTINGS)
        self.add_input("layer", "AREA", geometry="PolygonZ", optional=True)
        self.add_sink("OUTPUT", fields=ASSESSED_DRIVING_LINES, geometry="MultiLineStringZ", look="ASSESSED_LINES")
        self.add_report()

    def work(self, call, progress):
        settings = self._settings(call)
        result, reference, crs = compared_lines(layer_of(call, "INPUT"), layer_of(call, "REFERENCE"), progress)
        frame, area = frame_of_drive(call, crs), area_of(call, crs, progress.warn)
        products.assess.layers.check_reference(reference, result, frame, area, progress.warn)
        progress.report(0.3)
        match = products.assess.lines.match_lines(result.geometries, reference.geometries, area, settings.max_angle, progress.part(0.3, 0.7))
        accuracy = match.accuracy(settings.tolerances)
        progress.report(0.7)
        layer = products.assess.layers.driving_line_layer(match, settings, crs, progress.part(0.7, 0.95))
        call.layer("OUTPUT", layer)
        if call.wants("REPORT"):
            station, along = products.assess.matching.stations_of_match(match, frame)
            call.text("REPORT", products.report.assessment.driving_report(
                match, accuracy, settings, layer, (call.layer_name("INPUT"), call.layer_name("REFERENCE")), station, along,
                call.value("WIDTH") == "total-width", progress.warnings))
        numbers = found_numbers(_line_numbers(accuracy, settings.tolerance))
        progress.info(tr("Within {tolerance:g} cm to either side: {rates}.", tolerance=100 * settings.tolerance,
                         rates=shares_of(numbers, ("COMPLETENESS", "CORRECTNESS", "MISCODING"))))
        return numbers

    def _settings(self, call):
        """The core works with half-widths."""
        share = 0.5 if call.value("WIDTH") == "total-width" else 1.0
        values = {spec.field: call.value(spec.name) for spec in LINE_SETTINGS}
        widths = tuple(share * width for width in tolerances(call))
        return replace(settings_class(LINE_SETTINGS[0].settings)(), **(values | {"tolerance": share * values["tolerance"], "tolerances": widths}))


def _line_numbers(accuracy, tolerance):
    complete, correct = 100 * accuracy.completeness[tolerance], 100 * accuracy.correctness[tolerance]
    return {
        "COMPLETENESS": complete, "CORRECTNESS": correct,
        "QUALITY": 100 * accuracy.quality[tolerance], "MISCODING": 100 * accuracy.miscoding[tolerance],
        "PRECISION": correct, "RECALL": complete, "F1": products.assess.matching.f1_of(correct if accuracy.result_length else 0.0, complete),
        **_errors(accuracy.lateral), "HEIGHT_RMSE": accuracy.height.rmse,
        "GAPS_PER_KM": accuracy.gaps_per_km[tolerance], "MEAN_GAP": accuracy.mean_gap[tolerance],
        "RESULT_LENGTH": accuracy.result_length, "REFERENCE_LENGTH": accuracy.reference_length,
    }
