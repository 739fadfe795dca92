"""What a print layout should show: which road map, on what paper, at what scale, and what lies below."""

from __future__ import annotations

from qgis.core import Qgis, QgsMapLayer, QgsProject
from qgis.PyQt.QtWidgets import QDialog, QFormLayout, QLineEdit, QWidget

from ...processing_provider.results.road_maps import RoadMap
from ...processing_provider.texts import tr
from ..widgets import answers, choices
from .map_layout import PAPERS, SCALES


def shown_layers(road_map: RoadMap, project: QgsProject, hidden: bool = False) -> list[QgsMapLayer]:
    """Layers of a road map, and others in its group, that have a place on the map, from above; those that are switched off only with `hidden`."""
    inside = {node.layerId() for node in road_map.group.findLayers()} if road_map.group is not None else set()
    inside |= {layer.id() for layer in road_map.layers}
    return [node.layer() for node in project.layerTreeRoot().findLayers()
            if node.layerId() in inside and node.layer() and node.layer().isSpatial() and (hidden or node.itemVisibilityChecked())]


def layers_below(project: QgsProject, maps: list[RoadMap]) -> list[QgsMapLayer]:
    """Images and web maps of a project that are no part of a road map, from above."""
    inside = {layer.id() for road_map in maps for layer in shown_layers(road_map, project, hidden=True)}
    nodes = project.layerTreeRoot().findLayers()
    return [node.layer() for node in nodes if node.layer() and node.layer().id() not in inside and node.layer().isSpatial()
            and node.layer().type() != Qgis.LayerType.Vector]


def credit_of(layer: QgsMapLayer) -> str:
    """Whose data a layer shows, by its metadata or by its server; "" where neither says so."""
    return ", ".join(layer.metadata().rights()) or layer.serverProperties().attribution()


class LayoutDialog(QDialog):
    """Asks what to print; `choice` is what was chosen."""

    def __init__(self, project: QgsProject, maps: list[RoadMap], parent: QWidget | None = None):
        super().__init__(parent)
        self.setWindowTitle(tr("Print layout of the road map"))
        self.maps, self.project = maps, project
        form = QFormLayout(self)
        self.road_map = choices((road_map.name, road_map) for road_map in maps)
        self.paper = choices((paper, paper) for paper in PAPERS)
        self.scale = choices([(tr("The largest at which the road fits; long roads on several pages"), 0),
                              *((f"1 : {scale}", scale) for scale in SCALES)])
        self.below = choices([(tr("Nothing"), ""), *((layer.name(), layer.id()) for layer in layers_below(project, maps))])
        visible = [layer.id() for layer in project.layerTreeRoot().checkedLayers()]
        self.below.setCurrentIndex(next((row for row in range(1, self.below.count()) if self.below.itemData(row) in visible), 0))
        self.credit = QLineEdit()
        self.credit.setToolTip(tr("Whose data lie below, as their licence wants it said; stands in the lower left corner of the map"))
        self.below.currentIndexChanged.connect(lambda row: self._suggest_credit())
        self._suggest_credit()
        if len(maps) > 1:
            form.addRow(tr("Road map"), self.road_map)
        form.addRow(tr("Paper"), self.paper)
        form.addRow(tr("Scale"), self.scale)
        form.addRow(tr("Layer below (orthoimage, web map)"), self.below)
        form.addRow(tr("Credit on the map"), self.credit)
        for box in (self.scale, self.below):
            box.setMinimumContentsLength(42)
        form.addRow(answers(self))

    def _suggest_credit(self):
        below = self._layer_below()
        self.credit.setText(credit_of(below) if below is not None else "")
        self.credit.setEnabled(below is not None)

    def _layer_below(self):
        return self.project.mapLayer(self.below.currentData()) if self.below.currentData() else None

    @property
    def choice(self) -> dict:
        """The road map, and the arguments of `road_map_layout` that were chosen."""
        below = self._layer_below()
        return dict(road_map=self.maps[self.road_map.currentIndex()], paper=self.paper.currentText(), scale=self.scale.currentData(),
                    below=[below] if below is not None else [], credit=self.credit.text().strip())
