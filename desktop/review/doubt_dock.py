"""A window that goes from one doubtful place of a road map to the next, and keeps what an analyst decides there."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from textwrap import shorten

from qgis import utils
from qgis.core import Qgis, QgsFeature, QgsGeometry, QgsPointXY, QgsProject, QgsSettings, QgsTask, QgsVectorLayer
from qgis.gui import QgsMapCanvas, QgsMapMouseEvent, QgsMapTool, QgsMapToolEmitPoint, QgsRubberBand
from qgis.PyQt.QtCore import Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QAction, QColor, QKeyEvent, QKeySequence
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QDockWidget,
    QDoubleSpinBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QMenu,
    QMessageBox,
    QTabWidget,
    QWidget,
)

from ...core.common.errors import RoadExtractionError
from ...core.corrections.corrections import SEEN, taken_reading
from ...processing_provider.results.road_maps import RoadMap, Setting, road_maps
from ...processing_provider.styling import WORDS
from ...processing_provider.texts import tr
from ...products.report.review import review_report
from ..widgets import button, choices, column, give_map_back, open_file, row, say, show_extent, take_map, wrapped
from .corrections_layer import (
    add_correction,
    ask_for_corrections,
    ask_for_file,
    corrections_of,
    layer_of,
    layer_to_write,
    note_change,
    note_written,
    place_of,
    review_of,
    take_back,
    written_here,
)
from .doubtful import Doubt, DoubtfulPiece, doubts_of
from .photos import PhotoButton, photo_of
from .remaking import Remaking
from .smart_pick import evidence, pick, prepare, snap
from .steps import STALE, StepsPanel, steps_of

ARRIVED = 700   # ms after the last layer of a run that came into the project
LONG_PLACE = 80.0   # m: of a longer place the map shows the selected piece alone, or it would be too small to judge
MOST_LETTERS = 200   # of what is doubtful in the list; pointing at it shows all of it
LEAST_VIEW = 30.0   # m of ground shown about a place
CHOSEN = "#6eff00c8"  # pieces that the buttons are about
AT_ONCE = Setting("made_at_once")
KIND, LENGTH = "lanewright/doubts/kind", "lanewright/doubts/shortest"   # settings: what is gone through


class DoubtDock(QDockWidget):
    """The window. `go` leads to another place; begins again when the road map is another or has changed.

    Signal `shown` has the place. Where the map is made again while the window is open, it goes on in the new one, which `made_again` has.
    """

    shown = pyqtSignal(object)
    made_again = pyqtSignal(object)

    def __init__(self, iface):
        super().__init__(tr("Doubtful places"), iface.mainWindow(), objectName="LanewrightDoubtfulPlaces")
        self.iface = iface
        self.places: list[Doubt] = []
        self.made: dict[int, QgsFeature] = {}   # id of a piece: the correction that was made of it and not yet run
        self.ours: set[int] = set()   # numbers of the corrections that were written here
        self.at = -1
        self.seen: Doubt | None = None   # what map and section show
        self.road_map: RoadMap | None = None
        self.left: tuple[str | None, Doubt | None] = None, None   # survey and place of the road map whose layers went last
        self._of = self._pending = None
        self.looks: list[QgsTask] = []  # under way; QGIS keeps no reference
        self.reading: QgsTask | None = None   # what clicks will need
        self.bands: list[QgsRubberBand] = []
        self.tool = LineTool(iface.mapCanvas())
        self.tool.drawn.connect(self._line_drawn)
        self.pick_tool = QgsMapToolEmitPoint(iface.mapCanvas(), canvasClicked=lambda point, button: self.pick_at(point))
        self._build()
        iface.addTabifiedDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, self, [], True)
        self.visibilityChanged.connect(lambda visible: self._highlight() if visible else self._unlight())
        QgsProject.instance().layersWillBeRemoved.connect(self._forget)
        self.arrived: set[str] = set()   # layers that came into the project; a run adds them one by one, and says what they are after that
        self.settled = QTimer(self, singleShot=True, interval=ARRIVED, timeout=self._follow)
        QgsProject.instance().layersAdded.connect(self._note_layers)

    def _build(self):
        self.where = wrapped()
        back = self._button("◀", tr("The place before"), lambda: self.go(self.road_map, -1), "P")
        ahead = self._button("▶", tr("The next place"), lambda: self.go(self.road_map), "N")
        self.kinds = choices(((tr("Everything"), ""), (tr("Road edges"), "edge"), (tr("Road surface"), "surface"), (tr("Marking lines"), "marking"),
                              (tr("Lanes"), "lane"), (tr("Warnings"), "warning")), self._begin_again)
        self.order = choices(((tr("The most doubtful first"), True), (tr("Along the road"), False)), self._begin_again)
        settings = QgsSettings()
        self.kinds.setCurrentIndex(max(self.kinds.findData(settings.value(KIND, "")), 0))
        self.shortest = QDoubleSpinBox(prefix=tr("At least "), suffix=" m", decimals=0, maximum=999.0, value=settings.value(LENGTH, 0.0, type=float),
                                       keyboardTracking=False, toolTip=tr("Shorter pieces are passed over, but not warnings and ends of lanes"))
        self.shortest.valueChanged.connect(lambda metres: self._begin_again())
        self.undecided = QCheckBox(tr("Only what is not done"))
        self.list = QListWidget(
            wordWrap=True, selectionMode=QAbstractItemView.SelectionMode.ExtendedSelection, itemSelectionChanged=self._selected,
            toolTip=tr("What is doubtful here. The buttons are about what is selected."), itemClicked=lambda item: self._look_at())
        self.photo = PhotoButton()
        self.note = QLineEdit(placeholderText=tr("Note, kept with the correction"))
        self.accept_button = self._button(tr("Accept"), tr("It is right as it is"), lambda: self.decide("accept"), "A")
        self.delete_button = self._button(tr("Delete"), tr("There is nothing of that kind here"), lambda: self.decide("delete"), "D")
        self.move_button = self._button(tr("Move…"), tr("Draw where it belongs, within 2 m of where it is"),
                                        lambda: self.begin("move", self.chosen[0].target, self.chosen[0]), "M")
        self.other_button = self._button(tr("Other reading"), tr("Take the second reading of the program, which is almost as likely"),
                                         lambda: self.decide("take"), "O")
        self.pick_button = self._button(tr("Find…"), tr("Click near a curb or painted line that is missing: it is found in the points"),
                                        self.begin_pick, "F")
        self.draw_button = self._button(tr("Draw"), tr("Draw what is missing"), lambda: None)
        menu = QMenu(self)
        for target, title in (("edge", tr("Road edge…")), ("marking", tr("Marking line…")), ("lane", tr("Lane, in the direction of travel…"))):
            menu.addAction(title, lambda target=target: self.begin("draw", target))
        self.draw_button.setMenu(menu)
        # short: the widest row takes its width from the map
        self.snap = QCheckBox(tr("Snap to curb and paint"), toolTip=tr("Lay drawn lines onto curbs and paint"), checked=True)
        # in the message bar it would lie on the map, and clicks on it would be lost
        self.hint = QLabel(wordWrap=True, styleSheet="background: #fff3c4; color: #222222; padding: 4px", visible=False)
        self.kept = wrapped()
        self.undo_button = self._button(tr("Take back the last"), tr("Removes the correction that was made last"), self.undo)
        self.vertex_button = self._button(tr("Vertices"), tr("Drag the vertices of corrections with QGIS's tool; once more keeps them"),
                                          self.drag_vertices, "V")
        self.run_button = self._button(tr("Make again"), tr("Makes the map again with the corrections, while you go on"), self.make_again, "R")
        self.at_once = QCheckBox(tr("At once"), toolTip=tr("After every correction"), checked=AT_ONCE.holds(), toggled=AT_ONCE.keep)
        self.remaking = Remaking(self.iface)
        self.report_button = self._button(tr("Report…"), tr("A page with what was decided, by kind and by person, and what is left"),
                                          self.write_report)
        body = column(QWidget(), row(back, ahead, self.where), row(self.kinds, self.order), row(self.undecided, self.shortest), (self.list, 1),
                      self.photo, row(self.accept_button, self.delete_button, self.move_button, self.other_button),
                      row(self.pick_button, self.draw_button, self.snap), self.note, self.hint, row(self.kept, self.report_button),
                      row(self.undo_button, self.vertex_button, self.run_button, self.at_once), self.remaking)
        self.steps = StepsPanel()
        self.tabs = QTabWidget(documentMode=True)
        self.tabs.addTab(body, tr("Doubtful places"))
        self.tabs.addTab(self.steps, tr("Steps"))
        self.tabs.currentChanged.connect(lambda tab: self._tell())
        self.setWidget(self.tabs)

    def _button(self, text, tip, what, key=""):
        """A button; `key` presses it while the window has the focus."""
        push_button = button(text, what, f"{tip} ({key})" if key else tip)
        if key:
            self.addAction(QAction(tip, self, shortcut=QKeySequence(key), shortcutContext=Qt.ShortcutContext.WidgetWithChildrenShortcut,
                                   triggered=lambda checked=False: push_button.click()))
        return push_button

    def remove(self) -> None:
        """Take the window out of QGIS."""
        QgsProject.instance().layersWillBeRemoved.disconnect(self._forget)
        QgsProject.instance().layersAdded.disconnect(self._note_layers)
        self.settled.stop()
        self._stop_drawing()
        self._unlight()
        self._stop_looking()
        self.remaking.forget()
        self.iface.removeDockWidget(self)

    def _forget(self, removed):
        """Forget a road map of which layers leave the project: nothing of them can be shown or corrected any more."""
        if self.road_map is not None and self.road_map.has_any(removed):
            self._stop_drawing()
            self._stop_looking()
            self.left = self.road_map.survey, self.place   # the same survey, made again in the place of the old layers
            self.road_map, self._of, self.places, self.at = None, None, [], -1
            self.photo.show_photo(None)
            self._fill()
            self.where.clear()

    def _note_layers(self, layers):
        self.arrived |= {layer.id() for layer in layers}
        self.settled.start()

    def _follow(self):
        """Go on in the map that has just been made again of the same survey, where a run or a stage has added layers of it."""
        arrived, self.arrived = self.arrived, set()
        survey, place = self.left if self.road_map is None else (self.road_map.survey, self.place)
        newer = next((one for one in road_maps(QgsProject.instance()) if one.survey == survey and one.has_any(arrived)), None)
        if newer is not None:
            self._of = None
            self._take(newer)
            if place is not None and self.places:
                self.at = min(range(len(self.places)), key=lambda at: self.places[at].middle.distance(place.middle))
                self.seen = self.place
            self.made_again.emit(newer)
            self._fill()
            if not self.isHidden():
                self._come_to_front()

    def _come_to_front(self):
        """Be shown, before the Results Viewer, which opens with the first report: below it the list has room for three lines."""
        self.show()
        main, results = self.iface.mainWindow(), getattr(utils.plugins.get("processing"), "resultsDock", None)
        if results is not None and results.isVisible() and results not in main.tabifiedDockWidgets(self) \
                and main.dockWidgetArea(results) == main.dockWidgetArea(self) and not self.isFloating() and not results.isFloating():
            main.tabifyDockWidget(results, self)
        self.raise_()

    def show_steps(self, road_map: RoadMap) -> None:
        self._take(road_map)
        self._fill()
        self.tabs.setCurrentWidget(self.steps)
        self._come_to_front()

    def _take(self, road_map):
        """Be about a road map; from the first place, where it is another one or has changed."""
        counts = [(layer.id(), layer.featureCount()) for layer in road_map.vectors]
        if counts != self._of:
            self._of, self.road_map = counts, road_map
            for layer in road_map.layers:   # a run that writes a layer in its place says so in its metadata
                layer.metadataChanged.connect(partial(self._note_layers, [layer]))
            self._list_places()

    # -- from place to place ----------------------------------------------------------------------

    @property
    def place(self) -> Doubt | None:
        """The place shown last."""
        return self.places[self.at] if 0 <= self.at < len(self.places) else None

    def go(self, road_map: RoadMap | None, step: int = 1) -> None:
        """Show the next place of a road map, or the one before; after the last comes the first."""
        if road_map is None:
            return
        self._take(road_map)
        self.tabs.setCurrentIndex(0)
        self._come_to_front()
        for _ in self.places:
            self.at = (self.at + step) % len(self.places) if self.at >= 0 else 0 if step > 0 else len(self.places) - 1
            if not self.undecided.isChecked() or not self._is_done(self.place):
                break
        if self._pending is not None and self._pending[2] is not None and not self.tool.vertices:
            self._stop_drawing()  # a piece of the place before was to be moved
        self._fill()
        self.list.setFocus()  # for the keys
        self._look_at(again=True)

    def _list_places(self):
        kind, shortest = self.kinds.currentData(), self.shortest.value()
        QgsSettings().setValue(KIND, kind)
        QgsSettings().setValue(LENGTH, shortest)
        doubts = doubts_of(self.road_map, [kind] if kind else [], shortest)
        self.places, self.at = sorted(doubts, key=lambda place: -place.doubt) if self.order.currentData() else doubts, -1
        self._note_decisions()

    def _begin_again(self):
        """The first place of another choice or order."""
        if self.road_map is not None:
            self._list_places()
            self.go(self.road_map)

    def _fill(self, chosen=0):
        """List the pieces of the place; the buttons are about one of them, until the user selects more."""
        place = self.place
        self._note_decisions()
        self.list.clear()
        if place is None and self.places:
            self.where.setText(tr("<b>{name}</b>: {count} places. ▶ goes to the first.").format(name=self.road_map.name, count=len(self.places)))
        elif place is None:
            self.where.setText(tr("Nothing of this is doubtful in the road map: all of it was measured."))
        else:
            self.where.setText(tr("<b>Place {at} of {count}</b>, {done} done; road {road}, station {station:.0f} m").format(
                at=self.at + 1, count=len(self.places), done=sum(map(self._is_done, self.places)), road=place.road, station=place.station))
            for piece in place.pieces:
                decision = self._decision(piece)
                text = shorten(piece.text, MOST_LETTERS, placeholder=" …")   # a warning of ten lines would hide the other pieces
                item = QListWidgetItem(f"{text}\n  → {decision}" if decision else text)
                item.setToolTip(piece.text)
                self.list.addItem(item)
            self.list.setCurrentRow(chosen)
        self._selected()
        self._tell()

    def _is_done(self, place):
        return all(self._decision(piece) for piece in place.pieces)

    def _note_decisions(self):
        """Look up what was decided, of all places at once: the corrections are many, and so are the pieces."""
        pieces = [piece for place in self.places for piece in place.pieces]
        made = corrections_of(self.layer, pieces, self.places[0].crs) if pieces else {}
        self.made, self.ours = {id(pieces[number]): row for number, row in made.items()}, set(written_here(self.layer)) if made else set()

    def _decision(self, piece):
        """What was decided about a piece and not yet run, by whom where that was a colleague; "" for nothing."""
        row = self.made.get(id(piece))
        if row is None:
            return ""
        text, author = str(WORDS["action"].get(row["action"], row["action"])), row.attributeMap().get("author") or ""
        return text if row.id() in self.ours or not author else f"{text} ({author})"

    def _may_replace(self, pieces):
        """Whether the decisions about pieces are those that the list shows; where a colleague has made others since, the user says what holds."""
        shown = {id(piece): self.made.get(id(piece)) for piece in pieces}
        self._note_decisions()
        changed = [f"{shorten(piece.text, MOST_LETTERS)}\n  → {self._decision(piece) or tr('taken back')}"
                   for piece in pieces if self.made.get(id(piece)) != shown[id(piece)]]
        return not changed or self.ask(tr("This was decided otherwise meanwhile:\n\n{changes}\n\nShall your decision take its place?").format(
            changes="\n".join(changed)))

    def ask(self, question: str) -> bool:
        """The user's yes or no."""
        return QMessageBox.question(self, tr("Doubtful places"), question) == QMessageBox.StandardButton.Yes

    def _look_at(self, again=False):
        """Let map, section and photo show the place; of a long one, the piece that is selected."""
        place, seen = self.place, self.seen
        self.seen = place
        if place is not None and len(self.chosen) == 1 and max(place.extent.width(), place.extent.height()) > LONG_PLACE:
            line = self.chosen[0].line
            self.seen = place if line.isEmpty() else replace(place, extent=line.boundingBox(), middle=line.interpolate(line.length() / 2).asPoint())
        if self.seen is None or self.seen == seen and not again:
            return
        self.photo.show_photo(photo_of(QgsProject.instance(), self.seen.middle, place.crs))
        longer = max(self.seen.extent.width(), self.seen.extent.height())
        show_extent(self.iface.mapCanvas(), self.seen.extent.buffered(max(0.15 * longer, (LEAST_VIEW - longer) / 2)), place.crs)
        self.shown.emit(self.seen)

    # -- what is selected -------------------------------------------------------------------------

    @property
    def chosen(self) -> list[DoubtfulPiece]:
        """The pieces that the buttons are about."""
        place = self.place
        return [] if place is None else [place.pieces[index.row()] for index in self.list.selectedIndexes()]

    def _selected(self):
        count, correctable = len(self.chosen), all(piece.target for piece in self.chosen)
        self.accept_button.setEnabled(count > 0)
        self.delete_button.setEnabled(count > 0 and correctable)
        self.move_button.setEnabled(count == 1 and correctable)
        self.other_button.setEnabled(count == 1 and taken_reading({"other": self.chosen[0].other}, self.chosen[0].target) is not None)
        for missing_button in (self.pick_button, self.draw_button):
            missing_button.setEnabled(self.road_map is not None)
        self._highlight()

    def _highlight(self):
        self._unlight()
        for piece in self.chosen if self.isVisible() else ():
            band = QgsRubberBand(self.iface.mapCanvas(), Qgis.GeometryType.Line)
            band.setColor(QColor(CHOSEN))
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
        """The layer that corrections of this survey go to, None before the first."""
        return layer_of(self.road_map)

    def ask_for_file(self) -> str:
        """Where the corrections are to be kept; "" where the user gave up."""
        return ask_for_corrections(self, self.road_map)

    def _layer_to_write(self):
        return layer_to_write(self.iface, self.road_map, self.ask_for_file)

    def decide(self, action: str) -> None:
        """Accept or delete what is selected or take its other reading, and go on to the next piece that is not decided, here or at the next place."""
        pieces, place = self.chosen, self.place
        if not pieces or (layer := self._layer_to_write()) is None:
            return
        if not self._may_replace(pieces):
            self._fill(max(self.list.currentRow(), 0))
            return
        for piece in pieces:
            reading = taken_reading({"other": piece.other}, piece.target) or {} if action == "take" else {}
            self._write(layer, piece.line, place.crs, self.made.get(id(piece)), **{
                "action": action if piece.target else SEEN, "target": piece.target or piece.kind, "road": piece.road, "station_m": piece.station,
                "offset_m": piece.offset, "note": self.note.text() or None, **reading})
        self.note.clear()
        self.corrected()
        self._go_on(max(place.pieces.index(piece) for piece in pieces))

    def _write(self, *row, **values):
        try:
            add_correction(*row, **values)
        except RoadExtractionError as problem:
            say(self.iface, str(problem), Qgis.MessageLevel.Critical)

    def _go_on(self, last):
        """To the next piece that is not decided, after the row that was decided last, here or at the next place."""
        place, count = self.place, len(self.place.pieces)
        self._note_decisions()
        left = [row % count for row in range(last + 1, last + 1 + count) if not self._decision(place.pieces[row % count])]
        self._fill(left[0] if left else last)
        self._look_at()
        if not left and len(self.places) > 1:
            self.go(self.road_map)

    def begin(self, action: str, target: str, piece: DoubtfulPiece | None = None) -> None:
        """Let the user draw what is missing, or where a piece belongs; what was begun for the same is gone on with.

        The file comes first: who names none has drawn nothing that could be lost.
        """
        if self._layer_to_write() is None:
            return
        if self._pending != (action, target, piece):
            self.tool.clear()
        self._pending = action, target, piece
        take_map(self.iface.mapCanvas(), self.tool)
        self.iface.mapCanvas().setFocus()  # for Backspace and Esc
        self._hint("")

    def _hint(self, text):
        self._say(" ".join(filter(None, (text, tr(
            "Click along the line where it belongs. The right button ends it, Backspace takes a click back, Esc stops.")))))

    def _line_drawn(self, vertices: list[QgsPointXY]) -> None:
        if len(vertices) == 1:
            self._hint(tr("A line takes two clicks at least."))
            return
        action, target, piece = self._pending or ("", "", None)
        line, crs = QgsGeometry.fromPolylineXY(vertices), self.iface.mapCanvas().mapSettings().destinationCrs()
        self._stop_drawing()
        keep = partial(self._keep, action, target, piece)
        if not action:
            self._fill(max(self.list.currentRow(), 0))
        elif vertices and (target == "lane" or not self.snap.isChecked() or
                           not self._look(lambda ready: snap(self.road_map, line, crs, target, ready), keep)):
            keep(line, crs)

    def _keep(self, action, target, piece, line, crs, seen=None):
        """Write what was drawn, moved or found, and go on."""
        layer = self._layer_to_write()
        if layer is not None and self._may_replace([] if piece is None else [piece]):
            location = {} if piece is None else dict(road=piece.road, station_m=piece.station, offset_m=piece.offset)
            measured = {} if seen is None else {"height_m": round(seen.step, 3)} if target == "edge" else \
                {"pattern": "dashed" if seen.dashed else "solid"} if action == "draw" else {}
            self._write(layer, line, crs, self.made.get(id(piece)), action=action, target=target,
                           note=self.note.text() or (evidence(seen) if seen is not None else None), **location, **measured)
            self.note.clear()
            self.corrected()
            if piece is not None and self.place is not None and piece in self.place.pieces:
                self._go_on(self.place.pieces.index(piece))
                return
        self._fill(max(self.list.currentRow(), 0))

    # -- what the points show ---------------------------------------------------------------------

    def begin_pick(self) -> None:
        """Wait for clicks near what is missing; what they need is read meanwhile."""
        if self._layer_to_write() is not None:
            canvas = self.iface.mapCanvas()
            take_map(canvas, self.pick_tool)
            self.reading = prepare(self.road_map, canvas.center(), canvas.mapSettings().destinationCrs())
            self._say(tr("Click near a curb or a painted line that the map lacks."))

    def pick_at(self, point: QgsPointXY) -> None:
        """Find the curb or painted line at a click and add it as a correction."""
        crs = self.iface.mapCanvas().mapSettings().destinationCrs()
        if not self._look(lambda ready: pick(self.road_map, self.layer, point, crs, ready),
                          lambda line, crs, seen: self._keep("draw", seen.target, None, line, crs, seen)):
            self._say(tr("The point clouds of this road map are not there: draw the line by hand."))

    def _look(self, begin, keep):
        """Begin a look at the points; False where they are not there. `keep` gets the line, its CRS and what was seen, None where a line stays."""
        road_map, crs = self.road_map, self.road_map.vectors[0].crs()

        def ready(task, seen, line, problem):
            if task not in self.looks:
                return
            self.looks.remove(task)
            if self.road_map is not None and self.road_map.layers == road_map.layers and not line.isEmpty():
                keep(line, crs, seen)
            self._say(problem or evidence(seen) + tr(". It is added as a correction; Take back the last removes it."))

        task = begin(ready)
        if task is None:
            return False
        self.looks.append(task)
        self._say(tr("Looking at the points…"))
        return True

    def _stop_looking(self):
        for task in self.looks:
            task.cancel()
        self.looks = []
        give_map_back(self.iface.mapCanvas(), self.pick_tool)

    def _say(self, text):
        self.hint.setText(text)
        self.hint.show()

    def _stop_drawing(self):
        self._pending = None
        self.hint.hide()
        self.tool.clear()
        give_map_back(self.iface.mapCanvas(), self.tool)
        self.list.setFocus()  # for the keys

    def undo(self) -> None:
        """Take back the correction that was made last."""
        if self.layer is not None and take_back(self.layer):
            self.corrected()

    def drag_vertices(self) -> None:
        """Take up QGIS's vertex tool on the corrections; where it is taken up already, keep what was dragged."""
        layer = self.layer
        if layer.isEditable():
            if not layer.commitChanges():   # the vertices can still be dragged and kept
                say(self.iface, tr("The correction was not kept in {place}: {problem}").format(
                    place=place_of(layer), problem="; ".join(layer.commitErrors())), Qgis.MessageLevel.Critical)
                return
            self.hint.hide()
            self.iface.actionPan().trigger()
            self.corrected()
            return
        layer.committedGeometriesChanges.connect(lambda name, moved: [note_change(layer, layer.getFeature(row), line) for row, line in moved.items()])
        layer.committedFeaturesAdded.connect(lambda name, rows: note_written(layer, rows))   # what is saved has other numbers
        self.iface.setActiveLayer(layer)
        layer.startEditing()
        self.iface.actionVertexToolActiveLayer().trigger()
        self._say(tr("Click a vertex and click where it belongs; Ctrl+Z takes it back. V keeps what was dragged."))

    def make_again(self) -> None:
        """Make the map again with its corrections, in the background."""
        if self.layer is not None:
            self.remaking.ask(self.road_map, self.layer)

    def corrected(self) -> None:
        """List what was corrected, and make it on wish."""
        self._fill(max(self.list.currentRow(), 0))
        if self.at_once.isChecked():
            self.make_again()

    def write_report(self) -> None:
        """What was decided and what is left, as a page in the file that the user names, shown in the browser."""
        path = ask_for_file(self, self.road_map, tr("Report of the review"), f"{tr('Review')} {self.road_map.survey}.html", "HTML (*.html)")
        if path:
            pieces = [piece for place in doubts_of(self.road_map) for piece in place.pieces]
            page = review_report(self.road_map.survey, "" if self.layer is None else place_of(self.layer), *review_of(
                self.layer, pieces, self.road_map.vectors[0].crs()))
            try:
                Path(path).write_text(page, encoding="utf-8")
            except OSError as problem:
                say(self.iface, tr("{path} cannot be written: {reason}. Close the program that holds it, or choose another file.",
                                   path=path, reason=problem.strerror), Qgis.MessageLevel.Critical)
            else:
                open_file(self.iface, path)

    def _tell(self):
        """How many corrections there are, and what to do with them."""
        if self.tabs.currentWidget() is self.steps:
            self.steps.show_map(self.road_map, self.layer)
        count = 0 if (layer := self.layer) is None else len(layer.allFeatureIds())   # asked of the database: a colleague adds to it
        self.undo_button.setEnabled(count > 0 and bool(written_here(layer)))
        self.vertex_button.setEnabled(count > 0)
        self.report_button.setEnabled(self.road_map is not None)
        self.run_button.setEnabled(layer is not None)
        waits = count and any(step.colour == STALE for step in steps_of(self.road_map, layer))
        text = tr("No corrections yet.") if not count else tr("Corrections in {file}: {count}. They come into the map when it is made again.") \
            if waits else tr("Corrections in {file}: {count}. They are in this map.")
        self.kept.setText(text.format(count=count, file="" if layer is None else place_of(layer)))


# A map tool that draws one line.

COLOUR = "#2166ac"


class LineTool(QgsMapTool):
    """Left button: a vertex, snapped as the project says. Right button: the line is ready. Backspace: one vertex back. Esc: none.

    `drawn` has the vertices in the CRS of the map, none where the user gave up; of one alone drawing goes on. What was drawn stays while another
    tool, such as the hand, is used.
    """

    drawn = pyqtSignal(list)

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
            self.finish()

    def add(self, point: QgsPointXY) -> None:
        self.vertices.append(point)
        self._show(self.vertices)

    def finish(self) -> None:
        """Hand the vertices over."""
        self.drawn.emit(self.vertices)

    def clear(self) -> None:
        self.vertices = []
        self.band.reset(Qgis.GeometryType.Line)

    def _show(self, vertices):
        self.band.setToGeometry(QgsGeometry.fromPolylineXY(vertices), None)
