"""Lanewright in the Processing toolbox."""

from pathlib import Path

from qgis.core import QgsApplication, QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from ..algorithms.catalogue import ALGORITHMS
from .algorithm import LanewrightAlgorithm
from .models import read_model

RESOURCES = Path(__file__).resolve().parents[1] / "resources"

# id of a model -> what it was called in version 0.1.0
OLD_NAMES = {"roadmapstages": "Road map stages", "scanlineboundarystages": "Boundaries from scanlines",
             "markingsanddrivinglineswithassessment": "Markings and driving lines with assessment"}


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
                # by which scripts and models called it before ids had no spaces
                QgsApplication.processingRegistry().addAlgorithmAlias(f"{self.id()}:{OLD_NAMES.get(model.name(), '')}", f"{self.id()}:{model.name()}")
