"""The order of the folders of `core`, and the words in it, read from the code itself."""

import ast
import functools
import importlib
import re
from collections import defaultdict
from pathlib import Path

import pytest

CORE = Path(__file__).resolve().parents[2] / "core"
FILES = sorted(path for path in CORE.rglob("*.py") if "__pycache__" not in path.parts)
MODULES = [path for path in FILES if path.name != "__init__.py"]
# Each folder imports only from those before it
ORDER = ("common", "execution", "countries", "io", "curves", "survey", "road", "intensity", "markings", "driving", "corrections", "inventory",
         "export", "assess", "overlay", "sample", "report", "pipeline")
# Module-level numbers of each room: every one is a decision that a reader must know
NUMBERS = {
    "common": 17,
    "execution": 25,
    "countries": 15,
    "io": 5,
    "curves": 42,
    "survey": 200,
    "road": 522,
    "intensity": 49,
    "markings": 439,
    "driving": 62,
    "corrections": 11,
    "inventory": 148,
    "export": 161,
    "assess": 32,
    "overlay": 79,
    "sample": 150,
    "report": 24,
    "pipeline": 2,
}


@functools.cache
def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def name_of(path):
    """`core/road/edges/fit.py` -> ("road", "edges", "fit")."""
    return path.relative_to(CORE).with_suffix("").parts


@functools.cache
def imported(path, for_types=False):
    """(module imported, line) of every import from within core, also those inside functions; those for type checkers alone on wish."""
    return list(_imported(path, for_types))


def _imported(path, for_types):
    package = list(name_of(path))[:-1]
    tree = tree_of(path)
    typing = {inner for node in ast.walk(tree) if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
              for inner in ast.walk(node)}
    for node in ast.walk(tree):
        if (node in typing and not for_types) or not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = package[:len(package) - (node.level - 1)] + (node.module.split(".") if node.module else [])
        for alias in node.names:
            inner = (*base, alias.name)
            is_module = CORE.joinpath(*inner).with_suffix(".py").exists() or CORE.joinpath(*inner, "__init__.py").exists()
            yield (inner if is_module else tuple(base)), node.lineno


def test_imports_run_one_way_between_folders():
    wrong = [f"{'/'.join(here)}.py, line {line}: {here[0]} imports {'/'.join(target)}"
             for path in MODULES for here in [name_of(path)] if len(here) > 1
             for target, line in imported(path) if len(target) > 1 and ORDER.index(target[0]) > ORDER.index(here[0])]
    assert not wrong


def test_no_two_folders_import_each_other():
    """Sub-folders too: `road/edges` -> `road/common` never comes with `road/common` -> `road/edges`."""
    arrows = defaultdict(dict)
    for path in MODULES:
        folder = name_of(path)[:-1]
        for target, line in imported(path):
            # the table of weights of a room lies below all of its sub-folders
            there = target if CORE.joinpath(*target).is_dir() or target[-1] == "weights" else target[:-1]
            if there != folder:
                arrows[folder][there] = f"{'/'.join(name_of(path))}.py, line {line}"

    def reach(start, goal, way):
        for there, where in arrows[start].items():
            if there == goal:
                return [*way, where]
            if there not in seen:
                seen.add(there)
                found = reach(there, goal, [*way, where])
                if found:
                    return found
        return None

    for folder in list(arrows):
        seen = set()
        circle = reach(folder, folder, [])
        assert not circle, "these imports run in a circle: " + " -> ".join(circle)


def test_no_two_files_import_each_other():
    """Imports inside functions and those for type checkers count: who reads one file of a circle must read them all."""
    arrows = {name_of(path): {target for target, _ in imported(path, for_types=True) if target != name_of(path)} for path in MODULES}

    def reach(start, goal, way):
        for target in arrows.get(start, ()):
            if target == goal:
                return [*way, target]
            if target not in seen:
                seen.add(target)
                circle = reach(target, goal, [*way, target])
                if circle:
                    return circle
        return None

    for name in arrows:
        seen = set()
        circle = reach(name, name, [name])
        assert not circle, "these files import each other: " + " -> ".join("/".join(part) for part in circle)


