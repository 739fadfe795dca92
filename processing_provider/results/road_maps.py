"""Where a layer comes from, in the metadata that QGIS shows and keeps in the file; the road maps of a project, by what layers say of it; its runs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from functools import cache
from pathlib import Path
from typing import Any

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsLayerTree,
    QgsLayerTreeGroup,
    QgsMapLayer,
    QgsProcessingContext,
    QgsProject,
    QgsProviderRegistry,
    QgsRectangle,
    QgsSettings,
    QgsVectorLayer,
)
from qgis.PyQt import sip

from ...algorithms.catalogue import ALGORITHMS
from ...algorithms.provenance import Provenance, signed_by
from ...algorithms.rooms import products
from ...algorithms.survey_input import cloud_files, survey_name
from ...core.common.errors import RoadExtractionError
from ..texts import tr

OUTPUT = "lanewright/output"  # custom property of our layers: the result that they are, such as ROAD_EDGES
KNOWN = ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES", "CURVE_ELEMENTS", "PASSES", "CURB_POINTS",
         "BOUNDARIES", "CORNERS", "INTENSITY_IMAGE")  # results by whose names tables and files are usually called

IMAGES = {"roadmap": "INTENSITY_IMAGE", "intensityimage": "INTENSITY_IMAGE"}  # the image that an algorithm makes; its file says no more


@dataclass(frozen=True)
class Origin:
    """The run that a layer comes from, and which of its results it is; "" where that is not known."""

    provenance: Provenance
    output: str


def describe_origin(layer: QgsMapLayer, provenance: Provenance, output: str = "") -> None:
    """Set title, abstract and history of a layer; the history of an image that carried one is not repeated."""
    metadata = layer.metadata()
    metadata.setTitle(layer.name())
    metadata.setAbstract(f"{provenance.program}, {provenance.algorithm}")
    metadata.setLanguage("")
    for line in provenance.history(output):
        if line not in metadata.history():
            metadata.addHistoryItem(line)
    layer.setMetadata(metadata)


def origin_of(layer: QgsMapLayer) -> Origin | None:
    """The last run of this program that a layer's metadata tell of; None of a layer that is not ours."""
    metadata = layer.metadata()
    lines = [*metadata.history(), *metadata.abstract().splitlines()]
    runs = [run for text in lines if (run := Provenance.of_sentence(text)) is not None]
    if not runs and layer.type() == Qgis.LayerType.Raster and layer.providerType() == "gdal":
        signed = signed_by(layer.source())
        runs = [] if signed is None else [(signed, IMAGES.get(signed.algorithm, ""))]
    if not runs:
        return None
    provenance, output = max(runs, key=lambda one: one[0].ended)
    provenance = replace(provenance, warnings=tuple(provenance.warnings_among(lines)))
    return Origin(provenance, str(layer.customProperty(OUTPUT) or "") or output or _called(layer))


def output_of(layer: QgsMapLayer) -> str:
    """The result that a layer is, such as ROAD_EDGES; "" of a layer that is not ours."""
    noted = layer.customProperty(OUTPUT)
    origin = None if noted else origin_of(layer)
    return str(noted) if noted else "" if origin is None else origin.output


def _called(layer):
    """The result by whose name the table or file of a layer is called: an earlier version did not write it down."""
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    names = [str(parts.get(part) or "").upper() for part in ("layerName", "table")] + [layer.source().rsplit("/", 1)[-1].split(".")[0].upper()]
    return next((output for name in names for output in sorted(KNOWN, key=len, reverse=True) if name.endswith(output)), "")


# Which layers of a project are of which run, wherever they came from.

LINES = ("DRIVING_LINES", "ROAD_EDGES", "MARKING_LINES")  # a road map has one of these
CLOUDS = "POINT_CLOUDS"
MOVED = "lanewright/clouds"  # custom property of a layer: where the point clouds of its run lie now, one path a line


