"""What the algorithms name in the rooms of the program."""

import ast
import functools
from pathlib import Path

import lanewright.algorithms.rooms as rooms
import pytest


def chains(tree):
    """`core.io.crs.parse_crs` of every such name in a file, as long as it goes."""
    inner = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and id(node) not in inner:
            root = node
            while isinstance(root, ast.Attribute):
                root = root.value
            if isinstance(root, ast.Name) and root.id in ("core", "products", "simulator"):
                yield ast.unparse(node)


@pytest.mark.parametrize("path", sorted(Path(rooms.__file__).parent.glob("*.py")), ids=lambda path: path.stem)
def test_what_an_algorithm_names_in_a_room_is_there(path):
    for chain in chains(ast.parse(path.read_text(encoding="utf-8"))):
        root, *names = chain.split(".")
        assert functools.reduce(getattr, names, getattr(rooms, root)) is not None, chain
