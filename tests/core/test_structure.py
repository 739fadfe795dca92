"""The order of the rooms of `core`, `products` and `simulator`, and the words in them, read from the code itself."""

import ast
import functools
import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted(path for top in ("core", "products", "simulator") for path in (ROOT / top).rglob("*.py") if "__pycache__" not in path.parts)
MODULES = [path for path in FILES if path.name != "__init__.py"]
CODE = FILES + sorted(path for top in ("algorithms", "library", "desktop", "processing_provider")
                      for path in (ROOT / top).rglob("*.py")) + [ROOT / "__init__.py", ROOT / "plugin.py"]
# Each room imports only from those before it
ORDER = tuple(f"core/{name}" for name in ("lazy", "common", "execution", "countries", "io", "curves", "survey", "road", "intensity", "markings",
                                          "driving", "corrections", "pipeline")) + \
    tuple(f"products/{name}" for name in ("inspection", "scanline_layer", "published_markings", "inventory", "surface", "cloud", "assess",
                                          "export", "cad", "client_fields", "overlay", "report")) + ("simulator",)
# Module-level numbers of each room: every one is a decision that a reader must know
NUMBERS = {
    "core/common": 11,
    "core/execution": 3,
    "core/countries": 5,
    "core/io": 5,
    "core/curves": 9,
    "core/survey": 74,
    "core/road": 17,
    "core/intensity": 14,
    "core/markings": 45,
    "core/driving": 5,
    "core/corrections": 2,
    "core/pipeline": 2,
    "products/inspection": 8,
    "products/scanline_layer": 6,
    "products/published_markings": 9,
    "products/inventory": 147,
    "products/surface": 20,
    "products/cloud": 0,
    "products/export": 149,
    "products/client_fields": 0,
    "products/assess": 18,
    "products/overlay": 77,
    "products/report": 36,
    "simulator": 151,
}


@functools.cache
def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


@functools.cache
def nodes_of(path):
    """All of its nodes, from the outermost inward."""
    return tuple(ast.walk(tree_of(path)))


def name_of(path):
    """`core/road/edges/fit.py` -> ("core", "road", "edges", "fit")."""
    return path.relative_to(ROOT).with_suffix("").parts


def room_of(name):
    """("core", "road", "edges", "fit") -> "core/road"; None for `core` or `products` itself."""
    return name[0] if name[0] == "simulator" else "/".join(name[:2]) if len(name) > 1 else None


@functools.cache
def imports_of(path):
    """(import, whether it is for type checkers alone) of every import of a file, also those inside functions."""
    nodes = nodes_of(path)
    typing = {inner for node in nodes if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
              for inner in ast.walk(node)}
    return [(node, node in typing) for node in nodes if isinstance(node, (ast.Import, ast.ImportFrom))]


@functools.cache
def imported(path, for_types=False):
    """(module imported, line) of every import from these rooms, also those inside functions; those for type checkers alone on wish."""
    return [(target, line) for target, line, _ in named_imports(path, for_types)]


def named_imports(path, for_types=False):
    """(module, line, name) of the same."""
    package = list(name_of(path))[:-1]
    for node, typing in imports_of(path):
        if (typing and not for_types) or not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = package[:len(package) - (node.level - 1)] + (node.module.split(".") if node.module else [])
        for alias in node.names:
            inner = (*base, alias.name)
            is_module = ROOT.joinpath(*inner).with_suffix(".py").exists() or ROOT.joinpath(*inner, "__init__.py").exists()
            yield (inner if is_module else tuple(base)), node.lineno, alias.name


def test_the_code_is_read_by_the_oldest_python_there_is():
    """Python 3.9, which QGIS brings on macOS, wants parentheses around what is named within an index, and knows no `|` of types but in hints."""
    for path in CODE:
        text = path.read_text(encoding="utf-8")
        for node in nodes_of(path):
            if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.NamedExpr):
                before = text.splitlines()[node.slice.lineno - 1][:node.slice.col_offset]
                assert before.rstrip().endswith("("), f"{path.relative_to(ROOT)}, line {node.slice.lineno}"
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp) and isinstance(node.value.op, ast.BitOr):
                assert getattr(node.value.right, "value", "") is not None, f"{path.relative_to(ROOT)}, line {node.lineno}"


def test_imports_run_one_way_between_folders():
    wrong = [f"{'/'.join(name_of(path))}.py, line {line}: {room_of(name_of(path))} imports {'/'.join(target)}" for path in MODULES
             for target, line in imported(path) if ORDER.index(room_of(target)) > ORDER.index(room_of(name_of(path)))]
    assert not wrong


