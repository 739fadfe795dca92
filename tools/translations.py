"""Collects what the user reads into resources/i18n, English and translation side by side: translations.py [LANGUAGE ...]

Texts of the code stand in lanewright_*.json, sentences of the core in core_*.json, with {} for numbers and names in the same order. An
empty translation is none yet. Texts that were translated keep their translation; those that are gone go.
"""

import ast
import json
import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from jinja2 import Environment, nodes
from models import RECIPES

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "resources" / "i18n"
TEMPLATES = ROOT / "products" / "report" / "templates"
SCHEMAS = ROOT / "core" / "common" / "features.py"
COUNTRIES = ROOT / "core" / "countries" / "countries.json"
VOCABULARY, FAULTS = ROOT / "core" / "common" / "words.txt", ROOT / "products" / "export" / "check" / "faults.txt"   # lines of name: text
HELP = ROOT / "algorithms" / "help.txt"
FOLDERS = ("algorithms", "processing_provider", "desktop", "core", "products", "simulator", "library")
FEWEST_LETTERS = 8  # of a sentence of the core: what is shorter would be found in anything
FEWEST_WORDS = 3  # of a phrase of the core that is put into a sentence elsewhere
# Errors that tell a programmer, not a user
OF_PROGRAMMERS = {"ValueError", "TypeError", "KeyError", "IndexError", "AttributeError", "AssertionError", "RuntimeError", "OSError"}
# The texts of the first are translated as those of a dialog, the last holds names of columns in many languages
NO_SENTENCES = ("products/report", "core/common/features.py", "core/common/texts.py", "core/survey/trajectory/columns.py")
# Patterns, XML, CRSs, names of columns, commands
NO_PROSE = re.compile(r"[\\]|<[?x!]|^ *<[A-Za-z]|^[+]proj=|^[A-Z_]+\[|"
                      r"^(pixel|line|mapx|mapy|mapz|name|enable|check) \w+ \w+|^pip |^1 hit|^SELECT |lanewright [A-Z{l]")
NAMED = {"title", "signed"}  # attributes of the core whose shortest texts are shown too
UNSAID = {"_WORDS"}  # tables of the core that hold what other software says
# Texts that stand in a class or a table and are translated where they are shown
IN_A_CLASS = {"TITLE", "GROUP", "GROUPS"}
# Words of choices, which commands and models keep as they are written here
NAMES = ("scanner_channel", "point_source_id", "1.7", "1.8", "dxf", "landxml", "A4", "A3", "A2", "A1", "A0", "1:100", "1:200", "1:250", "1:500",
         "1:1000", "1:2000", "1:2500", "1:5000", "en", "de")  # of fields, formats and languages: alike in every language
CHOICES = ("automatic", "gps", "adjusted", "week", "day", "street", "rural", "urban", "one-lane", "wide-lane", "no-centre-line",
           "hatched-island", "motorway", "serpentine", "crossing", "roundabout", "outskirts", "cycle-lanes", "intensity", "rgb", "profiles",
           "scanlines", "both", "linear", "logarithmic", "multi-threshold", "intensity-peaks", "point-segments", "all", "windows", "neutral",
           "china", "germany", "japan", "united-states", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline", "right", "left",
           "nonurban", "half-width", "total-width", "draw", "leave-out", "bilinear", "nearest", "cubic", "curbs", "landscape", "portrait")


def texts():
    """Every text a user reads, with the file it is in, in the order of the files."""
    found = {}
    files = sorted(file for folder in FOLDERS for file in (ROOT / folder).rglob("*.py"))
    for path in [ROOT / "plugin.py", ROOT / "tools" / "make_manual.py", *files]:
        for text in texts_of(ast.parse(path.read_text(encoding="utf-8"))):
            found.setdefault(text, path.relative_to(ROOT).as_posix())
    for path in sorted(TEMPLATES.glob("*.html")):
        for text in template_texts(path):
            found.setdefault(text, path.relative_to(ROOT).as_posix())
    for text in aliases():
        found.setdefault(text, SCHEMAS.relative_to(ROOT).as_posix())
    for _, text in table(VOCABULARY):
        found.setdefault(text, VOCABULARY.relative_to(ROOT).as_posix())
    for text in (*CHOICES, *help_texts()):
        found.setdefault(text, HELP.relative_to(ROOT).as_posix())
    for recipe in RECIPES:
        found.setdefault(recipe.name, "tools/models.py")
        found.setdefault(recipe.description, "tools/models.py")
    for path in sorted((ROOT / "resources" / "styles").rglob("*.qml")):
        for text in legend(path):
            found.setdefault(text, path.relative_to(ROOT).as_posix())
    return found


def table(path):
    """(name, text) of every line of a table that is a file."""
    return [line.split(": ", 1) for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]


def help_texts():
    """The paragraphs of the help of the algorithms and their parameters, and each search word."""
    parts = re.split(r"\n\n|^\[.+\]$|^#.*$", HELP.read_text(encoding="utf-8"), flags=re.MULTILINE)
    paragraphs = [" ".join(part.split()) for part in parts if part.strip()]
    return [text for part in paragraphs for text in (part[6:].split(", ") if part.startswith("Tags: ") else [part])]


