"""The layer of an analyst's corrections in the project: found, made, and written to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from datetime import datetime, timezone
from pathlib import Path

from qgis.core import (
    NULL,
    Qgis,
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsDataSourceUri,
    QgsFeature,
    QgsGeometry,
    QgsProject,
    QgsProviderRegistry,
    QgsSpatialIndex,
    QgsUnitTypes,
    QgsVectorLayer,
    QgsVectorLayerExporter,
)
from qgis.PyQt.QtWidgets import QFileDialog, QWidget

from ...core.common.errors import RoadExtractionError
from ...core.common.features import CORRECTIONS, OTHER
from ...core.corrections.corrections import SEEN
from ...processing_provider.call import qgis_fields
from ...processing_provider.results.road_maps import OUTPUT, RoadMap, brought_to, clouds_of
from ...processing_provider.styling import PROVIDER, STYLES, apply_style, explain_readings
from ...processing_provider.texts import tr
from ..widgets import say
from .doubtful import DoubtfulPiece

NAME = "CORRECTIONS"
TABLE = "corrections"
NEEDED = {"action", "target"}        # fields by which a layer of corrections is known
SURVEY = "lanewright/survey"         # custom property of the layer: whose corrections it has
CHANGES = "lanewright/changes"       # custom property of the layer: "time target xmin ymin xmax ymax" of what was made, moved or taken back
WRITTEN = "lanewright/written"       # custom property of the layer: numbers of the rows that were written here, one a line; others are of colleagues
FILE = "corrections.gpkg"
MOVED = 2.0        # m that a piece is moved at most
SAME_PLACE = 0.1   # m between two lines of which one is taken for the other


def corrections_layers(project: QgsProject) -> list[QgsVectorLayer]:
    """The layers of corrections in a project, from above: made here, or dropped in."""
    layers = [node.layer() for node in project.layerTreeRoot().findLayers() if isinstance(node.layer(), QgsVectorLayer)]
    return [layer for layer in layers if NEEDED <= {field.name() for field in layer.fields()}]


def layer_of(road_map: RoadMap | None) -> QgsVectorLayer | None:
    """The layer with the corrections of a road map: one that names its survey, else one that names none and lies where it does; None for none."""
    vectors = [] if road_map is None else road_map.vectors
    for layer in corrections_layers(QgsProject.instance()) if vectors else ():
        survey = layer.customProperty(SURVEY)
        if survey == road_map.survey or not survey and layer.featureCount() > 0 \
                and brought_to(vectors[0].extent(), vectors[0].crs(), layer.crs()).intersects(layer.extent()):
            return layer
    return None


def ask_for_file(parent: QWidget, road_map: RoadMap | None, title: str, name: str, kind: str) -> str:
    """The file that the user names, "" for none; offered is a name beside the project or the point clouds."""
    clouds = [] if road_map is None else clouds_of(road_map, QgsProject.instance())[0]
    folder = Path(QgsProject.instance().absolutePath() or (Path(clouds[0]).parent if clouds else Path.home()))
    options = QFileDialog.Option.DontConfirmOverwrite if name == FILE else QFileDialog.Option(0)
    path, _ = QFileDialog.getSaveFileName(parent, title, str(folder / name), kind, options=options)
    suffix = Path(name).suffix
    return path if not path or path.lower().endswith(suffix) else f"{path}{suffix}"


def ask_for_corrections(parent: QWidget, road_map: RoadMap | None) -> str:
    """Where the corrections are to be kept; "" where the user gave up."""
    return ask_for_file(parent, road_map, tr("File for the corrections"), FILE, "GeoPackage (*.gpkg)")


def layer_to_write(iface, road_map: RoadMap, ask: Callable[[], str]) -> QgsVectorLayer | None:
    """The layer that corrections of a road map go to, made where there is none; None where `ask` names no file, or none that can be written."""
    if (layer := layer_of(road_map)) is not None:
        lay_above(layer, road_map, QgsProject.instance())
        return layer
    place = place_beside(road_map) or ask()
    if not place:
        return None
    try:
        return new_corrections_layer(QgsProject.instance(), place, road_map.vectors[0].crs(), road_map.survey)
    except RoadExtractionError as problem:
        say(iface, str(problem), Qgis.MessageLevel.Warning)
        return None


def _placed(line, crs, layer):
    """A line in the CRS of a layer."""
    placed = QgsGeometry(line)
    placed.transform(QgsCoordinateTransform(crs, layer.crs(), QgsProject.instance()))
    return placed


def place_beside(road_map: RoadMap) -> str:
    """The table of PostGIS, beside those of a road map, in which all who review that map keep their corrections; "" for a map of files."""
    layer = road_map.vectors[0]
    if layer.providerType() != PROVIDER:
        return ""
    uri, output = QgsDataSourceUri(layer.source()), road_map.outputs[road_map.layers.index(layer)].lower()
    table = f"{uri.table()[:-len(output)]}{TABLE}" if uri.table().lower().endswith(output) else TABLE
    place = QgsDataSourceUri(uri.connectionInfo(False))
    place.setDataSource(uri.schema(), table, "geom", "", "id")
    return place.uri(False)


def place_of(layer: QgsVectorLayer) -> str:
    """Name of the file, or schema and table, that a layer lies in."""
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    return Path(parts["path"]).name if parts.get("path") else f"{parts.get('schema')}.{parts.get('table')}"


def new_corrections_layer(project: QgsProject, place: str, crs: QgsCoordinateReferenceSystem, survey: str = "") -> QgsVectorLayer:
    """A layer of corrections above all others, in a GeoPackage or a table of PostGIS; one that is there already is taken up again.

    place : path of the file, or as of `place_beside`
    Raises RoadExtractionError if it cannot be written, or is another layer.
    """
    in_file = "table=" not in place
    source, provider = (f"{place}|layername={TABLE}", "ogr") if in_file else (place, PROVIDER)
    layer = QgsVectorLayer(source, tr("Corrections"), provider)
    if not layer.isValid() and not (in_file and Path(place).exists()):
        exporter = QgsVectorLayerExporter(place, provider, qgis_fields(CORRECTIONS, with_aliases=False), Qgis.WkbType.LineStringZ, crs, False,
                                          {"driverName": "GPKG", "layerName": TABLE} if in_file else {})
        problem = exporter.errorMessage()
        del exporter  # writes what it has
        layer = QgsVectorLayer(source, tr("Corrections"), provider)
        if problem and not layer.isValid():   # else a colleague has just made it
            raise RoadExtractionError(
                tr("The corrections cannot be kept in {path}: {problem}. Choose another place.").format(path=place, problem=problem))
    if not NEEDED <= {field.name() for field in layer.fields()}:
        raise RoadExtractionError(tr("{path} holds no layer of corrections. Choose a new name.").format(path=place))
    apply_style(layer, STYLES / "corrections.qml", CORRECTIONS, NAME)
    layer.setCustomProperty(OUTPUT, NAME)
    layer.setCustomProperty(SURVEY, survey)
    project.addMapLayer(layer, False)
    project.layerTreeRoot().insertLayer(0, layer).setExpanded(False)
    return layer


def lay_above(layer: QgsVectorLayer, road_map: RoadMap, project: QgsProject) -> None:
    """Move corrections to the top of the layer tree where a road map lies above them: its image and surface would hide them."""
    root = project.layerTreeRoot()
    order = [node.layerId() for node in root.findLayers()]
    if order.index(layer.id()) > min(order.index(map_layer.id()) for map_layer in road_map.layers):
        node = root.findLayer(layer.id())
        root.insertChildNode(0, node.clone())
        node.parent().removeChildNode(node)


def add_correction(layer: QgsVectorLayer, line: QgsGeometry, crs: QgsCoordinateReferenceSystem, former: QgsFeature | None = None,
                   **values: object) -> int:
    """Write one row along a line, with values of the fields, None for empty; the number of the feature.

    former : an earlier decision about the same piece, which makes room for it; without, one of the same target at the same place does
    """
    placed = _placed(line, crs, layer)
    note_change(layer, values, placed)
    former = former or correction_at(layer, line, crs, str(values["target"]))
    values |= {"author": QgsApplication.userFullName() or QgsApplication.userLoginName(),
               "decided_at": f"{datetime.now(timezone.utc):%Y-%m-%d %H:%M:%S}"}
    lacking = [column for column in CORRECTIONS if column.name in values and layer.fields().lookupField(column.name) < 0]
    if lacking:  # a layer of an earlier version
        layer.dataProvider().addAttributes(list(qgis_fields(lacking, with_aliases=False)))
        layer.updateFields()
    feature = QgsFeature(layer.fields())
    feature.setGeometry(placed)
    for name, value in values.items():
        if layer.fields().lookupField(name) >= 0:
            feature[name] = NULL if value is None else value
    if layer.isEditable():
        layer.addFeature(feature)
    else:
        fine, (feature,) = layer.dataProvider().addFeatures([feature])
        if not fine:
            raise RoadExtractionError(tr("The correction was not kept in {place}: {problem}").format(
                place=place_of(layer), problem=layer.dataProvider().lastError()))
        layer.updateExtents()
    if former is not None:
        _delete(layer, [former.id()])
    note_written(layer, [feature])
    if values.get(OTHER.name):
        explain_readings(layer)
    layer.triggerRepaint()
    return feature.id()


def correction_at(layer: QgsVectorLayer, line: QgsGeometry, crs: QgsCoordinateReferenceSystem, target: str) -> QgsFeature | None:
    """The correction that was made of a piece, None where there is none."""
    placed = _placed(line, crs, layer)
    box = placed.boundingBox().buffered(SAME_PLACE)
    for feature in layer.getFeatures(box):
        if feature["target"] == target and feature.geometry().hausdorffDistance(placed) < SAME_PLACE:
            return feature
    return None


def corrections_of(layer: QgsVectorLayer | None, pieces: Sequence[DoubtfulPiece], crs: QgsCoordinateReferenceSystem) -> dict[int, QgsFeature]:
    """{number of a piece: the correction that was made of it}; one that moves a piece is known by where the piece begins and lies."""
    index, made = QgsSpatialIndex(), {}
    for number, piece in enumerate(pieces):
        index.addFeature(number, piece.line.boundingBox())
    for feature in layer.getFeatures() if layer is not None else ():
        line = feature.geometry()
        line.transform(QgsCoordinateTransform(layer.crs(), crs, QgsProject.instance()))
        for number in index.intersects(line.boundingBox().buffered(MOVED)):
            piece, begins = pieces[number], tuple(map(feature.attributeMap().get, ("road", "station_m")))
            is_of_kind = feature["target"] == (piece.target or piece.kind) and (feature["action"] == SEEN) == (not piece.target)
            if is_of_kind and (line.hausdorffDistance(piece.line) < SAME_PLACE or (
                    feature["action"] == "move" and not {None, NULL} & {*begins} and begins[0] == piece.road
                    and abs(begins[1] - piece.station) < SAME_PLACE and line.distance(piece.line) < MOVED)):
                made[number] = feature
    return made


def review_of(layer: QgsVectorLayer | None, pieces: Sequence[DoubtfulPiece], crs: QgsCoordinateReferenceSystem) -> tuple[list, list]:
    """What was decided, and the pieces that are left, as `review_report` wants them."""
    made, decided = corrections_of(layer, pieces, crs), []
    for row in layer.getFeatures() if layer is not None else ():
        metres = QgsUnitTypes.fromUnitToUnitFactor(layer.crs().mapUnits(), Qgis.DistanceUnit.Meters)
        words = [str(row.attributeMap().get(name) or "") for name in ("target", "action", "author", "decided_at")]
        decided.append((*words, row.geometry().length() * metres))
    left = sorted((piece for number, piece in enumerate(pieces) if number not in made), key=lambda piece: -piece.doubt)
    return decided, [(piece.target or piece.kind, piece.road, piece.station, piece.length, piece.doubt, piece.text) for piece in left]


def take_back(layer: QgsVectorLayer, feature: QgsFeature | None = None) -> bool:
    """Delete a correction, without one that which was made here last; False where there is none. Those of colleagues stay."""
    ids = written_here(layer)
    if feature is None and not ids:
        return False
    feature = feature or layer.getFeature(ids[-1])
    note_change(layer, feature, feature.geometry())
    _delete(layer, [feature.id()])
    layer.triggerRepaint()
    return True


def written_here(layer: QgsVectorLayer) -> list[int]:
    """Numbers of the rows that were written in this project and are still there, in that order."""
    there = set(layer.allFeatureIds())
    return [number for number in map(int, layer.customProperty(WRITTEN) or ()) if number in there]


def note_written(layer: QgsVectorLayer, rows: Iterable[QgsFeature]) -> None:
    layer.setCustomProperty(WRITTEN, [*written_here(layer), *(row.id() for row in rows)])


def note_change(layer: QgsVectorLayer, row: QgsFeature | dict[str, object], where: QgsGeometry) -> None:
    """Note that a correction has changed: what was made with it before no longer holds there."""
    if row["action"] != SEEN:
        box = where.boundingBox()
        corners = (f"{value:.9g}" for value in (box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum()))
        layer.setCustomProperty(CHANGES, [*changes_of(layer), " ".join((_now(), row["target"], *corners))])


def changes_of(layer: QgsVectorLayer) -> list[str]:
    """What has changed, as `CHANGES` has it."""
    return [str(change) for change in layer.customProperty(CHANGES) or ()]


def note_made(layer: QgsVectorLayer, count: int, begun: datetime) -> None:
    """Note that a run has made the first of its changes; what changed after it began counts as changed now, for the next run."""
    layer.setCustomProperty(CHANGES, [f"{_now()} {change.split(' ', 1)[1]}" for change in changes_of(layer)[count:]])
    ours = set(written_here(layer))
    for row in layer.getFeatures():
        if row.id() not in ours and (when := _decided_at(row)) is not None and when >= begun.replace(microsecond=0):
            note_change(layer, row, row.geometry())


def _now():
    return datetime.now(timezone.utc).isoformat()


def changed_at(layer: QgsVectorLayer, target: str, unmade: bool) -> datetime | None:
    """When corrections of a target (edge, marking, lane) were made or taken back last, UTC; None where that is not known.

    unmade : no run has made them yet, so that a row of which nothing is known counts as made now
    """
    times = [datetime.fromisoformat(when) for when, of, *_ in map(str.split, changes_of(layer)) if of == target]
    rows = [row for row in layer.getFeatures() if row["target"] == target and row["action"] != SEEN]
    if rows and unmade and not times:
        return datetime.now(timezone.utc)
    ours = set(written_here(layer))   # of these the changes tell
    return max([*times, *(when for row in rows if row.id() not in ours and (when := _decided_at(row)) is not None)], default=None)


def _decided_at(row):
    """When somebody wrote a row in the window; None of one that was written by hand."""
    try:
        return datetime.fromisoformat(f"{row.attributeMap().get('decided_at')}+00:00")
    except ValueError:
        return None


def _delete(layer, ids):
    if layer.isEditable():
        layer.deleteFeatures(ids)
    else:
        layer.dataProvider().deleteFeatures(ids)
