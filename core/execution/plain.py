"""Plain values in a file: numbers, texts, arrays, their lists and dictionaries, and objects of core that consist of these.

Reading such a file runs nothing that it holds: it names classes of core and the values of their attributes.
"""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from .phase import name_of, named

TREE = "tree"   # the entry of the file that says how the arrays belong together


def write_plain(path: Path, value: Any, unfinished_in: Path | None = None) -> None:
    """Write a value to a file, which appears whole or not at all.

    Parameters
    ----------
    path : of the file, ending in .npz
    value : None, bool, int, float, str, numpy arrays and numbers, lists, tuples and dicts of these, and objects of classes of
        core whose attributes are such values. A class may leave attributes out by `__getstate__`
    unfinished_in : folder on the same disk that has the unfinished file; by default that of the file

    Raises
    ------
    TypeError
        If it holds anything else.
    """
    arrays: list[np.ndarray] = []
    text = json.dumps(_tree(value, arrays))
    # processes of several machines may write the same file
    unfinished = (unfinished_in or path.parent) / f"{path.stem}.{uuid4().hex}.part.npz"
    try:
        np.savez(unfinished, **{TREE: np.frombuffer(text.encode(), np.uint8), **{f"a{k}": array for k, array in enumerate(arrays)}})
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def read_plain(path: Path) -> Any:
    """The value that `write_plain` wrote."""
    with np.load(path, allow_pickle=False) as entries:
        arrays = {name: entries[name] for name in entries.files}
    return _value(json.loads(arrays.pop(TREE).tobytes().decode()), arrays)


def digest(value: Any, without: str = "") -> str:
    """32 hexadecimal digits that two values share only if they are equal.

    Parameters
    ----------
    value : as in `write_plain`
    without : a text that does not count, such as the path of a folder that may be moved
    """
    arrays: list[np.ndarray] = []
    text = json.dumps(_tree(value, arrays))
    found = hashlib.sha256((text.replace(json.dumps(without)[1:-1], "") if without else text).encode())
    for array in arrays:
        found.update(f"{array.dtype.str}{array.shape}".encode())
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()[:32]


def _tree(value, arrays):
    """The value as JSON, in which numbers of arrays stand for these."""
    if value is None or isinstance(value, (bool, str)) or type(value) in (int, float):
        return value
    if isinstance(value, np.generic) and value.dtype.kind in "biuf" and value.dtype.itemsize <= 8:
        return {"number": [value.dtype.str, value.item()]}
    if isinstance(value, (np.ndarray, np.generic)):
        if value.dtype.hasobject:
            raise TypeError("An array of objects is no plain value.")
        arrays.append(np.asarray(value))
        return {"array" if isinstance(value, np.ndarray) else "scalar": f"a{len(arrays) - 1}"}
    if isinstance(value, dict):
        return {"dict": [[_tree(key, arrays), _tree(one, arrays)] for key, one in value.items()]}
    if type(value) in (list, tuple):
        return {type(value).__name__: [_tree(one, arrays) for one in value]}
    return {"object": name_of(type(value)), "state": [[name, _tree(one, arrays)] for name, one in _state(value).items()]}


def _state(value):
    """The attributes of an object by name."""
    own = type(value).__dict__.get("__getstate__")
    if own is not None:
        return own(value)
    return {one.name: getattr(value, one.name) for one in fields(value)} if is_dataclass(value) else vars(value)


def _value(tree, arrays):
    if not isinstance(tree, dict):
        return tree
    kind = next(iter(tree))
    if kind == "number":
        name, number = tree[kind]
        return np.dtype(name).type(number)
    if kind in ("array", "scalar"):
        return arrays[tree[kind]] if kind == "array" else arrays[tree[kind]][()]
    if kind == "dict":
        return {_value(key, arrays): _value(one, arrays) for key, one in tree[kind]}
    if kind in ("list", "tuple"):
        return (list if kind == "list" else tuple)(_value(one, arrays) for one in tree[kind])
    made = object.__new__(named(tree["object"]))
    state = {name: _value(one, arrays) for name, one in tree["state"]}
    restore = type(made).__dict__.get("__setstate__")
    if restore is not None:
        restore(made, state)
    else:
        for name, one in state.items():
            object.__setattr__(made, name, one)   # of frozen classes, too
    return made
