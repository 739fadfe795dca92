"""What users read, in their language: texts of the code and sentences of the core, each with its translation, from resources/i18n."""

import json
import re
from functools import cache
from pathlib import Path
from string import Formatter

from ..core.common.texts import CoreMessages, numbers, set_translation, told, tr

__all__ = ["languages", "numbers", "retold", "speak", "told", "tr"]

TRANSLATIONS = Path(__file__).resolve().parents[1] / "resources" / "i18n"


class _Phrase(str):
    """A translation that takes values: those that are numbers have the user's signs."""

    def format(self, *args, **values):
        return _Values().vformat(self, args, values)


class _Values(Formatter):
    def format_field(self, value, spec):
        text = super().format_field(value, spec)
        is_number = hasattr(value, "__float__") or isinstance(value, str) and text[:1].isdigit() and " " not in text
        return numbers(text) if is_number else text   # not the names of files


def languages():
    """Two letters of each language that there is."""
    return ["en", *sorted(path.stem.partition("_")[2] for path in TRANSLATIONS.glob("lanewright_*.json"))]


def speak(language="en"):
    """Make dialogs, help, messages and reports speak a language, English where it is not known; True where it is.

    Ids, values of choices, fields and files stay as they are. A country after the language, as in de_AT, says nothing more. Labels stand in
    classes and tables, so the language is chosen before those are imported.
    """
    short = language[:2].lower()
    if short == "en" or short not in languages():
        set_translation(None)
        return short == "en"
    texts = json.loads((TRANSLATIONS / f"lanewright_{short}.json").read_text(encoding="utf-8"))

    def translated(text):
        text = texts.get(text) or text
        return _Phrase(text) if "{" in text else text

    messages = CoreMessages(TRANSLATIONS / f"core_{short}.json", lambda word: numbers(translated(word)))
    set_translation(translated, messages.told, short)
    return True


@cache
def _english():
    """{text in any of the languages: the same in English}; what is English too stays as it is."""
    files = [json.loads(path.read_text(encoding="utf-8")) for path in TRANSLATIONS.glob("lanewright_*.json")]
    return {text: english for texts in files for english, text in texts.items()} | {english: english for texts in files for english in texts}


def retold(text):
    """A text of `tr` in whatever language, in the user's; another text stays as it is."""
    return tr(_english().get(text, text))


@cache
def help_texts():
    """{id of an algorithm, name of a parameter, or both: its paragraphs, in English} of help.txt, whose first lines say how it is read."""
    text = re.sub(r"^#.*", "", Path(__file__).with_name("help.txt").read_text(encoding="utf-8"), flags=re.MULTILINE)
    _, *parts = re.split(r"^\[(.+)\]$", text, flags=re.MULTILINE)
    texts = {}
    for heading, text in zip(parts[::2], parts[1::2]):
        names = re.findall(r"\b[A-Z][A-Z_0-9]+\b", heading) or [""]
        owners = [word for word in heading.split() if word not in (*names, "+")] or [""]
        for key in (f"{owner}{' +' * ('+' in heading)} {name}".strip() for owner in owners for name in names):
            texts[key] = [" ".join(part.split()) for part in text.split("\n\n") if part.strip()]
    return texts
