"""What the scripts that drive a QGIS window share: waiting, pictures, and saying how far they are."""

import os
from pathlib import Path

from palette import with_palette
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer
from qgis.utils import iface, plugins

PICTURES = Path(os.environ["LANEWRIGHT_PICTURES"])
SAID = Path(os.environ["LANEWRIGHT_SAID"])


def say(text):
    with open(SAID, "a", encoding="utf-8") as file:
        file.write(text + "\n")


def wait(seconds, until=lambda: False):
    """Let the window live for so long, or until something is so; whether it was."""
    clock = QElapsedTimer()
    clock.start()
    while clock.elapsed() < 1000 * seconds:
        QCoreApplication.processEvents()
        if until():
            return True
    return until()


def settle(busy, seconds=240, calm=2):
    """Wait until nothing is being drawn any more, and nothing was for a while: layers, tiles and docks each ask for another drawing."""
    clock, since = QElapsedTimer(), QElapsedTimer()
    clock.start()
    since.start()
    while since.elapsed() < 1000 * calm:
        QCoreApplication.processEvents()
        if busy():
            since.restart()
        needed(clock.elapsed() < 1000 * seconds, f"drawing took longer than {seconds} s")


def keep(widget, name):
    wait(0.7)
    if widget is iface.mainWindow():
        settle(iface.mapCanvas().isDrawing)
    save(widget.grab(), name)


def save(picture, name):
    assert not picture.isNull(), name
    needed(with_palette(picture.toImage()).save(str(PICTURES / f"{name}.png"), quality=0), f"{name}.png was not written")  # 0: as small as it gets
    say(f"{name}.png {picture.width()} x {picture.height()}")


def needed(condition, what):
    if not condition:
        raise AssertionError(what)


def action_of(title):
    """The entry of the plugin's menu with this title."""
    return next(action for action in plugins["lanewright"].menu.actions if action.text() == title)


def result(output):
    """The layer of the project that is this result of an algorithm; the newest, where there are several."""
    nodes = QgsProject.instance().layerTreeRoot().findLayers()
    return next(node.layer() for node in nodes if node.layer() and node.layer().customProperty("lanewright/output") == output)
