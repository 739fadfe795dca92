"""What can be sent to another process: a function by its name, what it reads from as a recipe, and plain settings."""

from __future__ import annotations

import hashlib
import io
import os
import pickle  # nosec B403
import struct
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any, BinaryIO
from uuid import uuid4

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.parallel import ordered_map
from ..common.progress import Progress
from .weights import EXECUTION

PACKAGE = __name__.rpartition(".core.")[0]   # whose functions are sent: the package of `core` and `products`


@dataclass(frozen=True)
class Recipe:
    """How a source is opened in another process."""

    function: str   # "module:name" within the package
    arguments: dict[str, Any]   # by name: plain values, or the Recipe of another source

    def open(self, opened: dict[Any, Any]) -> Any:
        """The source; sources that `opened` holds already, by their keys, are shared, and new ones are added."""
        key = self.key()
        if key is not None and key in opened:
            return opened[key]
        arguments = {name: value.open(opened) if isinstance(value, Recipe) else value for name, value in self.arguments.items()}
        source = named(self.function)(**arguments)
        if key is not None:
            opened[key] = source
        return source

    def key(self) -> Any:
        """What tells recipes of numbers, texts and such recipes apart; None for a recipe with other arguments."""
        values = [value.key() if isinstance(value, Recipe) else value for value in self.arguments.values()]
        alike = all(isinstance(value, (str, int, float, tuple)) for value in values)
        return (self.function, *self.arguments, *values) if alike else None


class NoSource:
    """What phases read from whose items hold all that they need, which is little."""

    def recipe(self, folder: Path) -> Recipe:
        return Recipe("core.execution.phase:NoSource", {})


@dataclass(frozen=True)
class Phase:
    """One step of the work, the same for all sections of road.

    function : public function of a module of the package, called as `function(source, item, *arguments)`. It changes nothing; its
        result, an item and the arguments are plain values (see `write_plain`)
    source : what it reads from, open in this process; its `recipe(folder)` puts into the folder what another process needs, unless it is
        there, and gives the Recipe
    together : so many items, one after the other along the road, are best given to one worker, which keeps what they share
    join : the result of an item from those of the two halves of its range of numbers; None where an item cannot be halved
    state : plain value that changes with what an item reads from the source, by which a later run knows its result again; None where none may
    """

    function: Callable[..., Any]
    source: Any
    arguments: tuple[Any, ...] = ()   # plain values that all items share
    place: Callable[[Any], str] = field(default=str, compare=False)   # names the stretch of road that an item is, for messages
    join: Callable[[list[Any]], Any] | None = field(default=None, compare=False)
    together: int = field(default=1, compare=False)
    state: Callable[[Any], Any] | None = field(default=None, compare=False)

    def result(self, item: Any) -> Any:
        """The result of one item, computed here."""
        return self.function(self.source, item, *self.arguments)


