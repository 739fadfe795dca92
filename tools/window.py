"""What the scripts that drive a QGIS window share: waiting, pictures, and saying how far they are."""

import os
from pathlib import Path

from qgis.core import QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, Qt
from qgis.PyQt.QtGui import QImage
from qgis.utils import plugins

PICTURES = Path(os.environ["LANEWRIGHT_PICTURES"])
MAPS = ("window_result", "window_web_map", "window_orthoimage", "window_database", "window_section", "window_corrections", "window_layout",
        "window_model", "window_pairs", "window_two_points")
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


def keep(widget, name):
    wait(0.7)
    save(widget.grab(), name)


def save(picture, name):
    assert not picture.isNull(), name
    image = picture.toImage()
    if name not in MAPS:  # 256 colours do for windows, and a manual travels in the plugin's zip
        image = image.convertToFormat(QImage.Format.Format_Indexed8, Qt.ImageConversionFlag.ThresholdDither | Qt.ImageConversionFlag.AvoidDither)
    image.save(str(PICTURES / f"{name}.png"))
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
