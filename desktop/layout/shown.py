"""What of a project belongs on the sheets of a road map: its layers that are switched on, and the image below them with its credit."""

from __future__ import annotations

from typing import Any

from qgis.core import Qgis, QgsMapLayer, QgsProject

from ...algorithms.export import DRAWN
from ...processing_provider.results.road_maps import RoadMap


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


def sheet_values(road_map: RoadMap, maps: list[RoadMap], project: QgsProject) -> dict[str, Any]:
    """{parameter: value} of Sheets along the road for a road map: what is switched on (all where nothing is), over the image that is seen."""
    shown = shown_layers(road_map, project) or list(road_map.layers)
    values: dict[str, Any] = {output: layer.id() if layer in shown else None for output, layer in zip(road_map.outputs, road_map.layers)}
    visible = project.layerTreeRoot().checkedLayers()
    below = next((layer for layer in layers_below(project, maps) if layer in visible), None)
    return {**{name: values.get(name) for name in DRAWN}, "TITLE": road_map.title,
            **({} if below is None else {"BELOW": below.id(), "CREDIT": credit_of(below)})}
