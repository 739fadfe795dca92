"""What a rule weighs: the lines and the numbers at module level that nothing but it uses."""

import ast
from collections import defaultdict
from functools import cache
from pathlib import Path

import lanewright.core

CORE = Path(lanewright.core.__file__).parent


@cache
def _core():
    """{(file, name): node} of what stands at module level, and {name: {(file, name) that mention it}}."""
    nodes, users = {}, defaultdict(set)
    for path in sorted(CORE.rglob("*.py")):
        module = ".".join(path.relative_to(CORE).with_suffix("").parts)
        for k, node in enumerate(ast.parse(path.read_text(encoding="utf-8")).body):
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                continue
            targets = getattr(node, "targets", [getattr(node, "target", node)])
            names = [one.id for target in targets for one in ast.walk(target) if isinstance(one, ast.Name)] \
                if isinstance(node, (ast.Assign, ast.AnnAssign)) else [getattr(node, "name", f"statement {k}")]
            for name in names:
                nodes[module, name] = node
                for one in ast.walk(node):
                    if isinstance(one, (ast.Name, ast.Attribute)):
                        users[one.id if isinstance(one, ast.Name) else one.attr].add((module, name))
    return nodes, users


@cache
def module_of(path, name):
    """The file of a function or class, found in a file or room: in the one that is named or, where it has moved, in the room about it."""
    nodes, _ = _core()
    name = name.split(".")[0]
    while True:
        found = {module for module, known in nodes if known == name and f"{module}.".startswith(f"{path}.")}
        if len(found) == 1:
            return found.pop()
        if found or "." not in path:
            raise LookupError(f"{name} is in {', '.join(sorted(found)) or 'no file'} of {path}")
        path = path.rpartition(".")[0]


@cache
def _uses(module, name):
    """What mentions a name, itself left out; a private name is its own file's."""
    nodes, users = _core()
    return {user for user in users[name] if nodes[user] is not nodes[module, name] and (not name.startswith("_") or user[0] == module)}


def rule_parts(rule):
    """{(file, name)} of a rule: what is listed, "room.file", "room" or "room.file:function", and all that nothing else uses."""
    nodes, _ = _core()
    parts = set()
    for one in filter(None, rule):
        path, _, name = one.partition(":")
        parts |= {(module_of(path, name), name.split(".")[0])} if name else {key for key in nodes if f"{key[0]}.".startswith(f"{path}.")}
    beside = {key: users for key in nodes if key not in parts and (users := _uses(*key))}
    while more := {key for key, users in beside.items() if users <= parts} - parts:
        parts |= more
    return parts


def weight(switch):
    """Lines of a rule, and its numbers at module level."""
    nodes, _ = _core()
    methods = [place.partition(":")[2] for place in switch.rule if "." in place.partition(":")[2]]
    found = {id(nodes[key]): nodes[key] for key in rule_parts([place for place in switch.rule if place.partition(":")[2] not in methods])}
    for place in switch.rule:
        path, _, name = place.partition(":")
        if name in methods:
            one, method = name.split(".")
            found.update((id(node), node) for node in nodes[module_of(path, name), one].body if getattr(node, "name", "") == method)
    numbers = sum(isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value is not None
                  and any(isinstance(one, ast.Constant) and type(one.value) in (int, float) for one in ast.walk(node.value))
                  for node in found.values())
    return sum(node.end_lineno - node.lineno + 1 + len(getattr(node, "decorator_list", ())) for node in found.values()), numbers
