"""Road boundaries against a reference."""

from ...core.common.features import ASSESSED_BOUNDARIES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import tr
from .inputs import (
    add_area,
    add_excluded,
    add_tolerances,
    area_of,
    compared_lines,
    found_numbers,
    frame_of_drive,
    layer_and_excluded,
    layer_of,
    shares_of,
    tolerances,
)

BOUNDARY = "products.assess.boundaries:BoundaryAccuracySettings"

EDGES = ("automatic", "all", "curbs")
BOUNDARY_SETTINGS = (
    SettingSpec("TOLERANCE", BOUNDARY, "tolerance", tr("Tolerance of the layer and of the numbers (m)"),
                tr("The tolerance for which intervals are drawn and numbers returned; the report has all of them.")),
    SettingSpec("INTERVAL", BOUNDARY, "interval", tr("Length of an interval (m)"),
                tr("Longer lets a short error pass or spoil more of the road; published figures use 2."), advanced=True),
    SettingSpec("CORRIDOR", BOUNDARY, "corridor", tr("Corridor either side of the trajectory (m)"),
                tr("What lies farther out belongs to no road and is left out; the report tells how much."), advanced=True),
)


class AssessBoundaries(Algorithm):
    ID, TITLE, GROUP = "assessboundaries", "Assess road boundaries", "Assessment"
    SUMMARY = "Sets road boundaries against reference lines, side by side in intervals of 2 m: precision, recall, errors across and in height."
    HELP = ("Any two line layers will do, of other software too: flat or with heights, in one part or many, drawn either way, with any fields. "
            "A layer in another CRS is reprojected. Where a layer tells tops from bottoms in a field part, bottoms count.")
    TAGS = ("accuracy", "precision", "recall", "validation", "curb", "reference", "ground truth")
    LOOKS = {"OUTPUT": "ASSESSED_LINES"}
    NUMBERS = (
        ("PRECISION", tr("Precision (%)")), ("RECALL", tr("Recall (%)")), ("F1", tr("F (%)")), ("IOU", tr("Intersection over union (%)")),
        ("CORRECT", tr("Correct intervals")), ("MISSED", tr("Missed intervals")), ("FALSE", tr("False intervals")),
        ("EXCLUDED_INTERVALS", tr("Intervals that were not judged")),
        ("MEAN", tr("Mean lateral error (m)")), ("RMSE", tr("RMSE across (m)")), ("P95", tr("95th percentile of the lateral error (m)")),
        ("MAXIMUM", tr("Largest lateral error (m)")), ("HEIGHT_MEAN", tr("Mean height error (m)")), ("HEIGHT_RMSE", tr("RMSE in height (m)")),
        ("HEIGHT_P95", tr("95th percentile of the height error (m)")), ("HEIGHT_MAXIMUM", tr("Largest height error (m)")),
        *((f"{rate}_{side.upper()}", tr("{rate}, {side} (%)").format(rate=rate.capitalize(), side=side))
          for side in ("left", "right") for rate in ("PRECISION", "RECALL", "F1")),
    )

    def declare(self):
        self.add_input("layer", "INPUT", tr("Boundaries to assess"), tr("Lines that were extracted, such as road edges."), "LineStringZ")
        self.add_input("layer", "REFERENCE", tr("Reference boundaries"), tr(
            "Lines that are known to be right, one on each side of the road, such as the feet of the curbs."), "LineStringZ")
        self.add_trajectory(optional=True)
        add_tolerances(self, BOUNDARY, tr("Tolerances (m)"), tr(
            "Distances to either side within which a line is right, with commas between them. The report has a row for each."))
        self.add_settings(BOUNDARY_SETTINGS)
        self.add_input("choice", "EDGES", tr("Edges to judge"),
                       tr("Road edges hold curbs and, where there is no curb, edges of the pavement. Curbs judges curbs alone; all judges whatever "
                          "both layers hold. Automatic leaves edges of the pavement out where the field edge or kind of the reference says that it "
                          "holds curbs alone: such a reference cannot tell whether they are right."), default=EDGES[0], choices=EDGES)
        add_excluded(self)
        add_area(self)
        self.add_sink("OUTPUT", tr("Boundaries by outcome"), tr("One line an interval and outcome."), fields=ASSESSED_BOUNDARIES,
                      geometry="MultiLineStringZ")
        self.add_report()

    def work(self, call, progress):
        from ...products.assess.boundaries import assess_boundaries
        from ...products.assess.inputs import along_the_road_only, bottoms_only, check_reference, edges_that_compare
        from ...products.assess.layers import boundary_layer
        from ...products.report.assessment import boundary_report

        settings = call.settings(BOUNDARY_SETTINGS, tolerances=tolerances(call))
        reference, excluded, kinds = layer_and_excluded(call, "REFERENCE")
        result, reference, crs = compared_lines(layer_of(call, "INPUT"), reference, progress)
        progress.report(0.2)
        frame, area = frame_of_drive(call, crs), area_of(call, crs, progress.warn)
        for choose in (bottoms_only, along_the_road_only):
            result, _ = choose(result, progress.warn)
            reference, kept = choose(reference, progress.warn)
            excluded, kinds = ([values[k] for k in kept] for values in (excluded, kinds))
        result, reference, kept = edges_that_compare(result, reference, call.value("EDGES"), progress.warn)
        excluded, kinds = ([values[k] for k in kept] for values in (excluded, kinds))
        judged = reference.subset([not x for x in excluded])
        check_reference(judged, result, frame, area, settings.corridor, progress.warn)
        progress.report(0.4)
        accuracy = assess_boundaries(
            result.geometries, judged.geometries, settings, frame, reference.subset(excluded).geometries,
            [kind for kind, out in zip(kinds, excluded) if out], area, judged.column("side"), progress.part(0.4, 0.8))
        progress.report(0.8)
        layer = boundary_layer(accuracy, crs, progress.part(0.8, 0.95))
        call.layer("OUTPUT", layer)
        if call.wants("REPORT"):
            call.text("REPORT", boundary_report(accuracy, layer, (call.layer_name("INPUT"), call.layer_name("REFERENCE")), progress.texts))
        numbers = found_numbers(_numbers(accuracy))
        progress.info(tr("Intervals within {tolerance:g} cm: {correct:.0f} correct, {missed:.0f} missed, {false:.0f} false; {rates}.").format(
            correct=numbers["CORRECT"], missed=numbers["MISSED"], false=numbers["FALSE"], tolerance=100 * settings.tolerance,
            rates=shares_of(numbers, ("PRECISION", "RECALL", "F1"))))
        return numbers


def _numbers(accuracy):
    tolerance = accuracy.settings.tolerance
    total = accuracy.total[tolerance]
    numbers = {
        "PRECISION": 100 * total.rates.precision, "RECALL": 100 * total.rates.recall, "F1": 100 * total.rates.f1, "IOU": 100 * total.rates.iou,
        "CORRECT": total.rates.right, "MISSED": total.rates.missed, "FALSE": total.rates.false,
        "EXCLUDED_INTERVALS": (accuracy.intervals.excluded != "").sum(),
        "MEAN": total.lateral.mean, "RMSE": total.lateral.rmse, "P95": total.lateral.p95, "MAXIMUM": total.lateral.maximum,
        "HEIGHT_MEAN": total.height.mean, "HEIGHT_RMSE": total.height.rmse, "HEIGHT_P95": total.height.p95, "HEIGHT_MAXIMUM": total.height.maximum,
    }
    for side in ("left", "right"):
        if side in accuracy.by_side:
            rates = accuracy.by_side[side][tolerance].rates
            shares = {"PRECISION": rates.precision, "RECALL": rates.recall, "F1": rates.f1}
            numbers |= {f"{name}_{side.upper()}": 100 * share for name, share in shares.items()}
    return numbers
