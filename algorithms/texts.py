"""What users read, in their language: QGIS sets a translation, elsewhere texts stay as they are written."""

_translate = None


def set_translation(translate):
    """Make `tr` go through a function from text to text; None for none."""
    global _translate
    _translate = translate


def tr(text):
    """The text in the user's language."""
    return text if _translate is None else _translate(text)
