"""A window that goes from one doubtful place of a road map to the next, and keeps what an analyst decides there."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    Qgis,
    QgsCoordinateTransform,
    QgsCsException,
    QgsGeometry,
    QgsProject,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.gui import QgsRubberBand
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QDockWidget,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QMenu,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ...core.common.errors import RoadExtractionError
from ...processing_provider.results.attributes import WORDS
from ...processing_provider.results.road_maps import RoadMap, clouds_of
from ...processing_provider.texts import tr
from .corrections_layer import add_correction, correction_at, corrections_layers, new_corrections_layer, take_back
from .doubtful import Doubt, DoubtfulPiece, doubts_of
from .line_tool import LineTool

LEAST_VIEW = 30.0   # m of ground shown about a place
FILE = "corrections.gpkg"
CHOSEN = "#ff00c8"  # pieces that the buttons are about


class DoubtDock(QDockWidget):
    """The window. `go` leads to another place; begins again when the road map is another or has changed.

    Signal `shown` has the place; `run_wanted` the road map and the layer of corrections.
    """

    shown = pyqtSignal(object)
    run_wanted = pyqtSignal(object, object)

    def __init__(self, iface):
        super().__init__(tr("Doubtful places"), iface.mainWindow())
        self.setObjectName("LanewrightDoubtfulPlaces")
        self.iface = iface
        self.places: list[Doubt] = []
        self.at = -1
        self.road_map: RoadMap | None = None
        self._of = self._pending = None
        self.bands: list[QgsRubberBand] = []
        self.tool = LineTool(iface.mapCanvas())
        self.tool.drawn.connect(self._line_drawn)
        self.tool.given_up.connect(self._stop_drawing)
        self._build()
        # beside the Results Viewer, which opens with the first report: below it the list had room for three lines
        iface.addTabifiedDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, self, [], True)
        self.visibilityChanged.connect(lambda visible: self._highlight() if visible else self._unlight())

    def _build(self):
        self.where = QLabel()
        self.where.setWordWrap(True)
        back, ahead = QPushButton("◀"), QPushButton("▶")
        for button, step, tip in ((back, -1, tr("The place before")), (ahead, 1, tr("The next place"))):
            button.setToolTip(tip)
            button.setFixedWidth(34)
            button.clicked.connect(lambda checked=False, step=step: self.go(self.road_map, step))
        self.list = QListWidget()
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.list.setWordWrap(True)
        self.list.setToolTip(tr("What is doubtful here. The buttons are about what is selected."))
        self.list.itemSelectionChanged.connect(self._selected)
        self.note = QLineEdit()
        self.note.setPlaceholderText(tr("Note, kept with the correction"))
        self.accept_button = self._button(tr("Accept"), tr("It is right as it is"), lambda: self.decide("accept"))
        self.delete_button = self._button(tr("Delete"), tr("There is nothing of that kind here"), lambda: self.decide("delete"))
        self.move_button = self._button(tr("Move…"), tr("Draw where it belongs, within 2 m of where it is"), self.begin_move)
        self.draw_button = self._button(tr("Draw"), tr("Draw what is missing"), lambda: None)
        menu = QMenu(self)
        for target, title in (("edge", tr("Road edge…")), ("marking", tr("Marking line…")), ("lane", tr("Lane, in the direction of travel…"))):
            menu.addAction(title, lambda target=target: self.begin_draw(target))
        self.draw_button.setMenu(menu)
        self.kept = QLabel()
        self.kept.setWordWrap(True)
        self.undo_button = self._button(tr("Take back the last"), tr("Removes the correction that was made last"), self.undo)
        self.run_button = self._button(tr("Make the map again…"), tr("Opens Road map with these corrections"),
                                       lambda: self.run_wanted.emit(self.road_map, self.layer))
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(6, 6, 6, 6)
        column.addLayout(_row(back, ahead, self.where))
        column.addWidget(self.list, 1)
        column.addLayout(_row(self.accept_button, self.delete_button, self.move_button, self.draw_button))
        column.addWidget(self.note)
        column.addWidget(self.kept)
        column.addLayout(_row(self.undo_button, self.run_button))
        self.setWidget(body)

    def _button(self, text, tip, what):
        button = QPushButton(text)
        button.setToolTip(tip)
        button.clicked.connect(lambda checked=False: what())
        return button

    def remove(self) -> None:
        """Take the window out of QGIS."""
        if self.iface.mapCanvas().mapTool() is self.tool:
            self.iface.mapCanvas().unsetMapTool(self.tool)
        self._unlight()
        self.iface.removeDockWidget(self)

    # -- from place to place ----------------------------------------------------------------------

    @property
    def place(self) -> Doubt | None:
        """The place shown last."""
        return self.places[self.at] if 0 <= self.at < len(self.places) else None

    def go(self, road_map: RoadMap | None, step: int = 1) -> None:
        """Show the next place of a road map, or the one before; after the last comes the first."""
        if road_map is None:
            return
        of = [(layer.id(), layer.featureCount()) for layer in road_map.vectors]
        if of != self._of:
            self.places, self.at, self._of, self.road_map = doubts_of(road_map), -1 if step > 0 else 0, of, road_map
        self.show()
        self.raise_()
        if self.places:
            self.at = (self.at + step) % len(self.places)
        self._fill()
        if self.place is not None:
            self._zoom(self.place)
            self.shown.emit(self.place)

    def _fill(self, chosen=0):
        """List the pieces of the place; the buttons are about one of them, until the user selects more."""
        place = self.place
        self.list.clear()
        if place is None:
            self.where.setText(tr("Nothing in this road map is doubtful: all of it was measured."))
        else:
            self.where.setText(tr("<b>Place {at} of {count}</b>, road {road}, station {station:.0f} m").format(
                at=self.at + 1, count=len(self.places), road=place.road, station=place.station))
            for piece in place.pieces:
                self.list.addItem(piece.text + self._decision(piece))
            self.list.setCurrentRow(chosen)
        self._selected()
        self._tell()

    def _decision(self, piece):
        """What was decided about a piece and not yet run, for its line in the list."""
        found = None if self.layer is None else correction_at(self.layer, piece.line, self.place.crs, piece.target)
        return "" if found is None else f"\n  → {WORDS['action'].get(found['action'], found['action'])}"

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

    # -- what is selected -------------------------------------------------------------------------

    @property
    def chosen(self) -> list[DoubtfulPiece]:
        """The pieces that the buttons are about."""
        place = self.place
        return [] if place is None else [place.pieces[index.row()] for index in self.list.selectedIndexes()]

    def _selected(self):
        count = len(self.chosen)
        self.accept_button.setEnabled(count > 0)
        self.delete_button.setEnabled(count > 0)
        self.move_button.setEnabled(count == 1)
        self.draw_button.setEnabled(self.road_map is not None)
        self._highlight()

    def _highlight(self):
        self._unlight()
        for piece in self.chosen if self.isVisible() else ():
            band = QgsRubberBand(self.iface.mapCanvas(), Qgis.GeometryType.Line)
            colour = QColor(CHOSEN)
            colour.setAlpha(110)
            band.setColor(colour)
            band.setWidth(7)
            band.setToGeometry(piece.line, self.place.crs)
            self.bands.append(band)

    def _unlight(self):
        for band in self.bands:
            self.iface.mapCanvas().scene().removeItem(band)
        self.bands = []

    # -- corrections --------------------------------------------------------------------------------

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer that corrections go to, None before the first."""
        return next(iter(corrections_layers(QgsProject.instance())), None)

    def ask_for_file(self) -> str:
        """Where the corrections are to be kept; "" where the user gave up."""
        clouds = [] if self.road_map is None else clouds_of(self.road_map, QgsProject.instance())[0]
        folder = Path(QgsProject.instance().absolutePath() or (Path(clouds[0]).parent if clouds else Path.home()))
        path, _ = QFileDialog.getSaveFileName(self, tr("File for the corrections"), str(folder / FILE), "GeoPackage (*.gpkg)",
                                              options=QFileDialog.Option.DontConfirmOverwrite)
        return path if not path or path.lower().endswith(".gpkg") else f"{path}.gpkg"

    def _layer_to_write(self, crs):
        layer = self.layer
        if layer is not None:
            return layer
        path = self.ask_for_file()
        if not path:
            return None
        try:
            return new_corrections_layer(QgsProject.instance(), path, crs)
        except RoadExtractionError as problem:
            self.iface.messageBar().pushMessage("Lanewright", str(problem), level=Qgis.MessageLevel.Warning)
            return None

    def decide(self, action: str) -> None:
        """Accept or delete what is selected, and go on to the next piece that is not decided, here or at the next place."""
        pieces, place = self.chosen, self.place
        layer = self._layer_to_write(place.crs) if pieces else None
        if layer is None:
            return
        for piece in pieces:
            add_correction(layer, piece.line, place.crs, action=action, target=piece.target, road=piece.road, station_m=piece.station,
                           offset_m=piece.offset, note=self.note.text() or None)
        self.note.clear()
        last = max(place.pieces.index(piece) for piece in pieces)
        count = len(place.pieces)
        left = [row % count for row in range(last + 1, last + 1 + count) if not self._decision(place.pieces[row % count])]
        self._fill(left[0] if left else last)
        if not left and len(self.places) > 1:
            self.go(self.road_map)

    def begin_draw(self, target: str) -> None:
        """Let the user draw what is missing."""
        self._begin("draw", target)

    def begin_move(self) -> None:
        """Let the user draw where the selected piece belongs."""
        self._begin("move", self.chosen[0].target)

    def _begin(self, action, target):
        self._pending = action, target
        self.iface.mapCanvas().setMapTool(self.tool)
        bar = self.iface.messageBar()
        bar.clearWidgets()
        bar.pushMessage("Lanewright", tr("Click along the line where it belongs. The right button ends it, Backspace takes a click back, Esc stops."),
                        level=Qgis.MessageLevel.Info, duration=0)

    def _line_drawn(self, line: QgsGeometry) -> None:
        action, target = self._pending or ("", "")
        layer = self._layer_to_write(self.road_map.vectors[0].crs()) if action else None
        if layer is not None:
            add_correction(layer, line, self.iface.mapCanvas().mapSettings().destinationCrs(), action=action, target=target,
                           note=self.note.text() or None)
            self.note.clear()
        self._stop_drawing()
        self._fill()

    def _stop_drawing(self):
        self._pending = None
        self.iface.messageBar().clearWidgets()
        self.iface.mapCanvas().unsetMapTool(self.tool)

    def undo(self) -> None:
        """Take back the correction that was made last."""
        if self.layer is not None and take_back(self.layer):
            self._fill()

    def _tell(self):
        """How many corrections there are, and what to do with them."""
        layer = self.layer
        count = 0 if layer is None else layer.featureCount()
        self.undo_button.setEnabled(count > 0)
        self.run_button.setEnabled(count > 0)
        self.kept.setText(tr("No corrections yet.") if not count else
                          tr("{count} corrections in {file}. They come into the map when it is made again.").format(
                              count=count, file=Path(layer.source().split("|")[0]).name))


def _row(*widgets):
    row = QHBoxLayout()
    for widget in widgets:
        row.addWidget(widget, 1 if isinstance(widget, (QLabel, QLineEdit)) else 0)
    return row
