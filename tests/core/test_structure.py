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
MOST_FILES = 15   # of a folder: more cannot be taken in at a glance
MOST_LINES = 400  # of a file: what is longer holds two ideas


@functools.cache
def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def name_of(path):
    """`core/road/edges/fit.py` -> ("road", "edges", "fit")."""
    return path.relative_to(CORE).with_suffix("").parts


@functools.cache
def imported(path):
    """(module imported, line) of every import from within core, also those inside functions; not those for type checkers alone."""
    return list(_imported(path))


def _imported(path):
    package = list(name_of(path))[:-1]
    tree = tree_of(path)
    for_types = {inner for node in ast.walk(tree) if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
                 for inner in ast.walk(node)}
    for node in ast.walk(tree):
        if node in for_types or not isinstance(node, ast.ImportFrom) or not node.level:
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
            there = target if CORE.joinpath(*target).is_dir() else target[:-1]
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


def test_no_file_is_too_long_to_be_read_at_once():
    code = [path for folder in ("core", "algorithms", "library", "processing_provider", "desktop", "tools", "tests")
            for path in (CORE.parent / folder).rglob("*.py")]
    assert len(code) > 500
    assert not {path.relative_to(CORE.parent).as_posix() for path in code if len(path.read_text(encoding="utf-8").splitlines()) > MOST_LINES}


@pytest.mark.parametrize("folder", sorted({path.parent for path in FILES}), ids=lambda folder: folder.relative_to(CORE).as_posix())
def test_a_folder_can_be_taken_in_at_a_glance(folder):
    assert len([path for path in folder.glob("*.py") if path.name != "__init__.py"]) <= MOST_FILES
    assert len(ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))) or "") > 40


def test_the_core_never_imports_qgis():
    for path in FILES:
        for node in ast.walk(tree_of(path)):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else \
                [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
            assert not any(name.split(".")[0] == "qgis" for name in names), path


def test_a_constant_has_one_value():
    """The same name for two numbers sends a reader to the wrong one."""
    values = defaultdict(lambda: defaultdict(list))
    for path in MODULES:
        for node in tree_of(path).body:
            if not isinstance(node, ast.Assign):
                continue
            for target in node.targets:
                pairs = zip(target.elts, node.value.elts) if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple) \
                    else [(target, node.value)]
                for one, value in pairs:
                    if isinstance(one, ast.Name) and one.id.isupper() and not one.id.startswith("_"):
                        values[one.id][ast.unparse(value)].append("/".join(name_of(path)))
    twice = {name: dict(found) for name, found in values.items() if len(found) > 1}
    assert not twice


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


def test_a_public_class_or_function_has_a_name_of_its_own():
    places = defaultdict(list)
    for path in MODULES:
        for node in tree_of(path).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_"):
                places[node.name].append("/".join(name_of(path)))
    assert not {name: found for name, found in places.items() if len(found) > 1}


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
