"""The steps of a road map in their order: when each was made, whether it still holds, with what settings, and running it again."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from functools import cache
from pathlib import Path

from qgis.core import QgsMapLayer, QgsProcessingUtils, QgsProject, QgsProviderRegistry, QgsVectorLayer
from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import QHeaderView, QTreeWidget, QTreeWidgetItem, QWidget

from ...algorithms.algorithm import SettingSpec
from ...algorithms.catalogue import ALGORITHMS
from ...algorithms.destinations import table_of
from ...algorithms.survey_input import EXECUTION_SETTINGS, SURVEY_SETTINGS
from ...processing_provider.results.road_maps import CLOUDS, RoadMap, clouds_of, origin_of
from ...processing_provider.styling import PROVIDER
from ...processing_provider.texts import tr
from ..dialogs.algorithm_dialog import table_of_database
from ..dialogs.stage_inputs import STAGES, TRAJECTORY, stage_again
from ..widgets import button, column, row, wrapped
from .corrections_layer import NAME, changed_at

FRESH, STALE, CORRECTED = "#1a9850", "#d73027", "#2166ac"   # colours of the states
# What corrections are about -> the first step that they change
FIRST = {"edge": "detectboundaries", "marking": "clustermarkings", "lane": "drivinglines"}


@dataclass(frozen=True)
class Step:
    """One stage of a road map."""

    title: str   # of its algorithm
    layer: QgsMapLayer   # one that it made
    made: datetime
    colour: str   # of the state
    state: str   # state, reason: in the user's words
    reason: str
    settings: tuple[tuple[str, str, bool], ...]   # (label, value, whether it is not the default)


def steps_of(road_map: RoadMap, corrections: QgsVectorLayer | None) -> list[Step]:
    """The steps of which a road map has layers, in the order of the work; the layer of corrections is None where there is none."""
    layer_of: dict[str, QgsMapLayer] = {}
    for output, stage in STAGES.items():
        layer = road_map.layer(output)
        if layer is not None:
            layer_of.setdefault(stage, layer)
    steps, before, waits = [], None, False
    for stage, layer in layer_of.items():
        provenance = origin_of(layer).provenance
        targets = [target for target, first in FIRST.items() if first == stage]
        given = bool(provenance.values.get(NAME))
        changed = [changed_at(corrections, target, unmade=not given) for target in targets if corrections is not None]
        waits = waits or any(when is not None and when > provenance.ended for when in changed)
        if before is not None and before > provenance.ended:
            state = STALE, tr("stale"), tr("A step before it was run again later.")
        elif waits:
            state = STALE, tr("stale"), tr("Corrections were made since that change it.")
        elif given:
            state = CORRECTED, tr("corrected"), tr("Made with the corrections as they are.")
        else:
            state = FRESH, tr("fresh"), tr("Nothing that it is made from has changed.")
        before = max(filter(None, (before, provenance.ended)))
        declared = _declared(stage)
        settings = tuple(_settings(declared, {**road_map.values, **provenance.values}))
        steps.append(Step(declared.title(), layer, provenance.ended, *state, settings))
    return steps


@cache
def _declared(stage):
    """The algorithm of a step, made once: the steps are listed after every correction."""
    return next(algorithm for algorithm in ALGORITHMS if algorithm.ID == stage)()


def _settings(declared, values):
    """(label, value, whether it is not the default) of what is decided in this step alone."""
    for spec in declared.parameters:
        if isinstance(spec, SettingSpec) and spec.settings not in (SURVEY_SETTINGS[0].settings, EXECUTION_SETTINGS[0].settings):
            value = values.get(spec.name, spec.default)
            text = (tr("yes") if value else tr("no")) if isinstance(value, bool) else f"{value:g}" if isinstance(value, (int, float)) else str(value)
            yield spec.label, text, value != spec.default


def values_again(road_map: RoadMap, corrections: QgsVectorLayer | None = None) -> dict[str, object]:
    """{parameter: value} of the run of a road map, with the settings of steps that were run again by themselves, and where its results lie.

    Its point clouds are those where they lie now; `corrections` : made in the map, if any
    """
    values = road_map.values
    for origin in sorted((origin_of(layer) for layer in road_map.layers), key=lambda origin: origin.provenance.ended):
        values |= {name: value for name, value in origin.provenance.values.items() if name in values and name not in (CLOUDS, TRAJECTORY, NAME)}
    clouds, missing = clouds_of(road_map, QgsProject.instance())
    return {**values, **({} if missing else {CLOUDS: clouds}), NAME: None if corrections is None else corrections.id(), **saved(road_map)}


def saved(road_map: RoadMap) -> dict[str, str]:
    """{result: destination} of the layers that were saved, and of the report beside them: there a new run puts its own in their place."""
    places = {}
    for output, layer in zip(road_map.outputs, road_map.layers):
        parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
        path = str(parts.get("path") or "")
        if layer.providerType() == PROVIDER:
            places[output] = table_of_database(layer)
        elif path and not path.startswith(QgsProcessingUtils.tempFolder()):
            places[output] = table_of(path, parts["layerName"]) if parts.get("layerName") else path
            report = Path(path).parent / "report.html"
            if report.is_file():
                places["REPORT"] = str(report)
    return places


class StepsPanel(QWidget):
    """The list. Signal `run_wanted` asks for the whole map once more, `stage_wanted` (algorithm, values) for one step alone."""

    run_wanted = pyqtSignal()
    stage_wanted = pyqtSignal(str, dict)

    def __init__(self):
        super().__init__()
        self.steps: list[Step] = []
        self.of = wrapped()
        self.tree = QTreeWidget(itemSelectionChanged=self._selected)
        self.tree.setHeaderLabels([tr("Step"), tr("State")])
        self.tree.header().setStretchLastSection(False)
        for number, mode in enumerate((QHeaderView.ResizeMode.Stretch, QHeaderView.ResizeMode.ResizeToContents)):
            self.tree.header().setSectionResizeMode(number, mode)
        self.why = wrapped()
        self.again = button(tr("Run again from here…"), self.run_wanted.emit, tr(
            "Opens Road map with the settings of this run and the corrections; what is kept of the steps before is not made again"))
        self.alone = button(tr("This step alone…"), lambda: self.stage_wanted.emit(*stage_again(self.chosen.layer, QgsProject.instance())),
                            tr("Opens the algorithm of this step with what its run was given"))
        column(self, self.of, (self.tree, 1), self.why, row(self.again, self.alone))

    def show_map(self, road_map: RoadMap | None, corrections: QgsVectorLayer | None) -> None:
        """List the steps of a road map; None for none."""
        chosen = self.tree.indexOfTopLevelItem(self._top()) if self.tree.selectedItems() else 0
        self.steps = [] if road_map is None else steps_of(road_map, corrections)
        self.of.setText("" if road_map is None else f"<b>{road_map.name}</b>")
        open_titles = {self.tree.topLevelItem(k).text(0) for k in range(self.tree.topLevelItemCount()) if self.tree.topLevelItem(k).isExpanded()}
        self.tree.clear()
        for step in self.steps:
            item = QTreeWidgetItem([step.title, f"{step.state}, {step.made.astimezone():%H:%M}"])
            item.setForeground(1, QColor(step.colour))
            for label, value, changed in step.settings:
                setting = QTreeWidgetItem(item, [label, value])
                setting.setToolTip(0, label)
                font = setting.font(1)
                font.setBold(changed)
                setting.setFont(1, font)
            self.tree.addTopLevelItem(item)
            item.setExpanded(step.title in open_titles)
        if self.steps:
            self.tree.setCurrentItem(self.tree.topLevelItem(min(max(chosen, 0), len(self.steps) - 1)))
        self._selected()

    def _top(self):
        item, = self.tree.selectedItems()
        return item.parent() or item

    @property
    def chosen(self) -> Step | None:
        """The step that is selected, or one of whose settings is."""
        return self.steps[self.tree.indexOfTopLevelItem(self._top())] if self.steps and self.tree.selectedItems() else None

    def _selected(self):
        step = self.chosen
        self.again.setEnabled(step is not None)
        self.alone.setEnabled(step is not None and stage_again(step.layer, QgsProject.instance()) is not None)
        self.why.setText("" if step is None else step.reason)