def texts_of(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "tr" and node.args:
            yield from constants(node.args[0])
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                yield from in_a_class(target, node.value)


def in_a_class(target, value):
    """The texts of `TITLE = ...` and of `ID, TITLE, GROUP = ...`."""
    if isinstance(target, ast.Name) and target.id in IN_A_CLASS:
        yield from constants(value)
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for part, text in zip(target.elts, value.elts):
            yield from in_a_class(part, text)


def constants(node):
    parts = node.elts if isinstance(node, (ast.Tuple, ast.List)) else [node]
    return [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str) and part.value.strip()]


def template_texts(path):
    """The texts of a report's template."""
    tree = Environment().parse(path.read_text(encoding="utf-8"))
    for call in tree.find_all(nodes.Call):
        if isinstance(call.node, nodes.Name) and call.node.name == "tr" and isinstance(call.args[0], nodes.Const):
            yield call.args[0].value


def legend(path):
    """What a style writes beside its symbols."""
    entries = (entry.get("label") for entry in ET.parse(path).getroot().iter() if entry.tag in ("category", "rule"))
    return [text for text in entries if text]


def aliases():
    """The spelled-out names of the fields of every layer."""
    tree = ast.parse(SCHEMAS.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Field" and len(node.args) > 2:
            yield from constants(node.args[2])


def core_messages():
    """The sentences of core and library that reach a user: errors, warnings, log, titles of stages; {} stands for a number or name.

    What is said at once comes first, then the sentences and phrases that are put together elsewhere.
    """
    said, phrases = {}, {}
    for path in sorted(path for folder in ("core", "products", "simulator", "library") for path in (ROOT / folder).rglob("*.py")):
        file, tree = path.relative_to(ROOT).as_posix(), ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            argument = said_in(node)
            text = template_of(argument) if argument is not None else None
            if text and len(text.replace("{}", "").strip(" .")) >= FEWEST_LETTERS:
                said[text] = file
        if not file.startswith(NO_SENTENCES):
            phrases |= dict.fromkeys(phrases_of(tree), file)
    phrases |= dict.fromkeys((text for row in table(FAULTS) for text in row), FAULTS.relative_to(ROOT).as_posix())
    phrases |= dict.fromkeys(filter(is_phrase, texts_of_countries()), COUNTRIES.relative_to(ROOT).as_posix())
    return {**said, **{text: file for text, file in phrases.items() if text not in said}}


def phrases_of(tree):
    """Texts of some words: no docstring, no message to a programmer, no pattern, no list of names."""
    left_out = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and any(isinstance(target, ast.Name) and target.id in NAMED for target in node.targets):
            yield from (inner.value for inner in ast.walk(node.value) if isinstance(inner, ast.Constant) and isinstance(inner.value, str))
        if isinstance(node, ast.Assign) and any(isinstance(target, ast.Name) and target.id in UNSAID for target in node.targets):
            left_out |= set(ast.walk(node.value))
        name = node.exc.func.id if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call) and isinstance(node.exc.func, ast.Name) else ""
        is_tr = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "tr"
        if is_tr or isinstance(node, ast.Assert) or name in OF_PROGRAMMERS:
            left_out |= set(ast.walk(node))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            left_out.add(node.value)
        if isinstance(node, ast.JoinedStr):
            left_out |= {part for part in node.values if isinstance(part, ast.Constant)}
        if isinstance(node, ast.Attribute) and node.attr == "split":
            left_out.add(node.value)
        if isinstance(node, ast.BinOp) and template_of(node) is not None:
            left_out |= {node.left, node.right}
    for node in ast.walk(tree):
        text = template_of(node) if node not in left_out else None
        if is_phrase(text):
            yield text


def is_phrase(text):
    words = re.findall("[A-Za-z]{2,}", text or "")
    return len(words) >= FEWEST_WORDS and text.strip().count(" ") >= FEWEST_WORDS - 1 and not NO_PROSE.search(text)


def texts_of_countries():
    """Where dashes are painted, codes, sources and rules of the catalogue of countries."""
    for entry in json.loads(COUNTRIES.read_text(encoding="utf-8")):
        yield from (where for *_, where in entry["dash_patterns"])
        yield from (entry["design_code"], *entry["sources"], *(rule for _, rule in entry["section_limits"].values()))


def said_in(node):
    """The argument of a call that a user reads, None of any other node."""
    if not isinstance(node, ast.Call):
        return None
    name = node.func.id if isinstance(node.func, ast.Name) else node.func.attr if isinstance(node.func, ast.Attribute) else ""
    owner = node.func.value.id if isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name) else ""
    told = name in ("RoadExtractionError", "info", "warn") or name == "append" and owner in ("notes", "remarks")
    arguments = node.args[:1] if told else node.args[1:2] if name == "run" and owner == "stages" else []
    return arguments[0] if arguments else None


def template_of(node):
    """A text with {} for what is put in; None of what is no text."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else None
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        parts = template_of(node.left), template_of(node.right)
        return None if parts == (None, None) else "".join("{}" if part is None else part for part in parts)
    return None


def update(name, found):
    """Bring one file up to date; how many texts it has and how many lack a translation."""
    path = FOLDER / f"{name}.json"
    known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    kept = {text: known.get(text, "") for text in found}
    path.write_text(json.dumps(kept, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    return len(kept), sum(not target for target in kept.values())


def main():
    languages = sys.argv[1:] or sorted(path.stem.split("_", 1)[1] for path in FOLDER.glob("lanewright_*.json"))
    for language in languages:
        for name, found in ((f"lanewright_{language}", texts()), (f"core_{language}", core_messages())):
            total, missing = update(name, found)
            print(f"{name}: {total} texts, {missing} without translation")


if __name__ == "__main__":
    main()
