"""What users read, in their language: QGIS sets a translation, elsewhere texts stay as they are written."""

from __future__ import annotations

from collections.abc import Callable

_translate: Callable[[str], str] | None = None
_tell: Callable[[str], str] | None = None
_language = "en"


def set_translation(translate: Callable[[str], str] | None, tell: Callable[[str], str] | None = None, language: str = "en") -> None:
    """Set the user's language.

    Parameters
    ----------
    translate : from a text that the code marks by `tr` to its translation; None for none
    tell : from a whole sentence that the code made, numbers and names in it, to its translation; None for none
    language : two letters, of ISO 639
    """
    global _translate, _tell, _language
    _translate, _tell, _language = translate, tell, language


def tr(text: str) -> str:
    """A text as it stands in the code, in the user's language."""
    return text if _translate is None else _translate(text)


def told(sentence: str) -> str:
    """A sentence that another part of the code made, in the user's language where it is known."""
    return sentence if _tell is None else _tell(sentence)


def language() -> str:
    """Two letters: that of the texts."""
    return _language
