"""The plugin object QGIS holds: it registers the Processing provider and nothing else."""

from qgis.core import Qgis, QgsApplication
from qgis.PyQt.QtCore import QCoreApplication

from . import add_library_folders
from .processing_provider.dependencies import missing_packages
from .processing_provider.provider import LanewrightProvider


class LanewrightPlugin:
    def __init__(self, iface):
        self.iface = iface
        self.provider = None

    def initProcessing(self):
        """qgis_process calls only this one; the desktop comes here through initGui."""
        add_library_folders()
        self.provider = LanewrightProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)
        # A model looks its stages up in the registry, which holds them only now
        self.provider.refreshAlgorithms()

    def initGui(self):
        self.initProcessing()
        missing = missing_packages()
        if missing and self.iface is not None:
            self.iface.messageBar().pushMessage(
                "Lanewright",
                QCoreApplication.translate("Lanewright", "{missing} The README says how to install them.").format(
                    missing=missing
                ),
                level=Qgis.MessageLevel.Warning,
            )

    def unload(self):
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
