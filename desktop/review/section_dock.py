"""A window that shows the points and lines of a section across the road, where the map was clicked or a doubt lies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsPointXY, QgsProject
from qgis.gui import QgsMapToolEmitPoint, QgsRubberBand
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import QDockWidget, QDoubleSpinBox, QFileDialog, QLabel, QWidget

from ...core.road.scanlines.section_planes import slice_lines
from ...core.survey.frame.placement import PlaceIndex
from ...processing_provider.results.road_maps import RoadMap, clouds_lie_in, clouds_of, road_maps
from ...processing_provider.texts import tr
from ..background import with_points
from ..widgets import button, column, give_map_back, row, take_map
from .section import HALF_WIDTH, Section, corners, crossings, middle_of, section_at
from .section_view import SectionView

AROUND = 40.0    # m of road kept in memory either side of a place, so that stepping along it needs no new reading
STEP = 1.0       # m of a step along the road
SHARE = 0.35     # of the window's height; by itself the section takes half of a small one
THICKNESS = 0.3  # m along the road that a section takes points from


class SectionDock(QDockWidget):
    """The window; `show_at` shows a place."""

    def __init__(self, iface):
        super().__init__(tr("Cross-section"), iface.mainWindow(), objectName="LanewrightCrossSection")
        self.iface = iface
        self.view = SectionView()
        self.tool = QgsMapToolEmitPoint(iface.mapCanvas(), canvasClicked=lambda point, button: self.show_at(
            point, iface.mapCanvas().mapSettings().destinationCrs()))
        self.band = None
        self.section = self.road_map = self.task = None
        self._asked: set[str] = set()  # road maps whose user was asked where the point clouds are
        self._kept, self._kept_at = None, None  # points about a place, by where they lie, and the place: (clouds, x, y)
        self.pick = button(tr("Click in the map"), lambda: take_map(iface.mapCanvas(), self.tool))
        back = button("◀", lambda: self.step(-STEP), tr("A metre back along the road"))
        ahead = button("▶", lambda: self.step(STEP), tr("A metre ahead along the road"))
        for arrow in (back, ahead):
            arrow.setFixedWidth(34)
        self.thickness = QDoubleSpinBox(minimum=0.02, maximum=5.0, singleStep=0.05, value=THICKNESS, suffix=" m", toolTip=tr(
            "Length of road from which points are shown"), valueChanged=lambda value: self._draw())
        self.setWidget(column(QWidget(), row(self.pick, back, ahead, QLabel(tr("Thickness")), self.thickness, None), (self.view, 1), rim=4))
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
        self.section = self.road_map = None
        self._hide_line(False)
        self.view.show_section(np.empty((0, 3)), [], tr("Click on the road in the map."))

    # -- where ------------------------------------------------------------------------------------

    def show_at(self, point: QgsPointXY, crs: QgsCoordinateReferenceSystem) -> None:
        """The section through a place of the map."""
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
        """Go on along the road."""
        if self.section is None:
            return
        x, y = self.section.moved(metres)
        turned = section_at(x, y, self.road_map.vectors)
        self._show(turned or Section(x, y, self.section.azimuth), self.road_map)

    def _show(self, section: Section, road_map: RoadMap) -> None:
        self.section, self.road_map = section, road_map
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
        """Read the points about the section in the background."""
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

    def _draw(self, message=""):
        if self.section is None:
            return
        points = self._kept.cut(self.section, self.thickness.value()) if self._kept is not None and not message else np.empty((0, 3))
        layers = self.road_map.vectors
        lines = crossings(self.section, layers)
        middle = middle_of(lines)
        scanline = [line + (middle, 0.0) for line in slice_lines(points[:, 0] - middle, points[:, 1], 2 * HALF_WIDTH)]
        self.view.show_section(points, lines, message or tr("No points lie here."), scanline, corners(self.section, layers))

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
