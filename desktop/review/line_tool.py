"""A map tool that draws one line."""

from __future__ import annotations

from qgis.core import Qgis, QgsGeometry, QgsPointXY
from qgis.gui import QgsMapCanvas, QgsMapMouseEvent, QgsMapTool, QgsRubberBand
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QKeyEvent

COLOUR = "#2166ac"


class LineTool(QgsMapTool):
    """Left button: a vertex, snapped as the project says. Right button: the line is ready. Backspace: one vertex back. Esc: none.

    `drawn` has the line in the CRS of the map, `given_up` is sent when there is none, and `too_short` where it has one vertex alone:
    drawing goes on then. What was drawn stays while another tool, such as the hand, is used.
    """

    drawn = pyqtSignal(QgsGeometry)
    given_up = pyqtSignal()
    too_short = pyqtSignal()

    def __init__(self, canvas: QgsMapCanvas):
        super().__init__(canvas)
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.vertices: list[QgsPointXY] = []
        self.band = QgsRubberBand(canvas, Qgis.GeometryType.Line)
        self.band.setColor(QColor(COLOUR))
        self.band.setWidth(3)

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        if event.button() == Qt.MouseButton.RightButton:
            self.finish()
            return
        match = self.canvas().snappingUtils().snapToMap(event.mapPoint())
        self.add(match.point() if match.isValid() else event.mapPoint())

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        self._show([*self.vertices, event.mapPoint()] if self.vertices else [])

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Backspace and self.vertices:
            self.vertices.pop()
            self._show(self.vertices)
            event.ignore()  # or the canvas goes back to its last extent
        elif event.key() == Qt.Key.Key_Escape:
            self.clear()
            self.given_up.emit()

    def add(self, point: QgsPointXY) -> None:
        """One more vertex."""
        self.vertices.append(point)
        self._show(self.vertices)

    def finish(self) -> None:
        """Hand the line over."""
        vertices = list(self.vertices)
        if len(vertices) == 1:
            self.too_short.emit()
            return
        self.clear()
        if vertices:
            self.drawn.emit(QgsGeometry.fromPolylineXY(vertices))
        else:
            self.given_up.emit()

    def clear(self) -> None:
        """Forget what was drawn."""
        self.vertices = []
        self.band.reset(Qgis.GeometryType.Line)

    def _show(self, vertices):
        self.band.setToGeometry(QgsGeometry.fromPolylineXY(vertices), None)
