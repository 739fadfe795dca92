"""The language of what is said outside QGIS: the translations that QGIS uses, read without Qt."""

from __future__ import annotations

from pathlib import Path
from pyexpat import ParserCreate

from ..algorithms.texts import set_translation
from ..core.common.errors import RoadExtractionError
from ..core.common.texts import CoreMessages

TRANSLATIONS = Path(__file__).resolve().parents[1] / "resources" / "i18n"


def speak(language="en"):
    """Make help, messages and reports speak a language; ids, values of choices, fields and files stay as they are.

    Parameters
    ----------
    language : "de", or "en" for English; a country after it, as in de_AT, says nothing more

    Raises
    ------
    RoadExtractionError
        If there is no translation.
    """
    known = {path.stem.partition("_")[2]: path for path in sorted(TRANSLATIONS.glob("lanewright_*.ts"))}
    short = language[:2].lower()
    if short == "en":
        set_translation(None)
        return
    if short not in known:
        raise RoadExtractionError(f"There are no texts in the language {language}. There are: {', '.join(['en', *known])}.")
    words = translations(known[short])
    core = CoreMessages.load(TRANSLATIONS / f"core_{short}.json", lambda word: words.get(word, word))
    set_translation(lambda text: words.get(text, text), core.told, short)


def translations(path):
    """Text -> translation of a .ts file of Qt Linguist, of those that are finished."""
    found, parts, unfinished = {}, {}, False
    tag = ""

    def begin(name, attributes):
        nonlocal tag, unfinished
        tag = name
        if name == "message":
            parts.clear()
        if name == "translation":
            unfinished = attributes.get("type") == "unfinished"

    def end(name):
        nonlocal tag
        tag = ""
        if name == "message" and parts.get("translation") and not unfinished:
            found[parts["source"]] = parts["translation"]

    def words(text):
        if tag in ("source", "translation"):
            parts[tag] = parts.get(tag, "") + text

    parser = ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = begin, end, words
    parser.Parse(Path(path).read_bytes(), True)
    return found