@dataclass(frozen=True)
class RoadMap:
    """The layers of one run, or those that stages made of one survey."""

    layers: tuple[QgsMapLayer, ...]   # from above; of each result the newest alone
    outputs: tuple[str, ...]   # of the layers, such as ROAD_EDGES
    provenance: Provenance   # of the run; of stages, that of the first one which names point clouds
    group: QgsLayerTreeGroup | None   # of the layer tree that holds them, None where they lie in none
    older: tuple[QgsMapLayer, ...] = ()   # layers in whose place a stage that was run again has put newer ones

    @property
    def survey(self) -> str:
        """What the survey is called, "" where none is known."""
        return survey_name(_named(self.provenance))

    @property
    def name(self) -> str:
        """Survey and local time of the run, by which it is told from others."""
        if self.group is not None:
            return self.group.name()
        return f"{self.survey or self.provenance.algorithm}, {self.provenance.ended.astimezone():%Y-%m-%d %H:%M:%S}"

    @property
    def title(self) -> str:
        """What it is called in print: its name without the time that a new group begins with."""
        return re.sub(r"^\d\d-\d\d \d\d:\d\d:\d\d ", "", self.name)

    @property
    def values(self) -> dict[str, Any]:
        """{parameter: value} of the run."""
        return dict(self.provenance.values)

    @property
    def vectors(self) -> list[QgsVectorLayer]:
        """The vector layers that have a place on the map."""
        return [layer for layer in self.layers if layer.type() == Qgis.LayerType.Vector and layer.isSpatial()]

    def layer(self, output: str) -> QgsMapLayer | None:
        """The layer that is a result, None where there is none."""
        return self.layers[self.outputs.index(output)] if output in self.outputs else None

    def has_any(self, names: Iterable[str]) -> bool:
        """Whether any of these ids of layers is one of its own."""
        return not {layer.id() for layer in self.layers}.isdisjoint(names)

    @property
    def is_a_map(self) -> bool:
        """Whether it has lines of a road."""
        return any(output in LINES for output in self.outputs)


def road_maps(project: QgsProject, active: QgsMapLayer | None = None) -> list[RoadMap]:
    """The road maps of a project: that of the active layer first, the others newest first."""
    maps = [one for one in runs_of(project) if one.is_a_map]
    return sorted(maps, key=lambda one: active is None or active not in one.layers)


def road_map_of(layer: QgsMapLayer, project: QgsProject) -> RoadMap | None:
    """The run that a layer of a project belongs to; None of a layer that is not ours."""
    return next((road_map for road_map in runs_of(project) if layer in road_map.layers), None)


def runs_of(project: QgsProject) -> list[RoadMap]:
    """All runs of this program of which a project has layers, newest first."""
    nodes = [node for node in project.layerTreeRoot().findLayers() if node.layer() is not None]
    placed = [(node, origin) for node in nodes if (origin := origin_of(node.layer())) is not None]
    whole: dict[Any, Any] = {}  # group of the layer tree -> run in one call whose layers it holds
    for node, origin in placed:
        if origin.provenance.algorithm in _whole_maps() and node.parent() is not project.layerTreeRoot():
            whole.setdefault(_id(node.parent()), _run_key(origin))
    runs: dict[Any, list] = {}
    for node, origin in placed:
        in_one_call = origin.provenance.algorithm in _whole_maps()
        key = _run_key(origin) if in_one_call else whole.get(_id(node.parent())) or _place_key(node, project)
        runs.setdefault(key, []).append((node, origin))
    return sorted((_road_map(entries, project) for entries in runs.values()), key=lambda one: one.provenance.ended, reverse=True)


@cache
def _whole_maps():
    """Algorithms that make a map in one call."""
    return frozenset(algorithm.ID for algorithm in ALGORITHMS if algorithm.WHOLE_MAP)


def _id(node):
    """By which a node of the layer tree is known: every look at it may give another object of Python."""
    return sip.unwrapinstance(node)


