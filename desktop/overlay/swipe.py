"""Two images of a place in one map, divided by a line that follows the mouse: an orthoimage or web map, and the intensity image."""

from __future__ import annotations

from qgis.core import Qgis, QgsMapLayer, QgsMapRendererParallelJob, QgsMapSettings, QgsProject
from qgis.gui import QgsMapCanvas, QgsMapMouseEvent, QgsMapTool
from qgis.PyQt.QtCore import QRect, Qt
from qgis.PyQt.QtGui import QColor, QImage, QKeyEvent, QPainter, QPaintEvent, QPen
from qgis.PyQt.QtWidgets import QWidget

from ...processing_provider.results.road_maps import output_of
from ..widgets import give_map_back, take_map

INTENSITY = "INTENSITY_IMAGE"


def images_to_compare(project: QgsProject, active: QgsMapLayer | None = None) -> list[QgsMapLayer]:
    """The image left of the line and the one right of it: the active layer or the uppermost that is shown, and the newest intensity image.

    Where there is no intensity image, the two uppermost images; fewer than two where there are no more.
    """
    nodes = [node for node in project.layerTreeRoot().findLayers() if node.layer() is not None and node.layer().type() == Qgis.LayerType.Raster]
    images = [node.layer() for node in sorted(nodes, key=lambda node: (node.layer() != active, not node.isVisible()))]
    right = next((image for image in images if output_of(image) == INTENSITY), None)
    others = [image for image in images if image != right and output_of(image) != INTENSITY] or [image for image in images if image != right]
    return others[:2] if right is None else [*others[:1], right]


class Swipe(QgsMapTool):
    """While it is the tool of a map, the one image is seen left of the mouse and the other one right of it, lines and points on both; Esc ends it."""

    def __init__(self, canvas: QgsMapCanvas):
        super().__init__(canvas)
        self.setCursor(Qt.CursorShape.SplitHCursor)
        self.images: list[QgsMapLayer] = []
        self.jobs: list[QgsMapRendererParallelJob] = []
        self.halves = _Halves(canvas.viewport())
        canvas.mapCanvasRefreshed.connect(self._draw)
        canvas.extentsChanged.connect(self.halves.hide)  # until the maps are drawn at the new place
        QgsProject.instance().layersWillBeRemoved.connect(self._forget)

    def begin(self, images: list[QgsMapLayer]) -> None:
        """Compare two images."""
        self.images = images
        take_map(self.canvas(), self)
        self.canvas().setFocus()  # for Esc
        self._draw()

    def _draw(self):
        """Draw both maps behind the window; the halves are seen when both are ready."""
        self._cancel()
        if not self.isActive() or len(self.images) < 2:
            return
        lines = [layer for layer in self.canvas().layers()
                 if layer.type() == Qgis.LayerType.Vector and layer.geometryType() != Qgis.GeometryType.Polygon]
        for image in self.images:
            settings = QgsMapSettings(self.canvas().mapSettings())
            settings.setLayers([*lines, image])
            job = QgsMapRendererParallelJob(settings)
            job.finished.connect(self._ready)
            self.jobs.append(job)
        for job in self.jobs:
            job.start()

    def _ready(self):
        if self.jobs and not any(job.isActive() for job in self.jobs):
            self.halves.show_images([(job.renderedImage(), image.name()) for job, image in zip(self.jobs, self.images)])

    def _cancel(self):
        for job in self.jobs:
            job.finished.disconnect(self._ready)
            job.cancelWithoutBlocking()
        self.jobs = []

    def _forget(self, removed):
        if any(image.id() in removed for image in self.images):
            self.end()
            self.images = []

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        self.halves.divide(event.pos().x())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.end()

    def end(self) -> None:
        """Show the map as it is."""
        give_map_back(self.canvas(), self)

    def deactivate(self) -> None:
        self._cancel()
        self.halves.hide()
        super().deactivate()


class _Halves(QWidget):
    """Lies on a map and lets all clicks through."""

    def __init__(self, parent: QWidget):
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.drawn: list[tuple[QImage, str]] = []
        self.at = parent.width() // 2
        self.hide()

    def show_images(self, drawn: list[tuple[QImage, str]]) -> None:
        self.drawn = drawn
        self.setGeometry(self.parent().rect())
        self.show()
        self.update()

    def divide(self, at: int) -> None:
        """Move the line, pixels from the left."""
        self.at = at
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        for (image, name), side in zip(self.drawn, (QRect(0, 0, self.at, self.height()), QRect(self.at, 0, self.width() - self.at, self.height()))):
            painter.setClipRect(side)
            painter.drawImage(0, 0, image)
            room = painter.fontMetrics().boundingRect(name).adjusted(-6, -3, 6, 3)
            room.moveTo(side.left() if side.left() == 0 else side.right() - room.width(), 0)
            painter.fillRect(room, QColor(255, 255, 255, 200))
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter, name)
        painter.setClipping(False)
        for colour, width in (("#ffffff", 3), ("#202020", 1)):
            painter.setPen(QPen(QColor(colour), width))
            painter.drawLine(self.at, 0, self.at, self.height())
