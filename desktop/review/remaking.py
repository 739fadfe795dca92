"""A line that says which stretch of the map is being made again, in the background, while one goes on."""

from __future__ import annotations

import math
from datetime import datetime, timezone
from functools import partial

from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsGeometry, QgsPointXY, QgsProcessing, QgsProject, QgsRectangle, QgsVectorLayer
from qgis.PyQt.QtWidgets import QProgressBar, QWidget

from ...processing_provider.results.road_maps import RoadMap, brought_to, road_maps
from ...processing_provider.texts import tr
from ..background import BackgroundRun, loaded
from ..widgets import button, column, row, say, wrapped
from .corrections_layer import changes_of, note_made
from .smart_pick import metres_of
from .steps import saved, values_again

MOST_NAMED = 3   # stretches that are named; of more, the first
NEAR = 30.0      # units of the map about a correction within which a driving line tells its station


class Remaking(QWidget):
    """The line, hidden while nothing is made. One run at a time: who asks meanwhile has the next one, for all that was corrected until then."""

    def __init__(self, iface):
        super().__init__(visible=False)
        self.iface = iface
        self.run: BackgroundRun | None = None
        self.wanted: tuple[str, str] | None = None   # survey, and id of the layer of corrections, of the next run
        self.said, self.bar = wrapped(), QProgressBar(maximum=100)
        column(self, self.said, row(self.bar, button(tr("Cancel"), self.cancel, tr("The map stays as it is; what is done so far is kept"))), rim=0)

    def ask(self, road_map: RoadMap, corrections: QgsVectorLayer) -> None:
        """Make a map again with its corrections, now or after the run under way."""
        self.wanted = road_map.survey, corrections.id()
        if self.run is None:
            self._begin()
        else:
            self.said.setText(tr("{stretch} is being made again; what was corrected meanwhile is next.", stretch=self.stretch))

    def cancel(self) -> None:
        """End the run, and those that wait."""
        self.wanted = None
        if self.run is not None:
            self.run.task.cancel()

    def forget(self) -> None:
        """Cancel, and take no notice of how it ends."""
        self.cancel()
        self.run = None

    def _begin(self):
        (survey, layer_id), self.wanted = self.wanted, None
        layer = QgsProject.instance().mapLayer(layer_id)
        road_map = next((one for one in road_maps(QgsProject.instance()) if one.survey == survey), None)
        if layer is None or road_map is None:   # removed meanwhile
            return
        changes = changes_of(layer)
        self.stretch = ", ".join(stretches(road_map, changes, layer.crs())[:MOST_NAMED]) or road_map.title
        self.said.setText(tr("{stretch} is being made again.", stretch=self.stretch))
        kept = saved(road_map)
        places = {output: kept[output] if output == "REPORT" else loaded(kept.get(output, QgsProcessing.TEMPORARY_OUTPUT))
                  for output in {**kept, **dict.fromkeys(road_map.outputs)}}
        self.run = BackgroundRun("roadmap", {**values_again(road_map, layer), **places}, partial(
            self._ended, layer.id(), len(changes), datetime.now(timezone.utc)))
        self.bar.setValue(0)
        self.run.task.progressChanged.connect(lambda percent: self.bar.setValue(round(percent)))
        self.show()

    def _ended(self, layer_id, count, begun, run, fine):
        layer = QgsProject.instance().mapLayer(layer_id)
        if run is not self.run:
            return
        self.run = None
        self.hide()
        if fine and layer is not None:   # else the project is another one
            note_made(layer, count, begun)
            run.load_results()
        elif not fine and not run.task.isCanceled():
            say(self.iface, tr("The map was not made again: {reason}", reason=run.reason), Qgis.MessageLevel.Warning)
        if self.wanted is not None:
            self._begin()


def stretches(road_map: RoadMap, changes: list[str], crs: QgsCoordinateReferenceSystem) -> list[str]:
    """Each road with the stations from the first to the last of the changes since a map was made, by the driving lines there."""
    lines, spans, metres = road_map.layer("DRIVING_LINES"), {}, metres_of(road_map)
    for when, _, *corners in map(str.split, changes if lines is not None else ()):
        place = brought_to(QgsRectangle(*map(float, corners)), crs, lines.crs())
        middle = QgsGeometry.fromPointXY(place.center())
        near = min(lines.getFeatures(place.buffered(NEAR)), key=lambda feature: feature.geometry().distance(middle), default=None)
        if near is not None and datetime.fromisoformat(when) > road_map.provenance.ended:
            line = near.geometry().extendLine(NEAR, NEAR)   # a correction may reach beyond its end
            along = [(line.lineLocatePoint(QgsGeometry.fromPointXY(QgsPointXY(x, y))) - NEAR) * metres
                     for x in (place.xMinimum(), place.xMaximum()) for y in (place.yMinimum(), place.yMaximum())]
            along = [near.geometry().length() * metres - at for at in along] if near["direction"] == -1 else along
            first, last = spans.get(near["road"], (math.inf, -math.inf))
            spans[near["road"]] = min(first, near["station_m"] + min(along)), max(last, near["station_m"] + max(along))
    return [tr("road {road}, {first:.0f}–{last:.0f} m", road=road, first=first, last=last) for road, (first, last) in sorted(spans.items())]
