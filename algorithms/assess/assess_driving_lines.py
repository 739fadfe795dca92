"""Driving lines against a reference."""

from dataclasses import replace

from ...core.common.features import ASSESSED_DRIVING_LINES
from ..algorithm import Algorithm
from ..parameters import SettingSpec, settings_class
from ..texts import tr
from .inputs import add_area, add_tolerances, area_of, compared_lines, found_numbers, frame_of_drive, layer_of, shares_of, tolerances

LINES = "products.assess.driving_lines:LineAccuracySettings"
WIDTHS = ("half-width", "total-width")

LINE_SETTINGS = (
    SettingSpec(
        "TOLERANCE", LINES, "tolerance", tr("Tolerance of the layer and of the numbers (m)"),
        tr("The tolerance for which pieces are drawn and numbers returned, of the same kind as the others; the report has all of them."),
        times=2.0,  # total widths are halved
    ),
    SettingSpec("MAX_ANGLE", LINES, "max_angle", tr("Largest angle between lines that match (°)"),
                tr("Smaller keeps lines that cross from matching; 90 lets any direction match. The way a line is drawn does not matter."),
                advanced=True),
)


class AssessDrivingLines(Algorithm):
    ID, TITLE, GROUP = "assessdrivinglines", "Assess driving lines", "Assessment"
    SUMMARY = "Sets driving lines against reference lines within buffers: completeness, correctness, miscoding, errors and gaps."
    HELP = ("Any two line layers will do, of other software too: flat or with heights, in one part or many, drawn either way, with any fields. "
            "A layer in another CRS is reprojected. Miscoding is the share of the result outside the buffer of the reference.")
    TAGS = ("accuracy", "miscoding", "completeness", "correctness", "buffer", "validation", "reference", "ground truth")
    LOOKS = {"OUTPUT": "ASSESSED_LINES"}
    NUMBERS = (
        ("COMPLETENESS", tr("Completeness (%)")), ("CORRECTNESS", tr("Correctness (%)")),
        ("QUALITY", tr("Quality (%)")), ("MISCODING", tr("Miscoding (%)")),
        ("PRECISION", tr("Precision, the same as correctness (%)")), ("RECALL", tr("Recall, the same as completeness (%)")), ("F1", tr("F1 (%)")),
        ("MEAN", tr("Mean lateral error (m)")), ("RMSE", tr("RMSE across (m)")), ("P95", tr("95th percentile of the lateral error (m)")),
        ("MAXIMUM", tr("Largest lateral error (m)")), ("HEIGHT_RMSE", tr("RMSE in height (m)")), ("GAPS_PER_KM", tr("Gaps per km")),
        ("MEAN_GAP", tr("Mean length of the gaps (m)")), ("RESULT_LENGTH", tr("Length of the result (m)")),
        ("REFERENCE_LENGTH", tr("Length of the reference (m)")),
    )

    def declare(self):
        self.add_input("layer", "INPUT", tr("Driving lines to assess"), tr("Lines that were made."), "LineStringZ")
        self.add_input("layer", "REFERENCE", tr("Reference lines"), tr(
            "Lines that are known to be right, such as those drawn over an orthoimage."), "LineStringZ")
        self.add_trajectory(optional=True)
        add_tolerances(self, LINES, tr("Tolerances (m)"), tr("Sizes of the buffer, with commas between them. The report has a row for each."))
        self.add_input("choice", "WIDTH", tr("Tolerances are"),
                       tr("Half-width: from the line to the rim of its buffer. Total-width: from rim to rim, so that 0.20 lets a line be 0.10 m off. "
                          "Published figures seldom say which they mean; the report shows both."), default=WIDTHS[0], choices=WIDTHS)
        self.add_settings(LINE_SETTINGS)
        add_area(self)
        self.add_sink("OUTPUT", tr("Driving lines by outcome"), tr("The lines cut where the outcome changes: false pieces lie outside the buffer."),
                      fields=ASSESSED_DRIVING_LINES, geometry="MultiLineStringZ")
        self.add_report()

    def work(self, call, progress):
        from ...products.assess.driving_lines import match_lines
        from ...products.assess.inputs import check_reference
        from ...products.assess.layers import driving_line_layer
        from ...products.assess.matching import stations_of_match
        from ...products.report.assessment import driving_report

        settings = self._settings(call)
        result, reference, crs = compared_lines(layer_of(call, "INPUT"), layer_of(call, "REFERENCE"), progress)
        frame, area = frame_of_drive(call, crs), area_of(call, crs, progress.warn)
        check_reference(reference, result, frame, area, warn=progress.warn)
        progress.report(0.3)
        match = match_lines(result.geometries, reference.geometries, area, settings.max_angle, progress.part(0.3, 0.7))
        accuracy = match.accuracy(settings.tolerances)
        progress.report(0.7)
        layer = driving_line_layer(match, settings, crs, progress.part(0.7, 0.95))
        call.layer("OUTPUT", layer)
        if call.wants("REPORT"):
            station, along = stations_of_match(match, frame)
            call.text("REPORT", driving_report(
                match, accuracy, settings, layer, (call.layer_name("INPUT"), call.layer_name("REFERENCE")), station, along,
                call.value("WIDTH") == "total-width", progress.texts))
        numbers = found_numbers(_numbers(accuracy, settings.tolerance))
        progress.info(tr("Within {tolerance:g} cm to either side: {rates}.").format(
            tolerance=100 * settings.tolerance, rates=shares_of(numbers, ("COMPLETENESS", "CORRECTNESS", "MISCODING"))))
        return numbers

    def _settings(self, call):
        """The core works with half-widths."""
        share = 0.5 if call.value("WIDTH") == "total-width" else 1.0
        values = {spec.field: call.value(spec.name) for spec in LINE_SETTINGS}
        widths = tuple(share * width for width in tolerances(call))
        return replace(settings_class(LINES)(), **(values | {"tolerance": share * values["tolerance"], "tolerances": widths}))


def _numbers(accuracy, tolerance):
    from ...products.assess.metrics import f1_of

    complete, correct = 100 * accuracy.completeness[tolerance], 100 * accuracy.correctness[tolerance]
    return {
        "COMPLETENESS": complete, "CORRECTNESS": correct,
        "QUALITY": 100 * accuracy.quality[tolerance], "MISCODING": 100 * accuracy.miscoding[tolerance],
        "PRECISION": correct, "RECALL": complete, "F1": f1_of(correct if accuracy.result_length else 0.0, complete),
        "MEAN": accuracy.lateral.mean, "RMSE": accuracy.rmse,
        "P95": accuracy.lateral.p95, "MAXIMUM": accuracy.lateral.maximum, "HEIGHT_RMSE": accuracy.height_rmse,
        "GAPS_PER_KM": accuracy.gaps_per_km[tolerance], "MEAN_GAP": accuracy.mean_gap[tolerance],
        "RESULT_LENGTH": accuracy.result_length, "REFERENCE_LENGTH": accuracy.reference_length,
    }
