"""Which paragraphs of the manual's translated pages are older than the English ones: manual_translations.py [--seen PAGE ...]

The pages that people write by hand are translated by hand, paragraph by paragraph. A checksum of the English paragraph that each
was translated from stands in `sources.json` of the language's folder. When an English paragraph changes, this lists it with its translation until
somebody has looked at that and says so by `--seen PAGE` (or `--seen all`); a page that gained or lost a paragraph has to be brought into step first.
"""

import argparse
import json
import re
import sys
import zlib
from itertools import zip_longest

from make_manual import LANGUAGES, PAGES, WRITTEN_BY_HAND

SOURCES = "sources.json"


def paragraphs(text):
    """The paragraphs of a page: what stands between empty lines; a block of code is one, with the empty lines in it."""
    found, code = [[]], False
    for line in text.splitlines():
        fence = line.startswith("```")
        if fence and not code or not line.strip() and not code:
            found.append([])
        if line.strip() or code:
            found[-1].append(line)
        if fence:
            code = not code
    return ["\n".join(lines) for lines in found if lines]


def checksum(paragraph):
    """Of the words; where lines are broken does not count."""
    return zlib.crc32(" ".join(paragraph.split()).encode())


def kind(paragraph):
    """What must be alike in a translation: the level of a heading, rows of a table, entries of a list, code, picture."""
    first = paragraph.splitlines()[0]
    if first.startswith("```"):
        return "code"
    if first.startswith("#"):
        return first.split()[0]
    if first.startswith("|"):
        return f"table of {len(paragraph.splitlines())} rows"
    if first.startswith("!["):
        return f"picture {re.search(r'[^/(]+(?=[)])', first).group()}"
    entries = sum(line.startswith("- ") for line in paragraph.splitlines())
    return f"list of {entries}" if entries else "text"


def page(name, language=""):
    """The paragraphs of a page; none where there is no such page."""
    path = PAGES / language / f"{name}.md"
    return paragraphs(path.read_text(encoding="utf-8")) if path.exists() else []


def known(language):
    """Page -> checksums of the English paragraphs that its translation was made from."""
    path = PAGES / language / SOURCES
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def out_of_step(name, language):
    """Where a page and its translation first differ in kind, "" where they do not."""
    for number, (here, there) in enumerate(zip_longest(page(name), page(name, language)), 1):
        if here is None or there is None or kind(here) != kind(there):
            kinds = [kind(paragraph) if paragraph else "nothing" for paragraph in (here, there)]
            return f"paragraph {number}: {kinds[0]} in English, {kinds[1]} in {LANGUAGES[language]}"
    return ""


def stale(name, language):
    """(number, English paragraph, its translation) of those that changed since somebody looked at the translation."""
    looked_at = set(known(language).get(name, ()))
    return [(number, here, there) for number, (here, there) in enumerate(zip(page(name), page(name, language)), 1) if checksum(here) not in looked_at]


def seen(names, language):
    """Note that somebody has looked at the translations of some pages."""
    kept = known(language)
    for name in names:
        if out_of_step(name, language):
            sys.exit(f"{name}: {out_of_step(name, language)}. Bring the translation into step first.")
        kept[name] = [checksum(paragraph) for paragraph in page(name)]
    text = json.dumps({name: kept[name] for name in WRITTEN_BY_HAND if name in kept}, indent=1)
    (PAGES / language / SOURCES).write_text(text + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seen", nargs="+", metavar="PAGE", default=[], help="pages whose translation fits again; all for all")
    asked = parser.parse_args()
    wrong = 0
    for language in LANGUAGES:
        if asked.seen:
            seen(WRITTEN_BY_HAND if asked.seen == ["all"] else asked.seen, language)
        for name in WRITTEN_BY_HAND:
            step = out_of_step(name, language)
            if step:
                wrong += 1
                print(f"{language}/{name}.md, {step}\n")
                continue
            for number, here, there in stale(name, language):
                wrong += 1
                print(f"{language}/{name}.md, paragraph {number}\n--- English now:\n{here}\n--- {LANGUAGES[language]}:\n{there}\n")
    print(f"{wrong} paragraphs to look at" if wrong else "every translated page fits its English one")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
