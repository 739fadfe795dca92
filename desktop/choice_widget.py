"""A choice in the user's language; its value stays the word of commands and models."""

from ..processing_provider.texts import tr
from .dialog_wrapper import DialogWrapper
from .widgets import choices


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
