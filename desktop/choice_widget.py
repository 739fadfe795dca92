"""A choice in the user's language; its value stays the word of commands and models."""

from __future__ import annotations

from qgis.PyQt.QtWidgets import QComboBox

from ..algorithms.choice_words import choice_word
from .dialog_wrapper import DialogWrapper


class ChoiceWrapper(DialogWrapper):
    """A box with the choices of an enumeration in words."""

    def createWidget(self, **more):
        widget = QComboBox()
        for choice in self.parameterDefinition().options():
            widget.addItem(choice_word(choice), choice)
        widget.setCurrentIndex(widget.findData(self.parameterDefinition().defaultValue()))
        widget.currentIndexChanged.connect(lambda index: self.widgetValueHasChanged.emit(self))
        return widget

    def setWidgetValue(self, value, context):
        self.setValue(value)

    def setValue(self, value):
        self.widget.setCurrentIndex(self.widget.findData(value))

    def value(self):
        return self.widget.currentData()
