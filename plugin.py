"""The plugin object QGIS holds: it registers the Processing provider and, in a window, the menu."""

from qgis.core import QgsApplication

from . import add_library_folders
from .processing_provider.provider import LanewrightProvider, keep_task_threads
from .processing_provider.texts import speak


class LanewrightPlugin:
    def __init__(self, iface):
        self.iface = iface
        self.provider = None
        self.menu = None

    def initProcessing(self):
        """qgis_process calls only this one; the desktop comes here through initGui."""
        add_library_folders()
        keep_task_threads()
        self.provider = LanewrightProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)
        # A model looks its stages up in the registry, which holds them only now
        self.provider.refreshAlgorithms()

    def initGui(self):
        self.initProcessing()
        if self.iface is None:
            return
        from .desktop.menu import Menu
        from .desktop.widgets import all_is_there

        self.menu = Menu(self.iface)
        all_is_there(self.iface)

    def unload(self):
        if self.menu is not None:
            from .desktop.background import end_runs

            end_runs()
            self.menu.remove()
            self.menu = None
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
        speak("en")
