"""Collects what the user reads into resources/i18n/lanewright_*.ts: translations.py [LANGUAGE ...]

The usual chain: this finds the texts (Qt's own lupdate reads no Python, and pylupdate no texts that stand in
a class), Qt Linguist or any editor translates the .ts, lrelease makes the .qm that QGIS loads. Texts that were
translated keep their translation; those that are gone go.
"""

import ast
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from models import RECIPES

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "resources" / "i18n"
SCHEMAS = ROOT / "core" / "common" / "schemas.py"
CONTEXT = "Lanewright"
FOLDERS = ("algorithms", "processing_provider", "desktop")
# Texts that stand in a class or a table and are translated where they are shown
IN_A_CLASS = {"TITLE", "SUMMARY", "HELP", "GROUP", "TAGS", "GROUPS"}


def texts():
    """Every text a user reads, with the file it is in, in the order of the files."""
    found = {}
    for path in [ROOT / "plugin.py", *sorted(file for folder in FOLDERS for file in (ROOT / folder).rglob("*.py"))]:
        for text in texts_of(ast.parse(path.read_text(encoding="utf-8"))):
            found.setdefault(text, path.relative_to(ROOT).as_posix())
    for text in aliases():
        found.setdefault(text, SCHEMAS.relative_to(ROOT).as_posix())
    for recipe in RECIPES:
        found.setdefault(recipe.name, "tools/models.py")
        found.setdefault(recipe.description, "tools/models.py")
    for path in sorted((ROOT / "resources" / "styles").glob("*.qml")):
        for text in legend(path):
            found.setdefault(text, path.relative_to(ROOT).as_posix())
    return found


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
        for text in constants(value):
            # HELP is shown paragraph by paragraph
            yield from (text.split("\n\n") if target.id == "HELP" else [text])
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for part, text in zip(target.elts, value.elts):
            yield from in_a_class(part, text)


def constants(node):
    parts = node.elts if isinstance(node, (ast.Tuple, ast.List)) else [node]
    return [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str) and part.value.strip()]


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


def update(language, found):
    """Bring one .ts up to date; how many texts it has and how many lack a translation."""
    path = FOLDER / f"lanewright_{language}.ts"
    known = translated(path) if path.exists() else {}
    root = ET.Element("TS", version="2.1", language=language, sourcelanguage="en")
    context = ET.SubElement(root, "context")
    ET.SubElement(context, "name").text = CONTEXT
    for text, file in found.items():
        message = ET.SubElement(context, "message")
        ET.SubElement(message, "location", filename=f"../../{file}")
        ET.SubElement(message, "source").text = text
        target = ET.SubElement(message, "translation")
        if text in known:
            target.text = known[text]
        else:
            target.set("type", "unfinished")
    ET.indent(root, "    ")
    FOLDER.mkdir(parents=True, exist_ok=True)
    path.write_text('<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n' + ET.tostring(root, encoding="unicode") + "\n", encoding="utf-8")
    return len(found), len(set(found) - set(known))


def translated(path):
    """Source text -> translation, of those that are finished."""
    messages = ET.parse(path).getroot().iter("message")
    return {message.findtext("source"): message.findtext("translation") for message in messages
            if message.find("translation").get("type") != "unfinished" and message.findtext("translation")}


def main():
    languages = sys.argv[1:] or sorted(path.stem.split("_", 1)[1] for path in FOLDER.glob("lanewright_*.ts"))
    found = texts()
    for language in languages:
        total, missing = update(language, found)
        print(f"{language}: {total} texts, {missing} without translation")


if __name__ == "__main__":
    main()
