"""From one doubtful place of a road map to the next."""

from __future__ import annotations

from qgis.core import Qgis, QgsCoordinateTransform, QgsCsException, QgsLayerTreeGroup, QgsProject, QgsRectangle

from ..processing_provider.texts import tr
from .doubtful import Doubt, doubts_of
from .section import layers_of

LEAST_VIEW = 30.0   # m of ground shown about a place
MOST_REASONS = 3    # told of one place


class DoubtTour:
    """Remembers where it is; begins again when the road map is another or has changed."""

    def __init__(self, iface):
        self.iface = iface
        self.places: list[Doubt] = []
        self.at = -1
        self._of = None

    @property
    def place(self) -> Doubt | None:
        """The place shown last."""
        return self.places[self.at] if 0 <= self.at < len(self.places) else None

    def go_on(self, group: QgsLayerTreeGroup) -> None:
        """Show the next place of a road map; after the last comes the first."""
        of = [(layer.id(), layer.featureCount()) for layer in layers_of(group)]
        if of != self._of:
            self.places, self.at, self._of = doubts_of(group), -1, of
        bar = self.iface.messageBar()
        bar.clearWidgets()
        if not self.places:
            bar.pushMessage("Lanewright", tr("Nothing in this road map is doubtful: all of it was measured."), level=Qgis.MessageLevel.Success)
            return
        self.at = (self.at + 1) % len(self.places)
        self._zoom(self.place)
        more = len(self.place.reasons) - MOST_REASONS
        said = "; ".join(self.place.reasons[:MOST_REASONS]) + (tr("; and {number} more").format(number=more) if more > 0 else "")
        bar.pushMessage("Lanewright", tr("Place {at} of {count}, road {road}, station {station:.0f} m. {said}").format(
            at=self.at + 1, count=len(self.places), road=self.place.road, station=self.place.station, said=said),
            level=Qgis.MessageLevel.Info, duration=0)

    def _zoom(self, place):
        canvas = self.iface.mapCanvas()
        extent = QgsRectangle(place.extent)
        extent.grow(max(0.15 * max(extent.width(), extent.height()), (LEAST_VIEW - max(extent.width(), extent.height())) / 2))
        try:
            shown = QgsCoordinateTransform(place.crs, canvas.mapSettings().destinationCrs(), QgsProject.instance()).transformBoundingBox(extent)
        except QgsCsException:
            return
        canvas.setExtent(shown)
        canvas.refresh()
