"""A window that shows the points and lines of a section across the road, where the map was clicked or a doubt lies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsPointXY, QgsProject
from qgis.gui import QgsMapToolEmitPoint, QgsRubberBand
from qgis.PyQt.QtCore import QEvent, QPointF, QRectF, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QCursor, QFont, QFontMetricsF, QImage, QKeySequence, QMouseEvent, QPainter, QPen, QPolygonF, QWheelEvent
from qgis.PyQt.QtWidgets import QApplication, QDockWidget, QDoubleSpinBox, QFileDialog, QLabel, QToolTip, QWidget

from ...core.common.arrays import round_step
from ...core.road.scanlines.section_planes import slice_lines
from ...core.survey.frame.placement import PlaceIndex
from ...processing_provider.results.road_maps import RoadMap, clouds_lie_in, clouds_of, road_maps
from ...processing_provider.texts import numbers, tr
from ..background import with_points
from ..widgets import button, column, give_map_back, row, take_map, wrapped
from .corrections_layer import ask_for_corrections, layer_of
from .section import HALF_WIDTH, Crossing, Section, corners, crossings, middle_of, section_at
from .section_curb import CurbLine

AROUND = 40.0    # m of road kept in memory either side of a place, so that stepping along it needs no new reading
STEP = 1.0       # m of a step along the road
SHARE = 0.35     # of the window's height; by itself the section takes half of a small one
THICKNESS = 0.3  # m along the road that a section takes points from


class SectionDock(QDockWidget):
    """The window; `show_at` shows a place. Signal `corrected` is sent when a curb was drawn in it."""

    corrected = pyqtSignal()

    def __init__(self, iface):
        super().__init__(tr("Cross-section"), iface.mainWindow(), objectName="LanewrightCrossSection")
        self.iface = iface
        self.view = SectionView()
        self.curb = CurbLine(self)
        self.view.clicked.connect(lambda offset: self._tell(self.curb.click(offset)) if self.task is None and self._kept is not None else None)
        for signal, what in ((self.view.kept, self.curb.keep), (self.view.dropped, self.curb.drop), (self.view.undone, self.curb.undo)):
            signal.connect(lambda what=what: self._tell(what()))
        self.said = wrapped()
        self.ask_for_file = lambda: ask_for_corrections(self, self.road_map)
        self.tool = QgsMapToolEmitPoint(iface.mapCanvas(), canvasClicked=lambda point, button: self.show_at(
            point, iface.mapCanvas().mapSettings().destinationCrs()))
        self.band = None
        self.section = self.road_map = self.task = None
        self._asked: set[str] = set()  # road maps whose user was asked where the point clouds are
        self._kept, self._kept_at = None, None  # points about a place, by where they lie, and the place: (clouds, x, y)
        self.pick = button(tr("Click in the map"), lambda: take_map(iface.mapCanvas(), self.tool))
        back = button("◀", lambda: self.step(-STEP), tr("A metre back along the road"))
        ahead = button("▶", lambda: self.step(STEP), tr("A metre ahead along the road"))
        for arrow, key in ((back, ","), (ahead, ".")):
            arrow.setShortcut(key)
            arrow.setToolTip(f"{arrow.toolTip()} ({key})")
        self.thickness = QDoubleSpinBox(minimum=0.02, maximum=5.0, singleStep=0.05, value=THICKNESS, suffix=" m", toolTip=tr(
            "Length of road from which points are shown"), valueChanged=lambda value: self._draw())
        buttons = row(self.pick, back, ahead, QLabel(tr("Thickness")), self.thickness, None)
        buttons.addWidget(self.said, 1)
        self.setWidget(column(QWidget(), buttons, (self.view, 1), rim=4))
        iface.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self)
        iface.mainWindow().resizeDocks([self], [int(SHARE * iface.mainWindow().height())], Qt.Orientation.Vertical)
        self.visibilityChanged.connect(self._hide_line)
        QgsProject.instance().layersWillBeRemoved.connect(self._forget)

    def remove(self) -> None:
        """Take the window and its line out of QGIS."""
        QgsProject.instance().layersWillBeRemoved.disconnect(self._forget)
        give_map_back(self.iface.mapCanvas(), self.tool)
        self._hide_line(False)
        self.iface.removeDockWidget(self)

    def _forget(self, removed):
        """Show nothing any more of a road map of which layers leave the project."""
        if self.road_map is None or not self.road_map.has_any(removed):
            return
        self._stop_reading()
        self.section = self.road_map = self.curb.face = None
        self.said.clear()
        self._hide_line(False)
        self.view.show_section(np.empty((0, 3)), [], tr("Click on the road in the map."))
        self.view.show_face(())

    # -- where ------------------------------------------------------------------------------------

    def show_at(self, point: QgsPointXY, crs: QgsCoordinateReferenceSystem) -> None:
        self.said.clear()
        for road_map in road_maps(QgsProject.instance(), self.iface.activeLayer()):
            layers = road_map.vectors
            try:
                on_layer = QgsCoordinateTransform(crs, layers[0].crs(), QgsProject.instance()).transform(point)
            except QgsCsException:
                continue
            section = section_at(on_layer.x(), on_layer.y(), layers)
            if section is not None:
                self._show(section, road_map)
                return
        self.view.show_section(np.empty((0, 3)), [], tr("No line of a road map lies near: click on a road that Lanewright mapped."))

    def step(self, metres: float) -> None:
        if self.section is None:
            return
        x, y = self.section.moved(metres)
        turned = section_at(x, y, self.road_map.vectors)
        self._show(turned or Section(x, y, self.section.azimuth), self.road_map)

    def goes_on_in(self, road_map: RoadMap) -> None:
        """Show the same section of a map that was made again."""
        if self.section is not None and self.isVisible():
            self._show(self.section, road_map)

    def _show(self, section: Section, road_map: RoadMap) -> None:
        self.section, self.road_map, self.curb.face = section, road_map, None
        self.show()
        if self.band is None:
            self.band = QgsRubberBand(self.iface.mapCanvas(), Qgis.GeometryType.Line)
            self.band.setColor(QColor("#ff00c8"))
            self.band.setWidth(2)
        self.band.setToGeometry(section.line(), road_map.vectors[0].crs())
        self.band.show()
        self._stop_reading()  # what is under way belongs to the place before
        clouds = self._clouds(road_map)
        if not clouds:
            self._draw(tr("The point clouds of this road map are not there, so only its lines are shown."))
        elif self._kept_at is None or self._kept_at[0] != clouds or \
                max(abs(section.x - self._kept_at[1]), abs(section.y - self._kept_at[2])) > AROUND - HALF_WIDTH:
            self._read(clouds)
        else:
            self._draw()

    def _clouds(self, road_map):
        """The point clouds of a road map; the user is asked once where they are, where they are no longer where they were."""
        clouds, missing = clouds_of(road_map, QgsProject.instance())
        if missing and road_map.name not in self._asked:
            self._asked.add(road_map.name)
            folder = self.ask_for_folder(missing)
            if folder:
                clouds_lie_in(road_map, folder, QgsProject.instance())
                clouds, _ = clouds_of(road_map, QgsProject.instance())
        return clouds

    def ask_for_folder(self, gone: list[str]) -> str:
        """The folder that the user names; "" where there is none."""
        title = tr("Where is {name}? The folder of the point clouds of this road map").format(name=Path(gone[0]).name)
        return QFileDialog.getExistingDirectory(self, title, QgsProject.instance().absolutePath())

    # -- points -------------------------------------------------------------------------------------

    def _read(self, clouds):
        self.view.show_section(np.empty((0, 3)), [], tr("Reading points…"))
        key = (clouds, self.section.x, self.section.y)
        self.task = with_points(tr("Points of a cross-section"), clouds, key[1:], AROUND, _PointsByPlace,
                                lambda task, points, problem: self._ready(task, key, points, problem))

    def _stop_reading(self):
        if self.task is not None:
            self.task.cancel()
        self.task = None

    def _ready(self, task, place, points, problem):
        if task is not self.task:
            return
        self.task = None
        if points is None:
            self.view.show_section(np.empty((0, 3)), [], problem)
            return
        self._kept, self._kept_at = points, place
        self._draw()

    def points_about(self, x: float, y: float) -> np.ndarray:
        """(N, 4) x, y, z and intensity of the points kept about a place."""
        return self._kept.points[self._kept.index.within(np.array([x, y]) - AROUND / 8, np.array([x, y]) + AROUND / 8)]

    def _tell(self, text):
        self.said.setText(text)
        self._draw()

    def _draw(self, message=""):
        if self.section is None:
            return
        points = self._kept.cut(self.section, self.thickness.value()) if self._kept is not None and not message else np.empty((0, 3))
        layers, drawn = self.road_map.vectors, layer_of(self.road_map)
        layers += [drawn] if drawn is not None and drawn.crs() == layers[0].crs() else []
        lines = crossings(self.section, layers)
        middle = middle_of(lines)
        scanline = [line + (middle, 0.0) for line in slice_lines(points[:, 0] - middle, points[:, 1], 2 * HALF_WIDTH)]
        self.view.show_section(points, lines, message or tr("No points lie here."), scanline, corners(self.section, layers))
        face = () if self.curb.face is None else self.curb.face.places
        self.view.show_face([(self.section.offset(x, y), z) for x, y, z in face])

    def _hide_line(self, visible):
        if self.band is not None:
            self.band.setVisible(bool(visible))


class _PointsByPlace:
    """(N, 4) points of which a section is cut in no time, although they are millions."""

    def __init__(self, points):
        self.points, self.index = points, PlaceIndex(points[:, :2], 1.0)

    def cut(self, section, thickness):
        """As `Section.cut`."""
        offsets = np.arange(-HALF_WIDTH, HALF_WIDTH + 1.0)[:, None]
        places = np.array([section.x, section.y]) + offsets * section.left   # boxes of a metre about them hold little else
        rows = [self.index.within(np.minimum(*ends) - thickness, np.maximum(*ends) + thickness) for ends in zip(places[:-1], places[1:])]
        return section.cut(self.points[np.unique(np.concatenate(rows))], thickness)


# The picture of a section: points, and the lines that cross it.

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
SCANLINE, CORNER, FACE = QColor("#e07b00"), QColor("#8e24aa"), QColor("#d0006f")


class SectionView(QWidget):
    """Points of a section by offset and height; the wheel zooms, dragging moves, pointing reads offset and height.

    Signal `clicked` has the offset of a click; `kept`, `dropped` and `undone` are sent for Enter, Esc and Ctrl+Z.
    """

    clicked = pyqtSignal(float)
    kept, dropped, undone = pyqtSignal(), pyqtSignal(), pyqtSignal()

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setMinimumSize(320, 180)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.points, self.crossings, self.scanline, self.corners = np.empty((0, 3)), [], [], []
        self.face: list[tuple[float, float]] = []   # (offset, z) of bottom and top of a face that was found
        self.message = tr("Click on the road in the map.")
        self.centre, self.half = 0.0, 8.0   # m: middle and half of what is shown across
        self.low, self.high = 0.0, 1.0
        self._pressed = self._dragged = None

    def show_section(self, points: np.ndarray, crossings: list[Crossing], message: str = "", scanline: Sequence[np.ndarray] = (),
                     corners: Sequence[tuple[float, float, str]] = ()) -> None:
        """Show (N, 3) offset, z and intensity, the crossings, pieces of the scanline (V, 2) and corners (offset, z, part).

        `message` is shown where there is nothing else.
        """
        self.points, self.crossings, self.message, self.scanline, self.corners = points, crossings, message, list(scanline), list(corners)
        self._fit_heights()
        self.update()

    def show_face(self, ends: Sequence[tuple[float, float]]) -> None:
        """Show (offset, z) of bottom and top of a face; none where there are none."""
        self.face = list(ends)
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
            top = max(heights + [crossing.top for crossing in self._shown() if math.isfinite(crossing.top)])
            self.low, self.high = min(heights) - HEIGHT_BELOW, top + HEIGHT_ABOVE
            boxes = self._label_boxes(self._shown(), self._frame(), QFontMetricsF(self._small(), self))
            # titles of many lines take more rows: they stay above the road
            share = min(max(box.bottom() for box in boxes) / self._frame().height(), MOST_TITLES)
            self.high = max(self.high, (top - share * self.low) / (1.0 - share))
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
        self._draw_corners(painter, CORNER, self.corners)
        painter.setPen(QPen(FACE, 3))
        painter.drawPolyline(QPolygonF([QPointF(*self._at(*end)) for end in self.face]))
        self._draw_corners(painter, FACE, [(*end, part) for end, part in zip(self.face, ("bottom", "top"))])

    def _draw_axes(self, painter, frame):
        painter.setFont(self._small())
        for value in _ticks(self.centre - self.half, self.centre + self.half, frame.width() / 60):
            x, _ = self._at(value, self.low)
            painter.setPen(QPen(QColor("#e2e2e2")))
            painter.drawLine(QPointF(x, frame.top()), QPointF(x, frame.bottom()))
            painter.setPen(INK)
            painter.drawText(QRectF(x - 30, frame.bottom() + 2, 60, 14), int(Qt.AlignmentFlag.AlignHCenter), numbers(f"{value:g}"))
        for value in _ticks(self.low, self.high, frame.height() / 30):
            _, y = self._at(self.centre, value)
            painter.setPen(QPen(QColor("#e2e2e2")))
            painter.drawLine(QPointF(frame.left(), y), QPointF(frame.right(), y))
            painter.setPen(INK)
            painter.drawText(QRectF(0, y - 7, LEFT - 4, 14), int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter),
                             numbers(f"{value:.2f}"))
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

    def _draw_corners(self, painter, colour, corners):
        """Corners of curbs: bottoms as full circles, tops as full triangles."""
        painter.setPen(QPen(PAPER, 1))
        painter.setBrush(colour)
        for offset, z, part in corners:
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
        self._pressed = self._dragged = event.pos()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        pressed, self._pressed, self._dragged = self._pressed, None, None
        if pressed is not None and event.button() == Qt.MouseButton.LeftButton and len(self.points) and \
                (event.pos() - pressed).manhattanLength() < QApplication.startDragDistance():
            self.clicked.emit(self._metres(event.pos().x(), event.pos().y())[0])

    def event(self, event: QEvent) -> bool:
        """While the picture has the focus Enter, Esc and Ctrl+Z are for what is drawn in it, and not for QGIS."""
        if event.type() in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress):
            signal = self.undone if event.matches(QKeySequence.StandardKey.Undo) else \
                {Qt.Key.Key_Return: self.kept, Qt.Key.Key_Enter: self.kept, Qt.Key.Key_Escape: self.dropped}.get(event.key())
            if signal is not None:
                event.accept()
                if event.type() == QEvent.Type.KeyPress:
                    signal.emit()
                return True
        return super().event(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        frame = self._frame()
        if self._dragged is not None:
            self.centre += (event.pos().x() - self._dragged.x()) / frame.width() * 2 * self.half
            move = (event.pos().y() - self._dragged.y()) / frame.height() * (self.high - self.low)
            self.low, self.high, self._dragged = self.low + move, self.high + move, event.pos()
            self.update()
        elif frame.contains(event.pos()) and len(self.points):
            offset, z = self._metres(event.pos().x(), event.pos().y())
            QToolTip.showText(QCursor.pos(), numbers(f"{offset:+.2f} m, {z:.3f} m"), self)


def caption() -> str:
    """What the axes and signs of the picture mean."""
    return tr("left ← offset from the place that was clicked (m) → right; heights in m; orange: scanline; ○ bottom, △ top of a curb")


def _ticks(low, high, most):
    """Round numbers between two limits, about so many at most."""
    step = round_step((high - low) / max(most, 1.0))
    return np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step
