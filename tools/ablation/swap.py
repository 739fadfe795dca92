"""Functions of the core replaced for a while, wherever they were imported, or watched: would the stand-in have given the same?"""

import pickle
import pkgutil
import sys
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from functools import cache
from importlib import import_module

import lanewright.core
import numpy as np

from .switches import Around
from .weight import module_of

PREFIX = "lanewright.core."
NUMBERS = bool, int, float, np.generic
HOLDERS = "lanewright.", "accuracy."   # modules that may have imported a function of the core


@cache
def _all_loaded():
    """Every module of the core is loaded before anything is replaced: one that came later would keep the stand-in."""
    for module in pkgutil.walk_packages(lanewright.core.__path__, PREFIX):
        import_module(module.name)


def original_of(place):
    """What a place, "room.file:function" or "room.file:Class.method", holds, and the class if it is a method."""
    path, _, name = place.partition(":")
    owner = import_module(PREFIX + module_of(path, name))
    *classes, name = name.split(".")
    for one in classes:
        owner = getattr(owner, one)
    return getattr(owner, name), owner if classes else None


def _holders(place):
    """[(module or class, name)] through which the core finds a function."""
    _all_loaded()
    original, owner = original_of(place)
    name = place.rsplit(":")[-1].split(".")[-1]
    if owner is not None:
        return [(owner, name)]
    return [(module, name) for module in [sys.modules[key] for key in sorted(sys.modules) if key.startswith(HOLDERS)]
            if vars(module).get(name) is original]


@contextmanager
def replaced(swaps):
    """Places of the core replaced by stand-ins.

    swaps : ((place, stand-in, or Around one), ...)
    """
    undo = []
    try:
        for place, stand_in, holders in [(place, stand_in, _holders(place)) for place, stand_in in swaps]:
            new = stand_in.make(original_of(place)[0]) if isinstance(stand_in, Around) else stand_in
            for holder, name in holders:
                undo.append((holder, name, vars(holder)[name]))
                # a method of the class itself is called without the class
                setattr(holder, name, staticmethod(new) if isinstance(vars(holder)[name], (classmethod, staticmethod)) else new)
        yield
    finally:
        for holder, name, old in reversed(undo):
            setattr(holder, name, old)


class Watch:
    """Which switches would make a difference, and in which stages.

    Attributes
    ----------
    stage : that runs now
    felt : {switch: {stages in which a stand-in would have given something else}}
    called : {switch}
    """

    def __init__(self, switches):
        self.switches, self.stage = switches, ""
        self.felt, self.called = {switch.name: set() for switch in switches}, set()

    @contextmanager
    def watching(self):
        by_place = {}
        for switch in self.switches:
            for place, stand_in in switch.swaps:
                by_place.setdefault(place, []).append((switch, stand_in))
        with replaced([(place, Around(lambda original, noted=noted: self._watched(original, noted))) for place, noted in by_place.items()]):
            yield

    def _watched(self, original, noted):
        def watched(*arguments, **named):
            given = []
            for switch, stand_in in noted:
                self.called.add(switch.name)
                if self.stage in self.felt[switch.name]:
                    continue
                if isinstance(stand_in, Around):
                    self.felt[switch.name].add(self.stage)
                else:
                    instead = _tried(stand_in, arguments, named)
                    # a list may be changed by the original
                    given.append((switch, list(instead) if isinstance(instead, list) else instead))
            result = original(*arguments, **named)
            for switch, instead in given:
                if not same(result, instead):
                    self.felt[switch.name].add(self.stage)
            return result

        return watched


def _tried(stand_in, arguments, named):
    try:
        return stand_in(*arguments, **named)
    except Exception as problem:   # the run without the rule will say it
        return problem


def same(one, other):
    """Whether two results are equal; what cannot be compared counts as different."""
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        one, other = np.asarray(one), np.asarray(other)
        if one.dtype != object and other.dtype != object:
            # a number may stand for an array of it
            shapes = one.shape == other.shape or other.ndim == 0
            return shapes and bool(np.all((one == other) | (one != one) & (other != other)))
        return one.shape == other.shape and all(map(same, one.ravel(), other.ravel()))
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if is_dataclass(one) and type(one) is type(other):
        return all(same(getattr(one, field.name), getattr(other, field.name)) for field in fields(one))
    if isinstance(one, NUMBERS) and isinstance(other, NUMBERS):
        return bool(one == other or one != one and other != other)
    if type(one) is type(other) and isinstance(one, (str, set, slice)):
        return one == other
    try:
        return pickle.dumps(one) == pickle.dumps(other)
    except Exception:
        return False