def numbers_of(path):
    """Assignments at module level of a number, or of a table with numbers, to a name in capitals: (name, comment on the lines of it)."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for node in tree_of(path).body:
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) and node.value else []
        if targets and all(isinstance(target, ast.Name) and target.id.isupper() for target in targets) \
                and any(isinstance(part, ast.Constant) and type(part.value) in (int, float) for part in ast.walk(node.value)):
            yield targets[0].id, " ".join(lines[node.lineno - 1:node.end_lineno])


@pytest.mark.parametrize("room", ORDER)
def test_the_numbers_of_a_room_may_only_become_fewer(room):
    """Who takes a number out writes the new count into NUMBERS; who needs one more finds one that can be derived."""
    assert sum(len(list(numbers_of(path))) for path in MODULES if name_of(path)[0] == room) == NUMBERS[room]


def test_a_folder_says_what_it_is_for():
    for folder in sorted({path.parent for path in FILES}):
        assert len(ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))) or "") > 40, folder


def test_the_core_never_imports_qgis():
    for path in FILES:
        for node in ast.walk(tree_of(path)):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else \
                [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
            assert not any(name.split(".")[0] == "qgis" for name in names), path


def test_public_names_are_used_outside_their_file():
    """What one file alone uses begins with an underscore: a reader may change it without looking farther."""
    code = [path for folder in ("core", "algorithms", "library", "processing_provider", "desktop", "tests", "tools")
            for path in (CORE.parent / folder).rglob("*.py") if "__pycache__" not in path.parts] + [CORE.parent / "CONTRIBUTING.md"]
    words = {path: set(re.findall(r"\w+", path.read_text(encoding="utf-8"))) for path in code}
    users = defaultdict(set)
    for path, inside in words.items():
        for word in inside:
            users[word].add(path)
    assert not [f"{'/'.join(name_of(path))}.py: {node.name}" for path in MODULES for node in tree_of(path).body
                if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_") and users[node.name] == {path}]


def public(path):
    """(qualified name, node) of public functions and methods."""
    for node in tree_of(path).body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_"):
                    yield f"{node.name}.{inner.name}", inner


def test_public_functions_say_what_types_they_take_and_give():
    bare = []
    for path in MODULES:
        for name, node in public(path):
            arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            if arguments and arguments[0].arg in ("self", "cls"):
                arguments = arguments[1:]
            if node.returns is None or any(argument.annotation is None for argument in arguments):
                bare.append(f"{'/'.join(name_of(path))}.py: {name}")
    assert not bare


@pytest.mark.parametrize("folder", sorted({path.parent for path in FILES} - {CORE}), ids=lambda folder: folder.relative_to(CORE).as_posix())
def test_a_folder_offers_its_public_names(folder):
    package = importlib.import_module(".".join(("lanewright.core", *folder.relative_to(CORE).parts)))
    names = getattr(package, "__all__", [])
    assert names or not [path for path in folder.glob("*.py") if path.name != "__init__.py"]
    for name in names:
        offered = getattr(package, name)
        assert type(offered) is not type(ast), f"{name} is a file of the folder and no public name"


def documented(text, heading):
    """Names that a numpydoc section of a docstring explains."""
    section = re.search(rf"^{heading}\n-+\n(.*?)(?=\n\n\w[\w ]*\n-+\n|\Z)", text, re.DOTALL | re.MULTILINE)
    lines = section.group(1).splitlines() if section else []
    return {name.strip(" *") for line in lines if (said := re.match(r"(\*{0,2}\w+(?:, \*{0,2}\w+)*) : ", line)) for name in said.group(1).split(",")}


def test_a_docstring_explains_no_parameter_that_is_not_there():
    gone = []
    for path in MODULES:
        for name, node in public(path):
            arguments = node.args
            there = {argument.arg for argument in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
                     if argument is not None}
            extra = documented(ast.get_docstring(node) or "", "Parameters") - there
            if extra:
                gone.append(f"{'/'.join(name_of(path))}.py, {name}: {', '.join(sorted(extra))}")
    assert not gone
