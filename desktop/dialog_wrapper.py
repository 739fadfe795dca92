"""Base of our own widgets in Processing's dialogs."""

from processing.gui.wrappers import WidgetWrapper
from qgis.gui import QgsGui


class DialogWrapper(WidgetWrapper):
    """A widget for dialogs and batches; the model designer keeps its own, which offers what a model has."""

    def __new__(cls, parameter, dialog, *place, **more):
        if type(dialog).__name__ != "ModelerParametersDialog":
            return super().__new__(cls)
        wrapper = QgsGui.processingGuiRegistry().createModelerParameterWidget(dialog.model, dialog.childId, parameter, dialog.context)
        wrapper.setDialog(dialog)
        return wrapper

    def announce(self, *changed):
        """Tell QGIS that the value is another."""
        self.widgetValueHasChanged.emit(self)

    def setWidgetValue(self, value, context):
        self.setValue(value)
