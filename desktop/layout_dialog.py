"""What a print layout should show: which road map, on what paper, at what scale, and what lies below."""

from __future__ import annotations

from qgis.core import Qgis, QgsLayerTreeGroup, QgsMapLayer, QgsProject
from qgis.PyQt.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFormLayout, QWidget

from ..processing_provider.results.layer_tree import ALGORITHM
from ..processing_provider.results.runs import GROUP
from ..processing_provider.texts import tr
from .map_layout import PAPERS, SCALES

# tables of a GeoPackage, or file names, by which a group is known to hold a road map
ROAD_MAP = ("road_edges", "driving_lines", "marking_lines", "markings", "road_surface")


def road_map_groups(project: QgsProject) -> list[QgsLayerTreeGroup]:
    """Groups with layers of a road map, the newest first; groups of a survey, or of an image alone, are none."""
    ours = (group for group in project.layerTreeRoot().findGroups() if group.customProperty(ALGORITHM) or group.name().startswith(GROUP))
    return [group for group in ours if _holds_a_map(group)]


def _holds_a_map(group: QgsLayerTreeGroup) -> bool:
    lines = [layer for layer in shown_layers(group, hidden=True) if layer.type() == Qgis.LayerType.Vector]
    return any(layer.fields().lookupField("road") >= 0 and layer.fields().lookupField("station_m") >= 0
               and layer.geometryType() in (Qgis.GeometryType.Line, Qgis.GeometryType.Polygon) for layer in lines)


def shown_layers(group: QgsLayerTreeGroup, hidden: bool = False) -> list[QgsMapLayer]:
    """Layers of a group that have a place on the map, from above; those that are switched off only with `hidden`."""
    return [node.layer() for node in group.findLayers()
            if node.layer() and node.layer().isSpatial() and (hidden or node.itemVisibilityChecked())]


class LayoutDialog(QDialog):
    """Asks what to print; `choice` is what was chosen."""

    def __init__(self, project: QgsProject, groups: list[QgsLayerTreeGroup], parent: QWidget | None = None):
        super().__init__(parent)
        self.setWindowTitle(tr("Print layout of the road map"))
        self.groups, self.project = groups, project
        form = QFormLayout(self)
        self.group = QComboBox()
        self.group.addItems([group.name() for group in groups])
        self.paper = QComboBox()
        self.paper.addItems(list(PAPERS))
        self.scale = QComboBox()
        self.scale.addItem(tr("The largest at which the road fits; long roads on several pages"), 0)
        for scale in SCALES:
            self.scale.addItem(f"1 : {scale}", scale)
        self.below = QComboBox()
        self.below.addItem(tr("Nothing"), "")
        inside = {layer.id() for group in groups for layer in shown_layers(group, hidden=True)}
        for layer in project.mapLayers().values():
            if layer.id() not in inside and layer.isSpatial() and layer.type() != Qgis.LayerType.Vector:
                self.below.addItem(layer.name(), layer.id())
        if len(groups) > 1:
            form.addRow(tr("Road map"), self.group)
        form.addRow(tr("Paper"), self.paper)
        form.addRow(tr("Scale"), self.scale)
        form.addRow(tr("Layer below (orthoimage, web map)"), self.below)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form.addRow(buttons)

    @property
    def choice(self) -> dict:
        """The group, and the arguments of `road_map_layout` that were chosen."""
        below = self.project.mapLayer(self.below.currentData()) if self.below.currentData() else None
        return dict(group=self.groups[self.group.currentIndex()], paper=self.paper.currentText(), scale=self.scale.currentData(),
                    below=[below] if below is not None else [])
