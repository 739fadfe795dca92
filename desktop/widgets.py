"""What the windows are made of, how places and words come into QGIS's own, and what the message bar says."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from weakref import WeakKeyDictionary

from qgis.core import Qgis, QgsApplication, QgsCoordinateReferenceSystem, QgsMapLayer, QgsRectangle, QgsSettings
from qgis.gui import QgsMapCanvas, QgsMapTool, QgsMessageViewer
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QUrl
from qgis.PyQt.QtGui import QDesktopServices
from qgis.PyQt.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFileDialog, QHBoxLayout, QLabel, QLayout, QPushButton, QVBoxLayout, QWidget

from ..processing_provider.dependencies import how_to_install, install_command, missing_in_short
from ..processing_provider.results.road_maps import brought_to
from ..processing_provider.texts import tr

LAST_INPUT, LAST_OUTPUT = "/Processing/LastInputPath", "/Processing/LastOutputPath"  # QGIS's own settings


def button(text: str, what: Callable[[], object] | None = None, tip: str = "") -> QPushButton:
    """A button that calls a function without arguments."""
    push_button = QPushButton(text, toolTip=tip)
    if len(text) == 1:   # an arrow
        push_button.setFixedWidth(34)
    if what is not None:
        push_button.clicked.connect(lambda checked=False: what())
    return push_button


def wrapped(text: str = "") -> QLabel:
    """A text in as many lines as it needs."""
    return QLabel(text, wordWrap=True)


def choices(items: Iterable[tuple[str, object]], changed: Callable[[], object] | None = None) -> QComboBox:
    """A box with (title, value) to choose from."""
    box = QComboBox()
    for title, value in items:
        box.addItem(title, value)
    if changed is not None:
        box.currentIndexChanged.connect(lambda index: changed())
    return box


def row(*widgets: QWidget | None) -> QHBoxLayout:
    """Widgets beside each other; None takes the width that is left, else texts and boxes share it."""
    layout = QHBoxLayout()
    for widget in widgets:
        if widget is None:
            layout.addStretch()
        else:
            layout.addWidget(widget, 0 if None in widgets or isinstance(widget, QPushButton) else 1)
    return layout


def column(whole: QWidget, *things: QWidget | QLayout | tuple[QWidget, int], rim: int | None = None) -> QWidget:
    """A widget filled with things one below the other; one that is given as (thing, 1) takes the height that is left. rim : px about them"""
    layout = QVBoxLayout(whole)
    if rim is not None:
        layout.setContentsMargins(rim, rim, rim, rim)
    for thing in things:
        part, share = thing if isinstance(thing, tuple) else (thing, 0)
        layout.addWidget(part, share) if isinstance(part, QWidget) else layout.addLayout(part, share)
    return whole


def answers(dialog: QDialog, *others: QPushButton) -> QDialogButtonBox:
    """OK, Cancel and other buttons of a dialog."""
    box = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
    box.accepted.connect(dialog.accept)
    box.rejected.connect(dialog.reject)
    for push_button in others:
        box.addButton(push_button, QDialogButtonBox.ButtonRole.ResetRole)
    return box


def folder_for_results(parent: QWidget) -> str:
    """The folder that the user names for all results, "" for none; the next time it is offered."""
    settings = QgsSettings()
    folder = QFileDialog.getExistingDirectory(parent, tr("Folder for all results"), settings.value(LAST_OUTPUT, "") or settings.value(LAST_INPUT, ""))
    if folder:
        settings.setValue(LAST_OUTPUT, folder)
    return folder


def show_extent(canvas: QgsMapCanvas, extent: QgsRectangle, crs: QgsCoordinateReferenceSystem) -> None:
    """Let the map show an extent, where it has a place in the map's CRS."""
    shown = brought_to(extent, crs, canvas.mapSettings().destinationCrs())
    if not shown.isEmpty():
        canvas.setExtent(shown)
        canvas.refresh()


_tools: WeakKeyDictionary[QgsMapCanvas, tuple[QgsMapTool, QgsMapTool | None]] = WeakKeyDictionary()   # of a map: ours, and the one before


