"""What the plugin says in QGIS's message bar: which Python packages are missing, and what a run has made."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from qgis.core import Qgis, QgsApplication, QgsMapLayer, QgsRectangle
from qgis.gui import QgsMessageViewer
from qgis.PyQt.QtWidgets import QWidget

from ..processing_provider.dependencies import how_to_install, install_command, missing_in_short
from ..processing_provider.texts import tr
from .widgets import brought_to, button

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
    """What a run made: the map goes there where nothing of it is seen, and its warnings can be read.

    iface : of QGIS
    title : of the algorithm
    layers : that came into the project
    warnings : of the run, as the log has them
    """
    extent, canvas = extent_of(layers, iface.mapCanvas().mapSettings().destinationCrs()), iface.mapCanvas()
    buttons = []
    if not extent.isEmpty():
        if not canvas.extent().intersects(extent):
            _show(canvas, extent)
        buttons.append(button(tr("Show it"), lambda: _show(canvas, extent)))
    if warnings:
        shown = tr("1 warning…") if len(warnings) == 1 else tr("{count} warnings…").format(count=len(warnings))
        buttons.append(button(shown, lambda: show_text(iface.mainWindow(), title, "\n\n".join(warnings))))
    if buttons:
        level = Qgis.MessageLevel.Warning if warnings else Qgis.MessageLevel.Success
        _say(iface, tr("{title} is done, {count} layers.").format(title=title, count=len(layers)), level, *buttons)


def extent_of(layers: Iterable[QgsMapLayer], crs) -> QgsRectangle:
    """Where layers lie, in a CRS."""
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


def _show(canvas, extent):
    shown = QgsRectangle(extent)
    shown.scale(RIM)
    canvas.setExtent(shown)
    canvas.refresh()


def _say(iface, text, level, *buttons):
    message = iface.messageBar().createMessage("Lanewright", text)
    for shown in buttons:
        message.layout().addWidget(shown)
    iface.messageBar().pushWidget(message, level, LONG)
