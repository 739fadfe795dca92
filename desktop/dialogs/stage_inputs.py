"""The layers of a road map as inputs of the stages that come after: chosen by what they are, from the newest or active map."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qgis.core import QgsApplication, QgsMapLayer, QgsMapLayerModel, QgsProcessingAlgorithm, QgsProject
from qgis.PyQt.QtCore import QIdentityProxyModel, QModelIndex, QObject, Qt
from qgis.PyQt.QtWidgets import QComboBox, QWidget

from ...processing_provider.results.road_maps import CLOUDS, RoadMap, clouds_of, origin_of, road_map_of, road_maps, runs_of

TRAJECTORY = "TRAJECTORY"
LAYER_INPUTS = ("source", "vector", "raster", "layer")
# The stage that makes a result of the whole chain; of what a stage made, it is that stage
STAGES = {"CURB_POINTS": "detectcurbs", "ROAD_EDGES": "detectboundaries", "ROAD_SURFACE": "extractroadsurface", "INTENSITY_IMAGE": "intensityimage",
          "MARKINGS": "clustermarkings", "MARKING_LINES": "fitmarkinglines", "DRIVING_LINES": "drivinglines", "LANES": "drivinglines",
          "CURVE_ELEMENTS": "drivinglines"}


def layers_for(algorithm: QgsProcessingAlgorithm, road_map: RoadMap) -> dict[str, Any]:
    """{parameter: id of a layer, or the trajectory of the run} for those inputs of an algorithm that a road map has."""
    inputs = [definition for definition in algorithm.parameterDefinitions() if definition.type() in LAYER_INPUTS and not definition.isDestination()]
    values = {definition.name(): road_map.layer(definition.name()).id() for definition in inputs if road_map.layer(definition.name()) is not None}
    driven = road_map.values.get(TRAJECTORY)
    if values and algorithm.parameterDefinition(TRAJECTORY) is not None and isinstance(driven, str) and (
            QgsProject.instance().mapLayer(driven) is not None or Path(driven.split("|")[0]).is_file()):
        values[TRAJECTORY] = driven
    return values


def presets(algorithm: QgsProcessingAlgorithm, project: QgsProject, active: QgsMapLayer | None) -> dict[str, Any]:
    """The inputs of an algorithm from the road map of the active layer, else from the newest one; none where it has none of them."""
    maps = road_maps(project, active)
    return layers_for(algorithm, maps[0]) if maps else {}


def stage_again(layer: QgsMapLayer, project: QgsProject) -> tuple[str, dict[str, Any]] | None:
    """(id of an algorithm, values) that make the result that a layer is once more, as its run was given; None of a layer that is not ours."""
    origin, road_map = origin_of(layer), road_map_of(layer, project)
    if origin is None or road_map is None:
        return None
    made_by = QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{origin.provenance.algorithm}")
    whole = made_by is None or made_by.declaration.WHOLE_MAP
    stage = STAGES.get(origin.output) if whole else origin.provenance.algorithm
    algorithm = QgsApplication.processingRegistry().createAlgorithmById(f"lanewright:{stage}")
    if algorithm is None:
        return None
    names = {definition.name() for definition in algorithm.parameterDefinitions()}
    values = {**road_map.values, **origin.provenance.values, **layers_for(algorithm, road_map)}
    clouds, missing = clouds_of(road_map, project)
    if clouds and not missing:
        values[CLOUDS] = clouds
    return algorithm.id(), {name: value for name, value in values.items() if name in names}


class NamesWithSurvey(QIdentityProxyModel):
    """A list of layers in which those of a run are called by their survey and time as well."""

    def __init__(self, listed, project: QgsProject, parent: QObject):
        super().__init__(parent)
        self.setSourceModel(listed)
        self.of = {layer.id(): run.name for run in runs_of(project) for layer in (*run.layers, *run.older)}

    def data(self, index: QModelIndex, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        value = super().data(index, role)
        if role != Qt.ItemDataRole.DisplayRole or not value:
            return value
        layer_id = super().data(index, int(QgsMapLayerModel.CustomRole.LayerId))
        return f"{value} – {self.of[layer_id]}" if layer_id in self.of else value


def layer_lists(window: QWidget) -> list[QComboBox]:
    """The lists of layers in a window; Python knows QGIS's own as plain boxes."""
    return [box for box in window.findChildren(QComboBox) if box.inherits("QgsMapLayerComboBox")]


def name_by_survey(window: QWidget, project: QgsProject) -> list[NamesWithSurvey]:
    """Call the layers in the lists of a window by their survey and time; what names them, for the window to keep."""
    kept = []
    for box in layer_lists(window):
        chosen = box.currentIndex()
        blocked = box.blockSignals(True)
        listed = box.model()
        listed.setParent(window)  # or the box, whose it is, would delete it
        kept.append(NamesWithSurvey(listed, project, window))
        box.setModel(kept[-1])
        box.setCurrentIndex(chosen)
        box.blockSignals(blocked)
    return kept