def take_map(canvas: QgsMapCanvas, tool: QgsMapTool) -> None:
    """Give the clicks on a map to a tool of ours, until `give_map_back`."""
    active = canvas.mapTool()
    if active is not tool:
        ours, before = _tools.get(canvas, (None, None))
        _tools[canvas] = tool, before if active is ours else active   # what follows another one of ours gives back what that one would
        canvas.setMapTool(tool)


def give_map_back(canvas: QgsMapCanvas, tool: QgsMapTool) -> None:
    """Take up the tool that a map had before one of ours, such as the hand; without any, a map could not even be moved."""
    if canvas.mapTool() is tool:
        canvas.unsetMapTool(tool)
        _, before = _tools.pop(canvas, (None, None))
        if before is not None and not sip.isdeleted(before):
            canvas.setMapTool(before)


def say(iface, text: str, level: Qgis.MessageLevel = Qgis.MessageLevel.Info) -> None:
    """A line in QGIS's message bar."""
    iface.messageBar().pushMessage("Lanewright", text, level=level)


def open_file(iface, path: str) -> None:
    """Show a page in the user's web browser; where none starts, say which file it is."""
    if not QDesktopServices.openUrl(QUrl.fromLocalFile(path)):
        say(iface, tr("No web browser could be started. The report is the file {path}.").format(path=path))


# What the plugin says in QGIS's message bar: which Python packages are missing, and what a run has made.

RIM = 1.05  # of what is shown of a result
LONG = 0    # s that a message with buttons stays: until it is closed


def all_is_there(iface) -> bool:
    """Whether no package is missing; else the message bar says which one, in one short sentence."""
    missing = missing_in_short()
    if not missing:
        return True
    copy = button(tr("Copy command"), lambda: QgsApplication.clipboard().setText(install_command()), install_command())
    how = button(tr("How to install…"), lambda: show_text(iface.mainWindow(), "Lanewright", how_to_install()))
    _say(iface, missing, Qgis.MessageLevel.Warning, copy, how)
    return False


def tell_result(iface, title: str, layers: Sequence[QgsMapLayer], warnings: Sequence[str]) -> None:
    """Which layers a run of an algorithm made: the map goes there where nothing of them is seen, and the run's warnings can be read."""
    extent, canvas = extent_of(layers, iface.mapCanvas().mapSettings().destinationCrs()), iface.mapCanvas()
    buttons = []
    if not extent.isEmpty():
        show = partial(show_extent, canvas, extent.scaled(RIM), canvas.mapSettings().destinationCrs())
        if not canvas.extent().intersects(extent):
            show()
        buttons.append(button(tr("Show it"), show))
    if warnings:
        shown = tr("1 warning…") if len(warnings) == 1 else tr("{count} warnings…").format(count=len(warnings))
        buttons.append(button(shown, lambda: show_text(iface.mainWindow(), title, "\n\n".join(warnings))))
    if buttons:
        level = Qgis.MessageLevel.Warning if warnings else Qgis.MessageLevel.Success
        _say(iface, tr("{title} is done, {count} layers.").format(title=title, count=len(layers)), level, *buttons)


def extent_of(layers: Iterable[QgsMapLayer], crs) -> QgsRectangle:
    whole = QgsRectangle()
    for layer in layers:
        if layer.isSpatial() and not layer.extent().isEmpty():
            whole.combineExtentWith(brought_to(layer.extent(), layer.crs(), crs))
    return whole


def show_text(parent: QWidget, title: str, text: str) -> None:
    """A window of QGIS with a text to read and to copy from."""
    window = QgsMessageViewer(parent)
    window.setTitle(title)
    window.setMessageAsPlainText(text)
    window.showMessage(False)


def _say(iface, text, level, *buttons):
    message = iface.messageBar().createMessage("Lanewright", text)
    for shown in buttons:
        message.layout().addWidget(shown)
    iface.messageBar().pushWidget(message, level, LONG)
