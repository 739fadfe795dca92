"""Lanewright in the Processing toolbox."""

from pathlib import Path

from qgis.core import QgsProcessingModelAlgorithm, QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .catalogue import ALGORITHMS

RESOURCES = Path(__file__).resolve().parents[1] / "resources"


class LanewrightProvider(QgsProcessingProvider):
    def id(self):
        return "lanewright"

    def name(self):
        return "Lanewright"

    def longName(self):
        return "Lanewright: road maps from mobile laser scanning"

    def icon(self):
        return QIcon(str(RESOURCES / "icon.svg"))

    def loadAlgorithms(self):
        for algorithm in ALGORITHMS:
            self.addAlgorithm(algorithm())
        for path in sorted((RESOURCES / "models").glob("*.model3")):
            model = QgsProcessingModelAlgorithm()
            if model.fromFile(str(path)):
                self.addAlgorithm(model)
