"""The picture of a section: points, and the lines that cross it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QColor, QCursor, QFont, QFontMetricsF, QImage, QMouseEvent, QPainter, QPen, QPolygonF, QWheelEvent
from qgis.PyQt.QtWidgets import QToolTip, QWidget

from ...core.common.arrays import round_step
from ...processing_provider.texts import tr
from .section import HALF_WIDTH, Crossing

LEFT, RIGHT, TOP, BOTTOM = 46, 10, 16, 18  # pixels about the picture, without its caption
LEAST_HEIGHT = 0.6       # m that the picture shows at least
MOST_TITLES = 0.7         # of the height of the picture that titles take
WHOLE_TITLES = 0.5        # of the height up to which titles are written whole
HEIGHT_ABOVE, HEIGHT_BELOW = 0.8, 0.5  # m shown above and below the lines on the road
ZOOM = 1.25              # of a turn of the wheel
NEAREST = 1.0            # m of width that zooming ends at
PAPER, INK, LABEL = QColor("#ffffff"), QColor("#222222"), QColor(255, 255, 255, 215)
CAPTION = int(Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap)
TRIANGLE = QPolygonF([QPointF(-5, 5), QPointF(5, 5), QPointF(0, -4)])   # of the top of a curb
SCANLINE, CORNER = QColor("#e07b00"), QColor("#8e24aa")


class SectionView(QWidget):
    """Points of a section by offset and height; the wheel zooms, dragging moves, pointing reads offset and height."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setMinimumSize(320, 180)
        self.setMouseTracking(True)
        self.points, self.crossings, self.scanline, self.corners = np.empty((0, 3)), [], [], []
        self.message = tr("Click on the road in the map.")
        self.centre, self.half = 0.0, 8.0   # m: middle and half of what is shown across
        self.low, self.high = 0.0, 1.0
        self._dragged = None

    def show_section(self, points: np.ndarray, crossings: list[Crossing], message: str = "", scanline: Sequence[np.ndarray] = (),
                     corners: Sequence[tuple[float, float, str]] = ()) -> None:
        """Show (N, 3) offset, z and intensity, the crossings, pieces of the scanline (V, 2) and corners (offset, z, part).

        `message` is shown where there is nothing else.
        """
        self.points, self.crossings, self.message, self.scanline, self.corners = points, crossings, message, list(scanline), list(corners)
        self._fit_heights()
        self.update()

    # -- metres and pixels --------------------------------------------------------------------------

    def _frame(self):
        return QRectF(LEFT, TOP, max(self.width() - LEFT - RIGHT, 10), max(self._caption().top() - BOTTOM - TOP, 10))

    def _caption(self):
        """The lines below the picture, as many as the caption needs at this width."""
        whole = QRectF(0, 0, self.width(), self.height())
        needed = QFontMetricsF(self._small(), self).boundingRect(whole, CAPTION, caption())
        return QRectF(0, self.height() - needed.height(), self.width(), needed.height())

    def _small(self):
        return QFont(self.font().family(), 8)

    def _at(self, offset, z):
        """Pixels of metres; left of the road is on the left."""
        frame = self._frame()
        return (frame.left() + (self.centre + self.half - offset) / (2 * self.half) * frame.width(),
                frame.bottom() - (z - self.low) / (self.high - self.low) * frame.height())

    def _metres(self, x, y):
        frame = self._frame()
        return (self.centre + self.half - (x - frame.left()) / frame.width() * 2 * self.half,
                self.low + (frame.bottom() - y) / frame.height() * (self.high - self.low))

    def _fit_heights(self):
        """The heights of the road: of the lines on it where there are any, else of the lowest points."""
        inside = np.abs(self.points[:, 0] - self.centre) <= self.half if len(self.points) else np.empty(0, bool)
        heights = [crossing.z for crossing in self._shown() if math.isfinite(crossing.z)]
        if heights:
            self.low, self.high = min(heights) - HEIGHT_BELOW, max(heights) + HEIGHT_ABOVE
            boxes = self._label_boxes(self._shown(), self._frame(), QFontMetricsF(self._small(), self))
            # titles of many lines take more rows: they stay above the road
            share = min(max(box.bottom() - TOP for box in boxes) / self._frame().height(), MOST_TITLES)
            self.high = max(self.high, (max(heights) - share * self.low) / (1.0 - share))
        elif inside.any():
            low = float(np.percentile(self.points[inside, 1], 2))
            self.low, self.high = low - HEIGHT_BELOW, low + HEIGHT_ABOVE + LEAST_HEIGHT

    # -- drawing ----------------------------------------------------------------------------------------

    def paintEvent(self, event) -> None:
        painter = QPainter(self)
        painter.fillRect(self.rect(), PAPER)
        frame = self._frame()
        if self.message and not len(self.points):
            painter.setPen(INK)
            painter.drawText(frame, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap), self.message)
        if not len(self.points) and not self.crossings:
            return
        self._draw_axes(painter, frame)
        painter.setClipRect(frame)
        self._draw_points(painter, frame)
        self._draw_scanline(painter)
        self._draw_crossings(painter, frame)
        self._draw_corners(painter)

    def _draw_axes(self, painter, frame):
        painter.setFont(self._small())
        for value in _ticks(self.centre - self.half, self.centre + self.half, frame.width() / 60):
            x, _ = self._at(value, self.low)
            painter.setPen(QPen(QColor("#e2e2e2")))
            painter.drawLine(QPointF(x, frame.top()), QPointF(x, frame.bottom()))
            painter.setPen(INK)
            painter.drawText(QRectF(x - 30, frame.bottom() + 2, 60, 14), int(Qt.AlignmentFlag.AlignHCenter), f"{value:g}")
        for value in _ticks(self.low, self.high, frame.height() / 30):
            _, y = self._at(self.centre, value)
            painter.setPen(QPen(QColor("#e2e2e2")))
            painter.drawLine(QPointF(frame.left(), y), QPointF(frame.right(), y))
            painter.setPen(INK)
            painter.drawText(QRectF(0, y - 7, LEFT - 4, 14), int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter), f"{value:.2f}")
        painter.drawText(self._caption(), CAPTION, caption())
        painter.drawRect(frame)

    def _draw_points(self, painter, frame):
        """The points as an image, the brighter the lighter; drawn one by one a hundred thousand would take seconds."""
        width, height = int(frame.width()), int(frame.height())
        if not len(self.points) or width < 2 or height < 2:
            return
        x, y = self._at(self.points[:, 0], self.points[:, 1])
        column, row = (x - frame.left()).astype(int), (y - frame.top()).astype(int)
        inside = (column >= 0) & (column < width - 1) & (row >= 0) & (row < height - 1)
        low, high = np.percentile(self.points[:, 2], (2, 98)) if inside.any() else (0.0, 1.0)
        grey = (190 * np.clip((self.points[:, 2] - low) / max(high - low, 1e-9), 0, 1)).astype(np.uint32)
        pixels = np.zeros((height, width), np.uint32)
        order = np.flatnonzero(inside)[np.argsort(grey[inside], kind="stable")[::-1]]
        colour = 0xFF000000 | grey[order] << 16 | grey[order] << 8 | grey[order]
        for down in (0, 1):
            for right in (0, 1):
                pixels[row[order] + down, column[order] + right] = colour
        data = pixels.tobytes()  # the image keeps no copy
        image = QImage(data, width, height, 4 * width, QImage.Format.Format_ARGB32)
        painter.drawImage(frame.topLeft(), image)

    def _draw_scanline(self, painter):
        painter.setPen(QPen(SCANLINE, 1.6))
        for line in self.scanline:
            x, y = self._at(*np.asarray(line).T)
            painter.drawPolyline(QPolygonF([QPointF(*place) for place in zip(x.tolist(), y.tolist())]))

    def _shown(self):
        """The crossings within what is shown across; where whole titles leave the road no room, with the beginnings of their titles."""
        shown = [crossing for crossing in self.crossings if abs(crossing.offset - self.centre) <= self.half]
        frame = self._frame()
        boxes = self._label_boxes(shown, frame, QFontMetricsF(self._small(), self))
        if max((box.bottom() - TOP for box in boxes), default=0.0) <= WHOLE_TITLES * frame.height():
            return shown
        return [replace(crossing, title=crossing.title.split(",")[0]) for crossing in shown]

    def _draw_crossings(self, painter, frame):
        painter.setFont(self._small())
        shown = self._shown()
        for crossing in shown:
            x, y = self._at(crossing.offset, crossing.z if math.isfinite(crossing.z) else self.low)
            colour = QColor(crossing.colour)
            painter.setPen(QPen(colour, 1.2, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(x, frame.top()), QPointF(x, frame.bottom()))
            painter.setPen(QPen(colour, 1.6))
            painter.setBrush(PAPER)
            if math.isfinite(crossing.top):
                top = QPointF(*self._at(crossing.offset, crossing.top))
                painter.drawLine(QPointF(x, y), top)
                painter.drawPolygon(TRIANGLE.translated(top))
            if math.isfinite(crossing.z):
                painter.drawEllipse(QPointF(x, y), 4, 4)
        for crossing, box in zip(shown, self._label_boxes(shown, frame, QFontMetricsF(painter.font(), self))):
            painter.fillRect(box, LABEL)
            painter.setPen(QColor(crossing.colour))
            painter.drawText(box, int(Qt.AlignmentFlag.AlignCenter), crossing.title)

    def _label_boxes(self, shown, frame, metrics):
        """Where the titles of crossings stand: beside their line, inside the frame, in the first row where they cover no other."""
        boxes = []
        for crossing in shown:
            x, _ = self._at(crossing.offset, self.low)
            width, height = metrics.horizontalAdvance(crossing.title) + 6, metrics.height()
            left = max(frame.left(), x + 3 if x + 3 + width <= frame.right() else x - 3 - width)
            rows = (QRectF(left, frame.top() + 2 + row * height, width, height) for row in range(len(boxes) + 1))
            boxes.append(next(box for box in rows if not any(box.intersects(earlier) for earlier in boxes)))
        return boxes

    def _draw_corners(self, painter):
        """Corners of curbs: bottoms as full circles, tops as full triangles."""
        painter.setPen(QPen(PAPER, 1))
        painter.setBrush(CORNER)
        for offset, z, part in self.corners:
            centre = QPointF(*self._at(offset, z))
            if part == "top":
                painter.drawPolygon(TRIANGLE.translated(centre))
            else:
                painter.drawEllipse(centre, 4, 4)

    # -- the mouse ----------------------------------------------------------------------------------------

    def wheelEvent(self, event: QWheelEvent) -> None:
        factor = 1 / ZOOM if event.angleDelta().y() > 0 else ZOOM
        offset, _ = self._metres(event.position().x(), event.position().y())
        half = min(max(self.half * factor, NEAREST / 2), HALF_WIDTH)
        self.centre = offset + (self.centre - offset) * half / self.half
        self.half = half
        self._fit_heights()
        self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._dragged = event.pos()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._dragged = None

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        frame = self._frame()
        if self._dragged is not None:
            self.centre += (event.pos().x() - self._dragged.x()) / frame.width() * 2 * self.half
            move = (event.pos().y() - self._dragged.y()) / frame.height() * (self.high - self.low)
            self.low, self.high, self._dragged = self.low + move, self.high + move, event.pos()
            self.update()
        elif frame.contains(event.pos()) and len(self.points):
            offset, z = self._metres(event.pos().x(), event.pos().y())
            QToolTip.showText(QCursor.pos(), f"{offset:+.2f} m, {z:.3f} m", self)


def caption() -> str:
    """What the axes and signs of the picture mean."""
    return tr("left ← offset from the place that was clicked (m) → right; heights in m; orange: scanline; ○ bottom, △ top of a curb")


def _ticks(low, high, most):
    """Round numbers between two limits, about so many at most."""
    step = round_step((high - low) / max(most, 1.0))
    return np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step