def test_products_and_the_simulator_use_public_names_of_the_chain_alone():
    """Those that `core/__init__.py` lists, each with the file that defines it."""
    from lanewright.core import PUBLIC

    chain = set(ORDER[ORDER.index("core/survey"):ORDER.index("core/pipeline") + 1])
    used = {(".".join(target[1:]), name) for path in MODULES if name_of(path)[0] != "core" for target, _, name in named_imports(path, True)
            if room_of(target) in chain}
    assert used == {(module, name) for module, names in PUBLIC.items() for name in names}


def test_no_two_folders_import_each_other():
    """Sub-folders too: `road/edges` -> `road/common` never comes with `road/common` -> `road/edges`."""
    arrows = defaultdict(dict)
    for path in MODULES:
        folder = name_of(path)[:-1]
        for target, line in imported(path):
            # the table of weights of a room lies below all of its sub-folders
            there = target if ROOT.joinpath(*target).is_dir() or target[-1] == "weights" else target[:-1]
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


NUMBER = re.compile(r"(?<![\w.\[])(?:[3-9]|\d+\.\d|\d\d+|\d+e)")   # other than 0, 1 and 2, and no index


def numbers_of(path):
    """Assignments at module level of a number, or of a table with numbers, to a name in capitals: (name, its first line, that behind it)."""
    for node in tree_of(path).body:
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) and node.value else []
        if targets and all(isinstance(target, ast.Name) and target.id.isupper() for target in targets) \
                and any(isinstance(part, ast.Constant) and type(part.value) in (int, float) for part in ast.walk(node.value)):
            yield targets[0].id, node.lineno - 1, node.end_lineno


@pytest.mark.parametrize("room", NUMBERS)
def test_the_numbers_of_a_room_may_only_become_fewer(room):
    """Who takes a number out writes the new count into NUMBERS; who needs one more finds one that can be derived."""
    assert sum(len(list(numbers_of(path))) for path in MODULES if room_of(name_of(path)) == room) == NUMBERS[room]


@pytest.mark.parametrize("room", [room for room in NUMBERS if room.startswith("core/") and room != "core/countries"])
def test_a_number_of_the_chain_says_where_it_comes_from(room):
    """`source` (a standard, a publication, a measurement), `derived` (follows from others or from how a thing is built), or `cost` (changes time and
    memory, never a result); a weight stands in the table of its room, weights.py."""
    untagged = []
    for path in MODULES:
        if room_of(name_of(path)) == room and path.name != "weights.py":
            lines = path.read_text(encoding="utf-8").splitlines()
            for name, first, last in numbers_of(path):
                while first and lines[first - 1].startswith("#"):
                    first -= 1
                if not NUMBER.search(" ".join(line.partition("#")[0].partition("=")[2] for line in lines[first:last])):
                    continue   # zero, one and two count, halve and double
                if not any(f"{tag}:" in line for line in lines[first:last] for tag in ("source", "derived", "cost")):
                    untagged.append(f"{path}: {name}")
    assert not untagged


def test_a_folder_says_what_it_is_for():
    for folder in sorted({path.parent for path in FILES}):
        assert len(ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))) or "") > 40, folder


def test_none_of_them_imports_qgis():
    for path in FILES:
        for node, _ in imports_of(path):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else \
                [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else []
            assert not any(name.split(".")[0] == "qgis" for name in names), path


def test_public_names_are_used_outside_their_file():
    """What one file alone uses begins with an underscore: a reader may change it without looking farther."""
    code = [path for folder in ("core", "products", "simulator", "algorithms", "library", "processing_provider", "desktop", "tests", "tools")
            for path in (ROOT / folder).rglob("*.py") if "__pycache__" not in path.parts] + [ROOT / "CONTRIBUTING.md"]
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


def documented(text):
    """Names that a docstring explains, each at the beginning of a line; what is returned or yielded is indented, or stands behind that word."""
    lines = [said.group(1) for line in text.splitlines() if (said := re.match(r"(\*{0,2}\w+(?:, \*{0,2}\w+)*) : ", line))]
    return {name.strip(" *") for names in lines for name in names.split(",")}


def test_a_docstring_explains_no_parameter_that_is_not_there():
    gone = []
    for path in MODULES:
        for name, node in public(path):
            arguments = node.args
            there = {argument.arg for argument in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
                     if argument is not None}
            extra = documented(ast.get_docstring(node) or "") - there
            if extra:
                gone.append(f"{'/'.join(name_of(path))}.py, {name}: {', '.join(sorted(extra))}")
    assert not gone


PRONOUNS = {"found", "own", "said", "told"}   # of something that has a name


def test_no_pronoun_is_a_name():
    functions = [(path, node) for path in CODE for node in nodes_of(path) if isinstance(node, (ast.FunctionDef, ast.Lambda))]
    assert not [f"{path.relative_to(ROOT)}, line {node.lineno}" for path, function in functions for node in ast.walk(function)
                if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in PRONOUNS
                or isinstance(node, ast.arg) and node.arg in PRONOUNS]
