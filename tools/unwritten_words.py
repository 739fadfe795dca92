"""Finds words that the project does not write: those of the second table of docs/words.md, in the files named as arguments.

Each cell of the table's left column holds words separated by commas. Whole words match, small or capital, and as parts of names of code.
"""

import re
import sys
from pathlib import Path

WORDS = Path(__file__).resolve().parent.parent / "docs" / "words.md"


def unwanted():
    """{word that is not written: what is written instead}."""
    rows = [line.split("|")[1:3] for line in WORDS.read_text(encoding="utf-8").partition("| not written |")[2].splitlines() if line.startswith("| ")]
    return {word.strip(): better.strip() for words, better in rows if not words.strip().startswith("---") for word in words.split(",")}


def main(names):
    words = unwanted()
    pattern = re.compile("|".join(rf"(?<![A-Za-z]){re.escape(word)}(?![a-z])" for word in words), re.IGNORECASE)
    wrong = [f"{name}:{number}: {match.group()}; write {words[match.group().lower()]}"
             for name in names if Path(name) != WORDS.relative_to(WORDS.parent.parent)
             for number, line in enumerate(Path(name).read_text(encoding="utf-8").splitlines(), 1) for match in pattern.finditer(line)]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