class Executor:
    """Who runs phases. What is not said otherwise is that of threads of this process.

    folder : that all workers see, for what phases write; None where the workers are threads of this process
    """

    folder: Path | None = None

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        """Yield the results of all items in their order.

        Parameters
        ----------
        phase, items : the work
        keep : a file for every item, which the executor may write the result to as soon as it is computed; it stays

        Raises
        ------
        Cancelled
            If the user cancelled.
        Exception
            Whatever the function raises.
        """
        raise NotImplementedError

    def run_together(self, phase: Phase, items: Sequence[Any], together: int, progress: Progress = Progress()) -> Iterator[Any]:
        """Yield the results of items of a phase whose function is given lists of them, `together` at most, and returns lists of results."""
        size = max(min(together, len(items) // EXECUTION.least_tasks), 1)
        for results in self.run(phase, [items[k:k + size] for k in range(0, len(items), size)], progress):
            yield from results

    def passing(self) -> Executor:
        """Who runs phases whose results are not worth keeping for a later run."""
        return self

    def disk_error(self, error: OSError) -> RoadExtractionError:
        """One sentence about the folder, which cannot be used."""
        return RoadExtractionError(f"A file cannot be written: {error}.")

    def sees(self, paths: Sequence[Path]) -> bool:
        """Whether all workers can read these files, which are point clouds."""
        return True

    def forget(self) -> None:
        """Free the memory in which workers keep what the phases before read from; no phase is running."""

    def release(self) -> None:
        """Free all memory that is of use in further phases alone; it is some time until the next one."""

    def close(self) -> None:
        """End what was started and remove what was written."""


def name_of(function: Any) -> str:
    """"module:name" of a function or class of the package.

    Raises TypeError if it is not a public one of a module of the package.
    """
    package, _, module = function.__module__.partition(f"{PACKAGE}.")
    if package or not module or "." in function.__qualname__ or function.__qualname__.startswith("<"):
        raise TypeError(f"{function.__module__}.{function.__qualname__} cannot be sent: it is not named in a module of {PACKAGE}.")
    return f"{module}:{function.__qualname__}"


@cache
def named(name: str) -> Any:
    module, _, attribute = name.partition(":")
    return getattr(import_module(f"{PACKAGE}.{module}"), attribute)


# Plain values in a file: numbers, texts, arrays, their lists and dictionaries, and objects of the package that consist of these.
#
# They are pickled, but for objects of the package, which are named with the values of their attributes. Reading such a file calls nothing but what
# puts arrays and these objects together: it runs nothing else that the file names.

FORMAT = b"LWplain3"   # at the beginning of a file; then the CRC-32 of all that follows, and the pickle
CHECKSUM = struct.Struct("<I")
CHECKED_AT_ONCE = 1 << 20   # cost: bytes, which fit the processor's cache


def write_plain(path: Path, value: Any, unfinished_in: Path | None = None) -> None:
    """Write a value to a file, which appears whole or not at all.

    path : of the file
    value : None, bool, int, float, str, numpy arrays and numbers, columns of texts, lists, tuples and dicts of these, and objects of classes of
        the package whose attributes are such values. A class may leave attributes out by `__getstate__`
    unfinished_in : folder on the same disk that has the unfinished file; by default that of the file

    Raises TypeError if it holds an object of anything else. OSError with a file name, if it cannot be written.
    """
    content = _pickled(value, _Writer)
    # processes of several machines may write the same file
    unfinished = (unfinished_in or path.parent) / f"{path.stem}.{uuid4().hex}.part{path.suffix}"
    try:
        with open(unfinished, "wb") as file:
            file.writelines((FORMAT, CHECKSUM.pack(zlib.crc32(content)), content))
        os.replace(unfinished, path)
    except OSError as error:
        if error.filename is None:   # of a full disk
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
    finally:
        unfinished.unlink(missing_ok=True)


def read_plain(path: Path) -> Any:
    """The value that `write_plain` wrote.

    Raises OSError if the file cannot be read, is none of these, or not as it was written; ImportError if it names anything but values.
    """
    return _Reader(io.BytesIO(_content(path))).load()


def is_whole(path: Path) -> bool:
    """Whether a file is there as `write_plain` wrote it, which it may not be after the power failed."""
    try:
        _content(path)
    except OSError:
        return False
    return True


def _content(path):
    """The pickle in a file."""
    with open(path, "rb") as file:
        if file.read(len(FORMAT)) != FORMAT:
            raise OSError(f"{path} is no file of ours")
        check, content = file.read(CHECKSUM.size), file.read()
    if check != CHECKSUM.pack(zlib.crc32(content)):
        raise OSError(f"{path} ends early, or was changed")
    return content


def checksum(file: BinaryIO, count: int = -1) -> int:
    """CRC-32 of the next `count` bytes of an open file, by default of all that follow."""
    check = 0
    while data := file.read(min(CHECKED_AT_ONCE, count) if count >= 0 else CHECKED_AT_ONCE):
        check, count = zlib.crc32(data, check), count - len(data) if count >= 0 else count
    return check


def digest(value: Any, without: str = "") -> str:
    """32 hexadecimal digits that two values of `write_plain` share only if they are equal.

    The text `without` does not count: the path of a folder that may be moved.
    """
    return hashlib.sha256(_pickled(value, partial(_Named, without) if without else _Writer, fast=True)).hexdigest()[:32]


def _pickled(value, writer, fast=False):
    """The bytes of a value; if `fast`, they do not depend on which of its parts are one object, only on what these are equal to."""
    file = io.BytesIO()
    # the first protocol for arrays beyond 4 GiB; the next one leaves arrays that may not be written to
    pickler = writer(file, 4)
    pickler.fast = fast
    pickler.dump(value)
    return file.getbuffer()


class _Writer(pickle.Pickler):
    def reducer_override(self, value):
        if isinstance(value, np.ndarray) and type(value) is not np.ndarray:   # of a file, say
            return np.asarray(value).__reduce__()
        if isinstance(value, (np.ndarray, np.generic, np.dtype)) or any(value is part for part in PARTS.values()):
            return NotImplemented
        return restored, (name_of(type(value)), _state(value))


class _Named(_Writer):
    """A writer of values in which a text does not count."""

    def __init__(self, without, *arguments):
        super().__init__(*arguments)
        self.without = without

    def persistent_id(self, value):
        return value.replace(self.without, "") if type(value) is str and self.without in value else None


class _Reader(pickle.Unpickler):
    def find_class(self, module, name):
        if name not in PARTS:
            raise ImportError(f"{module}.{name} is no part of a plain value")
        return PARTS[name]


def _state(value):
    """The attributes of an object by name."""
    getstate = type(value).__dict__.get("__getstate__")
    if getstate is not None:
        return getstate(value)
    return {attribute.name: getattr(value, attribute.name) for attribute in fields(value)} if is_dataclass(value) else vars(value)


def restored(name: str, state: dict[str, Any]) -> Any:
    """An object of a class of the package with the attributes of `_state`; called where a file is read."""
    kind = named(name)
    value = object.__new__(kind)
    restore = kind.__dict__.get("__setstate__")
    if restore is not None:
        restore(value, state)
    else:
        for attribute, content in state.items():
            object.__setattr__(value, attribute, content)   # of frozen classes, too
    return value


# what a file of a plain value may name: numpy's parts of arrays and numbers are called otherwise in other versions
PARTS: dict[str, Any] = {"ndarray": np.ndarray, "dtype": np.dtype, "_reconstruct": next(iter(np.array(()).__reduce__())),
                         "scalar": next(iter(np.float64().__reduce__())), "restored": restored}


# Phases run by threads of this process: for small surveys, and wherever nothing else works.

class Threads(Executor):
    """Executor that uses threads: `count` of them; None for one per processor core, at most four."""

    def __init__(self, count: int | None = None):
        self.count = count

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        return ordered_map(phase.result, items, progress, self.count)


THREADS = Threads()
