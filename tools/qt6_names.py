"""Checks with PyQt6 that what the plugin takes from Qt is there in Qt 6, under the names it uses: qt6_names.py FILE ...

Qt 6 knows an enumeration's members only by the enumeration (`Qt.AlignmentFlag.AlignLeft`), knows no flags of two kinds joined, and has moved
or dropped classes. QGIS's own module `qgis.PyQt` hides none of that. Every name imported from it, every attribute of such a class, and every
sum of flags is evaluated here by PyQt6 itself. What is said of objects (`event.pos()`) is not seen.
"""

import ast
import importlib
import sys
from pathlib import Path

MODULE = "qgis.PyQt."
MISSING = (ImportError, AttributeError, TypeError)


def imported(tree):
    """{name in the file: (module of PyQt6, name there)} of what a file imports from Qt."""
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(MODULE):
            for alias in node.names:
                found[alias.asname or alias.name] = (node.module.replace(MODULE, "PyQt6."), alias.name)
    return found


def of_qt(node, names):
    """Whether an expression is made of Qt's classes alone: their attributes, sums of these, and their numbers."""
    if isinstance(node, ast.Name):
        return node.id in names
    if isinstance(node, ast.Attribute):
        return of_qt(node.value, names)
    if isinstance(node, ast.BinOp):
        return isinstance(node.op, ast.BitOr) and of_qt(node.left, names) and of_qt(node.right, names)
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "int" and all(of_qt(one, names) for one in node.args)


def value(node, names):
    """What an expression of Qt's classes is in PyQt6."""
    if isinstance(node, ast.Name):
        module, name = names[node.id]
        return getattr(importlib.import_module(module), name)
    if isinstance(node, ast.Attribute):
        return getattr(value(node.value, names), node.attr)
    if isinstance(node, ast.BinOp):
        return value(node.left, names) | value(node.right, names)
    return int(*(value(one, names) for one in node.args))


def complaints(path):
    """What PyQt6 does not know in a file, one line each."""
    tree = ast.parse(Path(path).read_text(encoding="utf-8"))
    names, said = imported(tree), []
    for module, name in names.values():
        try:
            getattr(importlib.import_module(module), name)
        except MISSING as problem:
            said.append(f"{path}: {problem}")

    def look(node):
        if not isinstance(node, ast.Name) and of_qt(node, names):
            try:
                value(node, names)
            except MISSING as problem:
                said.append(f"{path}:{node.lineno}: {ast.unparse(node)}: {problem}")
            return
        for child in ast.iter_child_nodes(node):
            look(child)

    look(tree)
    return said


def main():
    said = [line for path in sys.argv[1:] for line in complaints(path)]
    print("\n".join(said), end="\n" if said else "")
    return bool(said)


if __name__ == "__main__":
    sys.exit(main())
