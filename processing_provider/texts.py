"""Translation of what the user reads."""

from qgis.PyQt.QtCore import QCoreApplication


def tr(text):
    return QCoreApplication.translate("Lanewright", text)
