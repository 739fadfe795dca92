"""Base of our own widgets in Processing's dialogs, and the choice in the user's language, whose value stays the word of commands and models."""

from processing.gui.wrappers import WidgetWrapper
from qgis.gui import QgsGui

from ..processing_provider.texts import tr
from .widgets import choices


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


class ChoiceWrapper(DialogWrapper):
    """A box with the choices of an enumeration in words."""

    def createWidget(self, **more):
        widget = choices((tr(choice), choice) for choice in self.parameterDefinition().options())
        widget.setCurrentIndex(widget.findData(self.parameterDefinition().defaultValue()))
        widget.currentIndexChanged.connect(self.announce)
        return widget

    def setValue(self, value):
        self.widget.setCurrentIndex(self.widget.findData(value))

    def value(self):
        return self.widget.currentData()
