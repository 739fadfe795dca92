"""The place of new layers among those of the project; on the main thread, when QGIS has added them."""

from __future__ import annotations

from qgis.core import QgsCoordinateTransform, QgsCsException, QgsLayerTree, QgsLayerTreeGroup, QgsMapLayer, QgsProject, QgsRectangle, QgsSettings

from .runs import Run

SURVEY, ALGORITHM, OUTPUT = "lanewright/survey", "lanewright/algorithm", "lanewright/output"  # custom properties of our groups and layers
CLOUDS = "lanewright/clouds"  # paths, one a line
INPUTS = "lanewright/inputs"  # JSON of what the run was given
REPLACE = "lanewright/replace_last_run"  # setting of the user
IMAGES = ("ORTHOIMAGE", "UAV_IMAGE")
BELOW_IMAGES = ("INTENSITY_IMAGE", "DENSITY")


def replaces_last_run() -> bool:
    """Whether the user wants a run to take the place of the last one of the same survey."""
    return QgsSettings().value(REPLACE, False, type=bool)


def set_replaces_last_run(replaces: bool) -> None:
    QgsSettings().setValue(REPLACE, bool(replaces))


def place_layer(layer: QgsMapLayer, project: QgsProject, output: str, run: Run) -> None:
    """Note where a layer comes from, take away what it replaces, and put an image below the lines of the map it lies under.

    Parameters
    ----------
    layer : in the tree of the project
    project : QgsProject
    output : the result whose look it has, such as ROAD_EDGES
    run : Run that made it
    """
    layer.setCustomProperty(OUTPUT, output)
    layer.setCustomProperty(ALGORITHM, run.algorithm)
    root = project.layerTreeRoot()
    node = root.findLayer(layer.id())
    group = node.parent() if node is not None else None
    if group is None or group is root:
        return
    group.setCustomProperty(SURVEY, run.survey)
    group.setCustomProperty(ALGORITHM, run.algorithm)
    if run.clouds:
        group.setCustomProperty(CLOUDS, "\n".join(run.clouds))
    if run.inputs:
        group.setCustomProperty(INPUTS, run.inputs)
    if replaces_last_run():
        _remove_former(layer, output, group, project)
    if output in IMAGES:
        _lay_under_map(layer, group, project)


def road_maps(root: QgsLayerTree) -> list[QgsLayerTreeGroup]:
    """Groups with driving lines or edges among our results, from above."""
    return [group for group in root.findGroups() if _layers(group, ("DRIVING_LINES", "ROAD_EDGES", "MARKING_LINES"))]


def _layers(group, outputs):
    """Our layers in a group that are one of these results."""
    return [node.layer() for node in group.findLayers() if node.layer() and node.layer().customProperty(OUTPUT) in outputs]


def _remove_former(layer, output, group, project):
    """Take the same result of the last run of the same survey and algorithm out of the project, and its group once that is empty."""
    algorithm, survey = layer.customProperty(ALGORITHM), group.customProperty(SURVEY)
    for former in project.layerTreeRoot().findGroups():
        if former.customProperty(SURVEY) != survey:
            continue
        old = [one.id() for one in _layers(former, (output,)) if one.id() != layer.id() and one.customProperty(ALGORITHM) == algorithm]
        if not old:
            continue
        project.removeMapLayers(old)
        if former is not group and not former.children():
            former.parent().removeChildNode(former)
        return


def _lay_under_map(image, group, project):
    """Move an image into the road map it overlaps: above the intensity image, below everything that is drawn."""
    root = project.layerTreeRoot()
    for road_map in road_maps(root):
        lines = _layers(road_map, ("DRIVING_LINES", "ROAD_EDGES", "MARKING_LINES"))
        if road_map is group or not any(_overlap(image, one, project) for one in lines):
            continue
        places = [place for place, node in enumerate(road_map.children())
                  if QgsLayerTree.isLayer(node) and node.layer() and node.layer().customProperty(OUTPUT) in BELOW_IMAGES]
        node = root.findLayer(image.id())
        road_map.insertChildNode(min(places, default=len(road_map.children())), node.clone())
        group.removeChildNode(node)
        if not group.children():
            group.parent().removeChildNode(group)
        return


def _overlap(one, other, project):
    """Whether the extents of two layers overlap."""
    try:
        extent = QgsCoordinateTransform(one.crs(), other.crs(), project).transformBoundingBox(one.extent())
    except QgsCsException:
        return False
    return QgsRectangle(extent).intersects(other.extent())
