"""Lanewright in the Processing toolbox."""

from pathlib import Path

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from ..algorithms.catalogue import ALGORITHMS
from .algorithm import LanewrightAlgorithm
from .models import read_model

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
        for declaration in ALGORITHMS:
            self.addAlgorithm(LanewrightAlgorithm(declaration()))
        for path in sorted((RESOURCES / "models").glob("*.model3")):
            model = read_model(path)
            if model is not None:
                self.addAlgorithm(model)
