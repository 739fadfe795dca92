"""What users read, in their language: QGIS sets a translation, elsewhere texts stay as they are written."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

_translate: Callable[[str], str] | None = None
_tell: Callable[[str], str] | None = None
_language = "en"


def set_translation(translate: Callable[[str], str] | None, tell: Callable[[str], str] | None = None, language: str = "en") -> None:
    """Set the user's language.

    translate : from a text that the code marks by `tr` to its translation; None for none
    tell : from a whole sentence that the code made, numbers and names in it, to its translation; None for none
    language : two letters, of ISO 639
    """
    global _translate, _tell, _language
    _translate, _tell, _language = translate, tell, language


def tr(text: str, /, **values: Any) -> str:
    """A text as it stands in the code, in the user's language, with values filled in where there are any."""
    translated = text if _translate is None else _translate(text)
    return translated.format(**values) if values else translated


def told(sentence: str) -> str:
    """A sentence that another part of the code made, in the user's language where it is known."""
    return sentence if _tell is None else _tell(sentence)


def language() -> str:
    """Two letters: that of the texts."""
    return _language


_NUMBER = re.compile(r"(?<![^\s(+±–-])(?<!\w-)(?:\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+\.\d+)(?=[)%°;:,.]*(?:[\s–]|/\d|$))")


def numbers(text: str) -> str:
    """A text whose numbers have the user's signs: 1.042,5 in German for 1,042.5; what is no number of its own, as in 0.2.0, stays."""
    return text if language() == "en" else _NUMBER.sub(lambda number: number[0].translate({44: ".", 46: ","}), text)


# The values of fields in the user's words. In English they are shown as they stand in the layers.

def word(value: Any, field: str = "") -> str:
    """A value in the user's words; a dash for none. `field` tells which field it is of, where a word means different things in different fields.

    Names and numbers, which are not in the vocabulary below, stay as they are.
    """
    if value is None or value == "":
        return "–"
    if language() == "en":
        return str(value)
    words = vocabulary()
    text = words.get(f"{field}.{value}") or words.get(str(value))
    return tr(text) if text else str(value)


@cache
def vocabulary() -> dict[str, str]:
    """{value, or field.value: what the user reads, in English} of words.txt."""
    lines = Path(__file__).with_name("words.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split(": ", 1) for line in lines if line and not line.startswith("#"))


# What the core says, in the user's language.
#
# The core knows no QGIS and writes its sentences in English, with numbers and names in them. Here they are recognised by what stands between these,
# and written anew.

BRACES = "{}"
AMOUNT = re.compile(r"[-+±]?[\d.,]+ \S+( [a-z]+)?")  # 12.3 m, 12 m measured
PHRASE = 2  # derived: blanks in what is put in: with as many it is a phrase, with fewer a number with its unit or a name
BETWEEN_SENTENCES = re.compile(r"(?<=[.?…]) (?=[A-Z])")
_METRES = r"(-?\d+(?:\.\d+)?)"
_PLACE = re.compile(rf"road (\d+)(?:, (left|right) side)?, station {_METRES}(?: to {_METRES})? m")


@dataclass(frozen=True)
class RoadPlace:
    """A stretch of a road, m along it; both ends are the same where it is one place. `side` is left, right or ""."""

    road: int
    start: float
    end: float
    side: str = ""


def places_in(text: str) -> list[RoadPlace]:
    """The places that a sentence names, such as "road 0, left side, station 90 to 120 m" or "road 0, station 12.3 m"."""
    return [RoadPlace(int(road), float(start), float(end or start), side or "") for road, side, start, end in _PLACE.findall(text)]


class CoreMessages:
    """Sentences of the core and their translations; `{}` stands for a number, a name or a phrase that is a text of the core itself.

    path : JSON, {English: translation}, with as many places in the same order; an empty one is none, as is a file that is not there
    word : from a single word or number that is put in, such as a side, to that of the language
    """

    def __init__(self, path: Path, word: Callable[[str], str] = str):
        translations = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        self.word = word
        self._known = {source.strip(): target.strip() for source, target in translations.items() if target}

    def told(self, text: str) -> str:
        """A message in the user's language, sentence by sentence where it is not known as a whole; as it is where none of it is known."""
        translated = self._recognised(text.strip())
        if translated is None:
            sentences = BETWEEN_SENTENCES.split(text.strip())
            if len(sentences) < 2:
                return text
            translated = " ".join(self._recognised(sentence) or sentence for sentence in sentences)
        before, after = text[:len(text) - len(text.lstrip())], text[len(text.rstrip()):]
        return before + translated + after

    def _recognised(self, text):
        """The translation of what is known as a whole, None of what is not."""
        if text in self._known and BRACES not in text:
            return self._known[text]
        first = None
        for pattern, target in self._sentences:
            match = pattern.fullmatch(text)
            if match:
                values = [self._value(value) for value in match.groups()]
                translated = "".join(text for pair in zip(target.split(BRACES), [*values, ""]) for text in pair)
                # a sentence of which a phrase stays unknown may be another one, whose phrases are all known
                if not any(value == before and before.count(" ") >= PHRASE for value, before in zip(values, match.groups())):
                    return translated
                first = first or translated
        return first

    def _value(self, value):
        """What stands in a place: a word, a phrase, or several with commas or semicolons between them."""
        if " " not in value.strip():
            return self.word(value)
        if "; " in value:   # a list whose parts are known, such as places, is none of them
            parts = [(part, self._value(part)) for part in value.split("; ")]
            if all(shown != part for part, shown in parts):
                return "; ".join(shown for _, shown in parts)
        translated = self.told(value)
        return translated if translated != value else ", ".join(map(self._part, value.split(", ")))

    def _part(self, part):
        return " ".join(map(self.word, part.split(" "))) if AMOUNT.fullmatch(part) else self.told(part)

    @cached_property
    def _sentences(self):
        """(pattern, translation) of what has places; made when something is said first, since starting QGIS need not wait for it."""
        with_places = [source for source in self._known if BRACES in source]
        # the most words first: a short sentence may begin as a long one does
        return [(re.compile("(.*?)".join(map(re.escape, source.split(BRACES))), re.DOTALL), self._known[source])
                for source in sorted(with_places, key=lambda source: -len(source.replace(BRACES, "")))]
