"""What the core says, in the user's language.

The core knows no QGIS and writes its sentences in English, with numbers and names in them. Here they are recognised by what
stands between these, and written anew.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

PLACE = "{}"


class CoreMessages:
    """Sentences of the core and their translations; `{}` stands for a number or name.

    translations : {English: translation}, with as many places in the same order; an empty one is none
    word : from a single word that is put in, such as a side, to that of the language
    """

    def __init__(self, translations: dict[str, str], word: Callable[[str], str] = str):
        self.word = word
        known = {source: target for source, target in translations.items() if target}
        # the most words first: a short sentence may begin as a long one does
        longest_first = sorted(known, key=lambda source: -len(source.replace(PLACE, "")))
        self._sentences = [(_pattern(source), known[source]) for source in longest_first]

    @classmethod
    def load(cls, path: Path, word: Callable[[str], str] = str) -> CoreMessages:
        """Those of a file; none where there is no file."""
        return cls(json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}, word)

    def told(self, text: str) -> str:
        """A message in the user's language; as it is where it is not known."""
        for pattern, target in self._sentences:
            found = pattern.fullmatch(text)
            if found:
                values = iter([self.word(value) if value.isalpha() else value for value in found.groups()])
                return re.sub(re.escape(PLACE), lambda place: next(values), target)
        return text


def _pattern(source):
    return re.compile("(.*?)".join(re.escape(part) for part in source.split(PLACE)), re.DOTALL)