def _run_key(origin: Origin):
    return origin.provenance.algorithm, origin.provenance.time, repr(origin.provenance.values)


def _place_key(node, project):
    """What results of stages have in common: their group, or else the file or schema they lie in."""
    if node.parent() is not project.layerTreeRoot():
        return "group", _id(node.parent())
    layer = node.layer()
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    return "place", str(parts.get("path") or (parts.get("dbname"), parts.get("schema")))


def _road_map(layers_of_run, project):
    """The RoadMap of the (node of the layer tree, Origin) of one run."""
    newest: dict[str, Any] = {}
    for node, origin in layers_of_run:
        former = newest.get(origin.output)
        if former is None or origin.provenance.ended > former[1].provenance.ended:
            newest[origin.output] = node, origin
    kept = [(node, origin) for node, origin in layers_of_run if newest[origin.output][0] is node]
    in_one_call = [origin for _, origin in kept if origin.provenance.algorithm in _whole_maps()]
    with_clouds = [origin for _, origin in kept if origin.provenance.values.get(CLOUDS)]
    provenance = (in_one_call or with_clouds or [kept[0][1]])[0].provenance
    groups = [node.parent() for node, _ in kept if node.parent() is not project.layerTreeRoot()]
    layers = tuple(node.layer() for node, _ in kept)
    return RoadMap(layers, tuple(origin.output for _, origin in kept), provenance, groups[0] if groups else None,
                   tuple(node.layer() for node, _ in layers_of_run if node.layer() not in layers))


# -- point clouds -------------------------------------------------------------------------------


def _named(provenance):
    """The point clouds of a run: the files of folders and wildcards where they are still there, else the names."""
    clouds = provenance.values.get(CLOUDS) or []
    names = [str(name) for name in (clouds if isinstance(clouds, list) else [clouds])]
    try:
        return cloud_files(names, CLOUDS)
    except RoadExtractionError:
        return names


def clouds_of(road_map: RoadMap, project: QgsProject) -> tuple[list[str], list[str]]:
    """(paths of the point clouds of a road map that are there, names of those that are not).

    A cloud that is no longer where it was is looked for beside the layers, and beside the project.
    """
    moved = next((str(layer.customProperty(MOVED)).split("\n") for layer in road_map.layers if layer.customProperty(MOVED)), None)
    named = moved or _named(road_map.provenance)
    folders = [folder for folder in {project.absolutePath(), *_folders(road_map.layers)} if folder]
    present, missing = [], []
    for name in named:
        paths = [Path(name), *(Path(folder) / part for folder in sorted(folders) for part in (name, Path(name).name))]
        file = next((path for path in paths if path.is_file() and (path.is_absolute() or folders)), None)
        (missing.append(name) if file is None else present.append(str(file.absolute())))
    return present, missing


def _folders(layers: Iterable[QgsMapLayer]):
    """Where the files of layers lie."""
    for layer in layers:
        path = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source()).get("path")
        if path and Path(path).is_file():
            yield str(Path(path).parent)


def clouds_lie_in(road_map: RoadMap, folder: str, project: QgsProject) -> list[str]:
    """Look for the point clouds of a road map in a folder and below, and remember those that are found; the names of those that are not."""
    present, missing = clouds_of(road_map, project)
    path_by_name = {name: next((str(path) for path in sorted(Path(folder).rglob(Path(name).name)) if path.is_file()), "") for name in missing}
    for layer in road_map.layers if any(path_by_name.values()) else ():
        layer.setCustomProperty(MOVED, "\n".join([*present, *(path or name for name, path in path_by_name.items())]))
    return [name for name, path in path_by_name.items() if not path]


# The place of new layers among those of the project; on the main thread, when QGIS has added them.

UAV_IMAGES = ("ORTHOIMAGE", "UAV_IMAGE")
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
    if output in UAV_IMAGES and road_map.group is not None:
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


