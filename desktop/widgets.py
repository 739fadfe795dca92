"""What the windows are made of, and how places and words come into QGIS's own."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsProject, QgsRectangle, QgsSettings
from qgis.gui import QgsMapCanvas, QgsMapTool
from qgis.PyQt import sip
from qgis.PyQt.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFileDialog, QHBoxLayout, QLabel, QPushButton, QWidget

from ..processing_provider.texts import tr

LAST_INPUT, LAST_OUTPUT = "/Processing/LastInputPath", "/Processing/LastOutputPath"  # QGIS's own settings


def button(text: str, what: Callable[[], object] | None = None, tip: str = "") -> QPushButton:
    """A button that calls a function without arguments."""
    push_button = QPushButton(text)
    push_button.setToolTip(tip)
    if what is not None:
        push_button.clicked.connect(lambda checked=False: what())
    return push_button


def wrapped(text: str = "") -> QLabel:
    """A text in as many lines as it needs."""
    label = QLabel(text)
    label.setWordWrap(True)
    return label


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


def brought_to(extent: QgsRectangle, source: QgsCoordinateReferenceSystem, target: QgsCoordinateReferenceSystem) -> QgsRectangle:
    """An extent in another CRS; an empty one where it has no place there."""
    try:
        return QgsCoordinateTransform(source, target, QgsProject.instance()).transformBoundingBox(extent)
    except QgsCsException:
        return QgsRectangle()


def show_extent(canvas: QgsMapCanvas, extent: QgsRectangle, crs: QgsCoordinateReferenceSystem) -> None:
    """Let the map show an extent, where it has a place in the map's CRS."""
    shown = brought_to(extent, crs, canvas.mapSettings().destinationCrs())
    if not shown.isEmpty():
        canvas.setExtent(shown)
        canvas.refresh()


def take_map(canvas: QgsMapCanvas, tool: QgsMapTool) -> None:
    """Give the clicks on a map to a tool of ours, until `give_map_back`."""
    before = canvas.mapTool()
    if before is not tool:
        tool.before = getattr(before, "before", before)  # another one of ours gives it back as well
        canvas.setMapTool(tool)


def give_map_back(canvas: QgsMapCanvas, tool: QgsMapTool) -> None:
    """Take up the tool that a map had before one of ours, such as the hand; without any, a map could not even be moved."""
    if canvas.mapTool() is tool:
        canvas.unsetMapTool(tool)
        if tool.before is not None and not sip.isdeleted(tool.before):
            canvas.setMapTool(tool.before)


def say(iface, text: str, level: Qgis.MessageLevel = Qgis.MessageLevel.Info) -> None:
    """A line in QGIS's message bar."""
    iface.messageBar().pushMessage("Lanewright", text, level=level)
