"""Names, order, group and style of the layers a run puts into the project."""

from pathlib import Path

from qgis.core import (
    QgsContrastEnhancement,
    QgsProcessingLayerPostProcessorInterface,
    QgsRasterLayer,
    QgsRasterMinMaxOrigin,
    QgsSingleBandGrayRenderer,
    QgsVectorLayer,
)

from .results.attributes import explain_attributes
from .results.layer_tree import place_layer
from .results.ready_styles import add_ready_styles, load_look
from .results.runs import GROUP

STYLES = Path(__file__).resolve().parents[1] / "resources" / "styles"

# Output name -> (style, place in the group: small is drawn below)
LOOKS = {
    "INTENSITY_IMAGE": ("intensity_image", 10),
    "DENSITY": ("density", 11),
    "ROAD_SURFACE": ("road_surface", 20),
    "SCANLINES": ("scanlines", 25),
    "MARKINGS": ("markings", 30),
    "TRUTH_MARKINGS": ("truth_markings", 31),
    "MARKING_LINES": ("marking_lines", 40),
    "CROSS_SECTIONS": ("cross_sections", 45),
    "ROADSIDE": ("roadside", 55),
    "ROADSIDE_OBJECTS": ("roadside_objects", 61),
    "ROAD_EDGES": ("road_edges", 50),
    "BOUNDARIES": ("road_edges", 52),
    "TRUTH_BOUNDARIES": ("truth_boundaries", 51),
    "CURB_POINTS": ("curb_points", 60),
    "DRIVING_LINES": ("driving_lines", 70),
    "TRUTH_DRIVING_LINES": ("truth_driving_lines", 71),
    "TRUTH_SURFACE": ("truth_surface", 21),
    "LANES": ("lanes", 23),
    "TRUTH_LANES": ("truth_lanes", 22),
    "TRUTH_ROADSIDE": ("truth_roadside", 56),
    "TRAJECTORY": ("trajectory", 80),
    "PASSES": ("passes", 65),
    "CORRECTIONS": ("corrections", 95),
    "ASSESSED_CELLS": ("assessed_cells", 15),
    "ASSESSED_POLYGONS": ("assessed_polygons", 35),
    "ASSESSED_LINES": ("assessed_lines", 75),
    "OUTPUT": ("trajectory", 80),
    "ORTHOIMAGE": (None, 8),
    "UAV_IMAGE": (None, 7),
    "RESIDUALS": ("residuals", 90),
    "FINDINGS": ("findings", 92),
    "UAV_GCPS": ("control_points", 89),
    "CONTROL_POINTS": ("proposed_points", 89),
}
TABLES = 5  # tables lie below what is drawn


class Styler(QgsProcessingLayerPostProcessorInterface):
    """Applies a QML once QGIS has loaded the layer (never in qgis_process, which loads none)."""

    _kept = []  # QGIS keeps no reference, and Python would collect it before the layer is loaded

    def __init__(self, qml, schema, output="", run=None):
        super().__init__()
        self.qml, self.schema, self.output, self.run = qml, schema, output, run

    @classmethod
    def make(cls, qml, schema=(), output="", run=None):
        styler = cls(str(qml), schema, output, run)
        cls._kept = cls._kept[-50:] + [styler]
        return styler

    def postProcessLayer(self, layer, context, feedback):
        apply_style(layer, self.qml, self.schema, self.output)
        if isinstance(layer, QgsVectorLayer):
            add_ready_styles(layer, self.qml)
        if self.run is not None and context.project() is not None:
            place_layer(layer, context.project(), self.output, self.run)
        layer.triggerRepaint()


def apply_style(layer, qml, schema=(), output=""):
    """Give the layer of a result the look of a QML file, its fields names and formats, an image its stretch."""
    if Path(qml).exists():
        load_look(layer, qml)
    if isinstance(layer, QgsVectorLayer):
        explain_attributes(layer, output, schema)
    if isinstance(layer, QgsRasterLayer) and isinstance(layer.renderer(), QgsSingleBandGrayRenderer):
        # Intensities have no common scale: every image is stretched to its own values
        layer.setContrastEnhancement(
            QgsContrastEnhancement.ContrastEnhancementAlgorithm.StretchToMinimumMaximum,
            QgsRasterMinMaxOrigin.Limits.CumulativeCut)
        stretch = layer.renderer().contrastEnhancement()
        if stretch.maximumValue() - stretch.minimumValue() > 100:  # in the legend six decimals say nothing
            stretch.setMinimumValue(round(stretch.minimumValue()))
            stretch.setMaximumValue(round(stretch.maximumValue()))
            layer.rendererChanged.emit()


def style_on_load(name, dest, title, context, schema=(), run=None):
    """Name, group and style the layer `dest` of a Run where QGIS is going to load it."""
    if not dest or not context.willLoadLayerOnCompletion(dest):
        return
    details = context.layerToLoadOnCompletionDetails(dest)
    details.name, details.forceName, details.groupName = title, True, run.group if run else GROUP
    look, order = LOOKS.get(name, (None, TABLES))
    details.layerSortKey = order
    qml = STYLES / f"{look}.qml"
    details.setPostProcessor(Styler.make(qml, schema, name, run))