# The run that results come from, and the table of all runs since QGIS was started.

GROUP = "Lanewright"
SURVEY_OF_RUN = "lanewright_survey"  # what the stages of a model tell each other through their common context


@dataclass(frozen=True)
class Run:
    """One run of an algorithm."""

    provenance: Provenance   # what its layers say of it
    survey: str   # name of the survey, "" where none is known
    group: str   # name of the layer group, "" for none


def run_of(provenance: Provenance, clouds: list[str], whole: bool, context: QgsProcessingContext, group: str | None = None) -> Run:
    """The run that has just ended.

    clouds : paths of its point clouds; none for a stage that starts from another's result
    whole : whether it makes a map in one call. Each such run has a group of its own, named by time and survey;
        the stages of a survey share one, since together they make one map
    context : of the run; the stages of a model have one in common
    group : that its inputs stand in, "" where they stand in none; a stage puts its result beside them. None where they are no layers of ours
    """
    store = context.temporaryLayerStore()  # an object of Qt, which keeps a value for whoever comes next
    survey = survey_name(clouds) or str(store.property(SURVEY_OF_RUN) or "")
    store.setProperty(SURVEY_OF_RUN, survey)
    name = survey or GROUP
    return Run(provenance, survey, f"{datetime.now():%m-%d %H:%M:%S} {name}" if whole else name if group is None else group)


# The runs since QGIS was started, side by side: what a batch of surveys gave, and why some of them failed.

MOST_RUNS = 1000  # kept; a batch of more is read from its reports


@dataclass(frozen=True)
class RunRecord:
    """One run: its algorithm's title, survey, begin, seconds, numbers by label, why it failed ("" if it did not), warnings, and report or ""."""

    title: str
    survey: str
    began: datetime
    seconds: float
    numbers: Mapping[str, float]
    failure: str = ""
    warnings: tuple[str, ...] = ()
    report: str = ""


_runs: list[RunRecord] = []


def note_run(declaration: Any, survey: str, began: datetime, results: Mapping[str, Any] | None = None, failure: str = "",
             warnings: Sequence[str] = ()) -> None:
    """Remember a run that has just ended: when it began by local time, its results or the sentence that it failed with, its warnings."""
    numbers = {number.label: results[number.name] for number in declaration.numbers if results is not None and number.name in results}
    seconds = (datetime.now() - began).total_seconds()
    report = next((path for path in map(str, (results or {}).values()) if path.lower().endswith((".html", ".htm"))), "")
    _runs.append(RunRecord(declaration.title(), survey, began, seconds, numbers, failure, tuple(warnings), report))
    del _runs[:-MOST_RUNS]


def last_run() -> RunRecord | None:
    """The run that ended last; None where there was none."""
    return _runs[-1] if _runs else None


def last_report() -> str:
    """Path of the last report since QGIS was started; "" where there was none, or it is gone."""
    path = next((run.report for run in reversed(_runs) if run.report), "")
    return path if Path(path).is_file() else ""


def run_tables() -> list[tuple[str, list[str], list[list[Any]]]]:
    """(title, head, rows) of a table for every algorithm, with a row for each of its runs since QGIS was started."""
    tables = []
    for title in dict.fromkeys(run.title for run in _runs):
        runs = [run for run in _runs if run.title == title]
        labels = list(dict.fromkeys(label for run in runs for label in run.numbers))
        rows = [[f"{run.began:%Y-%m-%d %H:%M:%S}", run.survey or "–", *(run.numbers.get(label, "–") for label in labels),
                 round(run.seconds, 1), run.failure or "–"] for run in runs]
        tables.append((title, [tr("Begun"), tr("Survey"), *labels, tr("Duration (s)"), tr("Failed")], rows))
    return tables


def run_table() -> str:
    """An HTML page with these tables; "" where there was no run."""
    return products.report.page.html_page("runs", tables=run_tables()) if _runs else ""
