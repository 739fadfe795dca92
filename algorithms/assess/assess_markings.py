"""Markings against a reference."""

from ...core.common.features import ASSESSED_MARKINGS
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import tr
from .inputs import add_area, add_tolerances, area_of, found_numbers, frame_of_drive, painted_of, shares_of, tolerances

MARKINGS = "products.assess.markings:MarkingAccuracySettings"

MARKING_SETTINGS = (
    SettingSpec("TOLERANCE", MARKINGS, "tolerance", tr("Tolerance of objects and of the layer (cells)"),
                tr("Objects are judged and numbers ending in TOLERANT returned with this tolerance; the report has all of them.")),
    SettingSpec("CELL_SIZE", MARKINGS, "cell_size", tr("Cell size (m)"),
                tr("Smaller weighs the rims of markings more and takes longer; published figures use 0.04."), advanced=True),
    SettingSpec("LINE_WIDTH", MARKINGS, "line_width", tr("Width of lines (m)"),
                tr("How wide paint is where a layer of lines has no field width_m or width."), advanced=True),
)


class AssessMarkings(Algorithm):
    ID, TITLE, GROUP = "assessmarkings", "Assess markings", "Assessment"
    SUMMARY = "Sets road markings against a reference, cell by cell, by class and by object: precision, recall, F1 and intersection over union."
    HELP = ("Polygons, lines or a raster mask (anything but 0 and no-data is paint), of other software too, on either side. A layer in another CRS "
            "is reprojected.")
    TAGS = ("accuracy", "precision", "recall", "iou", "validation", "road marking", "reference", "ground truth")
    LOOKS = {"OUTPUT": "ASSESSED_POLYGONS", "CELLS": "ASSESSED_CELLS"}
    NUMBERS = (
        *((name, tr("{what} (%)").format(what=what)) for name, what in (
            ("PRECISION", "Precision of cells, strict"), ("RECALL", "Recall of cells, strict"), ("F1", "F1 of cells, strict"),
            ("IOU", "Intersection over union of cells, strict"), ("PRECISION_TOLERANT", "Precision of cells with tolerance"),
            ("RECALL_TOLERANT", "Recall of cells with tolerance"), ("F1_TOLERANT", "F1 of cells with tolerance"),
            ("OBJECT_PRECISION", "Precision of objects"), ("OBJECT_RECALL", "Recall of objects"), ("OBJECT_F1", "F1 of objects"))),
        ("HITS", tr("Cells that are right")), ("MISSES", tr("Cells that were missed")), ("FALSE_ALARMS", tr("Cells that are false")),
    )
    RETIRED = ("FOUND_SHARE",)

    def declare(self):
        self.add_input("painted", "INPUT", tr("Markings to assess"), tr("Polygons, lines with a width, or a mask."))
        self.add_input("painted", "REFERENCE", tr("Reference markings"),
                       tr("Polygons, lines or a raster of what is painted; the values of a raster are its classes."))
        self.add_trajectory(optional=True)
        add_tolerances(self, MARKINGS, tr("Tolerances (cells)"), tr(
            "Cells by which the other layer is widened before it is asked, with commas between them; 0 is strict."))
        self.add_settings(MARKING_SETTINGS)
        self.add_input("text", "CLASS_FIELD", tr("Field with the class"),
                       tr("Looked for in both layers; a layer without it has no classes. Fields named mark_class and kind are found too."),
                       optional=True, advanced=True, default="class")
        add_area(self)
        self.add_input(
            "raster", "IMAGE", tr("Image that shows what was scanned"),
            tr("Where this raster, such as the intensity image, is empty nothing is judged, and the report's map lies over it. It hides what was "
               "never scanned, but also what the road surface left out: leave it empty to hold that against the result."), optional=True)
        self.add_sink("OUTPUT", tr("Markings by outcome"), tr("Objects of the reference, correct or missed, and the false ones of the result."),
                      fields=ASSESSED_MARKINGS, geometry="MultiPolygonZ")
        self.add_output("raster", "CELLS", tr("Hits, misses and false alarms"), tr(
            "1 hit, 2 missed, 3 false, 4 missed beside a hit (within the tolerance), 5 false beside paint."), optional=True, by_default=False)
        self.add_report()

    def work(self, call, progress):
        from ...products.assess.inputs import check_marking_reference, check_overlap, classes_of, common_crs, in_crs, marking_polygons
        from ...products.assess.layers import marking_layer
        from ...products.assess.markings import OutcomeRaster, assess_markings

        settings = call.settings(MARKING_SETTINGS, tolerances=tolerances(call))
        layers = [painted_of(call, name, progress.part(*part))[0] for name, part in (("INPUT", (0.0, 0.15)), ("REFERENCE", (0.15, 0.3)))]
        crs = common_crs(layers[::-1])
        field = call.value("CLASS_FIELD")
        result, reference = (marking_polygons(in_crs(layer, crs, progress.warn), settings.line_width) for layer in layers)
        check_overlap(result, reference)
        frame, area = frame_of_drive(call, crs), area_of(call, crs, progress.warn)
        check_marking_reference(reference, result, area, progress.warn)
        classes = [classes_of(layer, field) for layer in (result, reference)]
        image = call.raster_in("IMAGE", crs)
        cells = None
        if call.wants("CELLS"):
            shapes = [*result.geometries, *reference.geometries]
            cells = OutcomeRaster(call.new_file("CELLS"), shapes, settings.cell_size, crs, max(settings.tolerances))
        accuracy = assess_markings(result.geometries, reference.geometries, settings, *classes, area, image, cells, progress.part(0.35, 0.9))
        if cells is not None:
            cells.close()
        layer = marking_layer(accuracy, result.geometries, reference.geometries, *classes, crs)
        call.layer("OUTPUT", layer)
        if call.wants("REPORT"):
            self._report(call, accuracy, layer, frame, image, progress.texts)
        numbers = found_numbers(_numbers(accuracy))
        progress.info(tr("Cells, strict: {strict}; with a tolerance of {cells}: {tolerant}.").format(
            cells=settings.tolerance, strict=shares_of(numbers, ("PRECISION", "RECALL", "F1")),
            tolerant=shares_of(numbers, ("PRECISION_TOLERANT", "RECALL_TOLERANT", "F1_TOLERANT"))))
        return numbers

    def _report(self, call, accuracy, layer, frame, image, warnings):
        from ...products.assess.matching import stations_of_blocks
        from ...products.report.assessment import marking_report

        station, along = stations_of_blocks(accuracy.blocks, frame)
        names = call.layer_name("INPUT"), call.layer_name("REFERENCE")
        call.text("REPORT", marking_report(accuracy, layer, names, station, along, image, warnings))


def _numbers(accuracy):
    strict, tolerant, objects = accuracy.strict, accuracy.tolerant, accuracy.objects
    return {
        "PRECISION": 100 * strict.precision, "RECALL": 100 * strict.recall, "F1": 100 * strict.f1, "IOU": 100 * strict.iou,
        "PRECISION_TOLERANT": 100 * tolerant.precision, "RECALL_TOLERANT": 100 * tolerant.recall, "F1_TOLERANT": 100 * tolerant.f1,
        "OBJECT_PRECISION": 100 * objects.precision, "OBJECT_RECALL": 100 * objects.recall, "OBJECT_F1": 100 * objects.f1,
        "HITS": strict.right, "MISSES": strict.missed, "FALSE_ALARMS": strict.false,
    }
