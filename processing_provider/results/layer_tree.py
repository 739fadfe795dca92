"""The place of new layers among those of the project; on the main thread, when QGIS has added them."""

from __future__ import annotations

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsLayerTree,
    QgsMapLayer,
    QgsProject,
    QgsRectangle,
    QgsSettings,
)

from .road_maps import LINES, OUTPUT, describe_origin, origin_of, road_map_of, runs_of
from .runs import Run

IMAGES = ("ORTHOIMAGE", "UAV_IMAGE")
BELOW_IMAGES = ("INTENSITY_IMAGE", "DENSITY")


class Setting:
    """A yes or no of the user that QGIS keeps; no at first."""

    def __init__(self, key: str):
        self.key = f"lanewright/{key}"

    def holds(self) -> bool:
        return QgsSettings().value(self.key, False, type=bool)

    def keep(self, value: bool) -> None:
        QgsSettings().setValue(self.key, value)


REPLACES_LAST_RUN = Setting("replace_last_run")  # a run takes the place of the last one of the same survey
NAMES_ONLY = Setting("names_only")               # results name the files they were made from without their folders


def place_layer(layer: QgsMapLayer, project: QgsProject, output: str, run: Run) -> None:
    """Note which Run made a layer, hide or take away what it replaces, and put an image below the lines of the map it lies under.

    output : the result whose look it has, such as ROAD_EDGES
    """
    node = project.layerTreeRoot().findLayer(layer.id())
    if node is not None:
        node.setExpanded(False)  # legends of thirty entries would hide the layers
        _renew_group(node, run, project)
    layer.setCustomProperty(OUTPUT, output)
    describe_origin(layer, run.provenance, output)
    road_map = road_map_of(layer, project)
    if road_map is None:
        return
    former = [earlier for earlier in runs_of(project)
              if earlier.group is not None and earlier.survey == road_map.survey != "" and layer not in earlier.layers]
    if REPLACES_LAST_RUN.holds():
        _remove_former(layer, output, former, project)
    else:
        _hide_former(output, road_map, former, project)
    if output in IMAGES and road_map.group is not None:
        _lay_under_map(layer, road_map, project)
    image = road_map.layer("INTENSITY_IMAGE")
    if image is not None and output in ("INTENSITY_IMAGE", "ROAD_SURFACE") and road_map.layer("ROAD_SURFACE") is not None:
        project.layerTreeRoot().findLayer(image.id()).setItemVisibilityChecked(False)   # of what lies under asphalt only a dark fringe is seen


def _renew_group(node, run, project):
    """Call the group of a layer by the run that has written the layer in its place: QGIS leaves the layer there, and the run's own group empty."""
    group = project.layerTreeRoot().findGroup(run.group) if run.group else None
    if group is not None and not group.children():
        if node.parent() is not project.layerTreeRoot():
            node.parent().setName(run.group)
        group.parent().removeChildNode(group)


def _remove_former(layer, output, former, project):
    """Take the same result of the last run of the same survey and algorithm out of the project, and its group once that is empty."""
    algorithm = origin_of(layer).provenance.algorithm
    for run in former:
        old = run.layer(output)
        if old is None or origin_of(old).provenance.algorithm != algorithm:
            continue
        project.removeMapLayer(old.id())
        if not run.group.children():
            run.group.parent().removeChildNode(run.group)
        return


def _hide_former(output, this, former, project):
    """Switch off the earlier map of a survey that is made again, and the result of a stage that was run again: both would lie on each other."""
    for run in former:
        if run.group is this.group or run.layer(output) is None or run.provenance.ended > this.provenance.ended:
            continue
        if run.is_a_map and run.provenance.algorithm == this.provenance.algorithm:
            run.group.setItemVisibilityChecked(False)
    for old in this.older:
        if origin_of(old).output == output:
            project.layerTreeRoot().findLayer(old.id()).setItemVisibilityChecked(False)


def _lay_under_map(image, this, project):
    """Move an image into the road map it overlaps: above the intensity image, below everything that is drawn."""
    root = project.layerTreeRoot()
    for road_map in runs_of(project):
        lines = [layer for layer in map(road_map.layer, LINES) if layer is not None]
        if road_map.group in (None, this.group) or not any(
                brought_to(image.extent(), image.crs(), line.crs()).intersects(line.extent()) for line in lines):
            continue
        below = {layer.id() for layer in map(road_map.layer, BELOW_IMAGES) if layer is not None}
        rows = [row for row, node in enumerate(road_map.group.children()) if QgsLayerTree.isLayer(node) and node.layerId() in below]
        node = root.findLayer(image.id())
        road_map.group.insertChildNode(min(rows, default=len(road_map.group.children())), node.clone())
        this.group.removeChildNode(node)
        if not this.group.children():
            this.group.parent().removeChildNode(this.group)
        return


def brought_to(extent: QgsRectangle, source: QgsCoordinateReferenceSystem, target: QgsCoordinateReferenceSystem) -> QgsRectangle:
    """An extent in another CRS; an empty one where it has no place there."""
    try:
        return QgsCoordinateTransform(source, target, QgsProject.instance()).transformBoundingBox(extent)
    except QgsCsException:
        return QgsRectangle()
