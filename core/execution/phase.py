"""What can be sent to another process: a function by its name, what it reads from as a recipe, and plain settings."""

from __future__ import annotations

import hashlib
import json
import os
import struct
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cache
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
    listed : the function is given a list of so many items at most, and returns one of their results; 0 where it is given one item
    join : the result of an item from those of the two halves of the range of numbers at its end; None where an item cannot be halved
    state : plain value that changes with what an item reads from the source, by which a later run knows its result again; None where none may
    """

    function: Callable[..., Any]
    source: Any
    arguments: tuple[Any, ...] = ()   # plain values that all items share
    place: Callable[[Any], str] = field(default=str, compare=False)   # names the stretch of road that an item is, for messages
    join: Callable[[list[Any]], Any] | None = field(default=None, compare=False)
    together: int = field(default=1, compare=False)
    state: Callable[[Any], Any] | None = field(default=None, compare=False)
    listed: int = field(default=0, compare=False)

    def result(self, item: Any) -> Any:
        """The result of one item, computed here."""
        return self.function(self.source, item, *self.arguments)


class Items(Sequence[Any]):
    """The `count` items of a phase, each of which is made by its number when it is given to a worker: together they would take much memory."""

    def __init__(self, count: int, make: Callable[[int], Any]):
        self._count, self._make = count, make

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, number: Any) -> Any:
        if number >= self._count:
            raise IndexError
        return self._make(number)


class Executor:
    """Who runs phases. What is not said otherwise is that of threads of this process.

    folder : that all workers see, for what phases write; None where the workers are threads of this process
    work : the same where it is the user's, and all that phases write stays there
    """

    folder: Path | None = None
    work: Path | None = None

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Any] = ()) -> Iterator[Any]:
        """Yield the results of all items in their order.

        phase, items : the work
        keep : a file for every item, or a list of files where its result is a list, which is written as soon as it is computed, and stays

        Raises Cancelled if the user cancelled.
        Raises Exception: whatever the function raises.
        """
        raise NotImplementedError

    def run_together(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Any] = ()) -> Iterator[Any]:
        """Yield the results of all items, of which the function may be given lists."""
        if not phase.listed:
            yield from self.run(phase, items, progress, keep)
            return
        size = max(min(phase.listed, len(items) // EXECUTION.least_tasks), 1)
        lists = Items(-(-len(items) // size), lambda k: [items[number] for number in range(k * size, min((k + 1) * size, len(items)))])
        for results in self.run(phase, lists, progress, [list(keep[k:k + size]) for k in range(0, len(keep), size)]):
            yield from results

    def stand_on(self, what: str, facts: dict[str, Any], progress: Progress) -> None:
        """Have what is kept from here on depend on facts of the whole survey: {what messages call it: plain value}."""

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


@cache
def name_of(function: Any) -> str:
    """"module:name" of a function or class of the package. Raises TypeError if it is not a public one of a module of the package."""
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
# Reading such a file runs nothing that it holds: it names classes of the package and the values of their attributes.

# A file: FORMAT, the CRC-32 of all that follows, the length of a JSON text, that text (how the arrays belong together; kind, shape and order
# of each), the bytes of the arrays. An .npz, whose arrays have headers and checksums of their own, takes nine times as long to write
# and read
FORMAT = b"LWplain4"
CHECKSUM, TEXT_LENGTH = struct.Struct("<I"), struct.Struct("<q")
CHECKED_AT_ONCE = 1 << 20   # cost: bytes, which fit the processor's cache


def write_plain(path: Path, value: Any, unfinished_in: Path | None = None) -> None:
    """Write a value to a file, which appears whole or not at all.

    path : of the file
    value : None, bool, int, float, str, numpy arrays and numbers, columns of texts, lists, tuples and dicts of these, and objects of classes of
        the package whose attributes are such values. A class may leave attributes out by `__getstate__`, which gives what it is made of anew
    unfinished_in : folder on the same disk that has the unfinished file; by default that of the file

    Raises TypeError if it holds anything else. OSError with a file name, if it cannot be written.
    """
    contents, check = _contents(value), 0
    for part in contents:
        check = zlib.crc32(part, check)
    # processes of several machines may write the same file
    unfinished = (unfinished_in or path.parent) / f"{path.stem}.{uuid4().hex}.part{path.suffix}"
    try:
        with open(unfinished, "wb") as file:
            file.write(FORMAT + CHECKSUM.pack(check))
            file.writelines(contents)
        os.replace(unfinished, path)
    except BaseException as error:
        unfinished.unlink(missing_ok=True)
        if isinstance(error, PermissionError) and path.exists():
            return   # on Windows, while another run reads what it, too, has written there
        if isinstance(error, OSError) and error.filename is None:   # of a full disk
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise


def _contents(value):
    """What follows the checksum in the file of a value: bytes, and arrays of bytes."""
    arrays: list[np.ndarray] = []
    tree = _tree(value, arrays)
    # as they lie in memory, so that whoever reads them computes with the same order of numbers
    turned = [array.ndim > 1 and array.flags.f_contiguous and not array.flags.c_contiguous for array in arrays]
    text = json.dumps([tree, [[np.lib.format.dtype_to_descr(array.dtype), array.shape, last] for array, last in zip(arrays, turned)]]).encode()
    return [TEXT_LENGTH.pack(len(text)) + text, *(np.ascontiguousarray(array.T if last else array).reshape(-1).view(np.uint8)
                                                                  for array, last in zip(arrays, turned))]


def write_results(file: Any, value: Any, unfinished_in: Path | None = None) -> None:
    """Write the result of an item to a file, or those of a list of items to a list of files."""
    for path, one in zip(paths_of(file), value if isinstance(file, list) else [value]):
        write_plain(path, one, unfinished_in)


def paths_of(file: Any) -> list[Path]:
    """The file of a result, or those of a list of results."""
    return [*map(Path, file)] if isinstance(file, list) else [Path(file)]


def read_plain(path: Path, see: Callable[[str], None] = lambda text: None) -> Any:
    """The value that `write_plain` wrote; `see` is given the JSON text of all but its arrays.

    Raises OSError if the file cannot be read, is none of these, or not as it was written.
    """
    content = _content(path)
    (length,) = TEXT_LENGTH.unpack_from(content)
    place = TEXT_LENGTH.size + length
    text = content[TEXT_LENGTH.size:place].decode()
    see(text)
    tree, layouts = json.loads(text)
    arrays = {}
    for k, (kind, shape, last) in enumerate(layouts):
        dtype = np.lib.format.descr_to_dtype(kind if isinstance(kind, str) else [tuple(column) for column in kind])
        if dtype.hasobject:
            raise TypeError("An array of objects is no plain value.")
        array: np.ndarray = np.ndarray(shape[::-1] if last else shape, dtype, content, place).copy()
        arrays[f"a{k}"], place = array.T if last else array, place + array.nbytes
    return _value(tree, arrays)


def _content(path):
    """What follows the checksum in a file."""
    with open(path, "rb", buffering=0) as file:
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


SEAL = struct.Struct("<I")   # CRC-32 of what comes before it in a finished file


def is_sealed(path: Path) -> bool:
    """Whether a file is there and ends with the SEAL of what comes before, which it may not after the power failed."""
    try:
        with open(path, "rb", buffering=0) as file:
            end = os.fstat(file.fileno()).st_size - SEAL.size
            return end >= 0 and checksum(file, end) == SEAL.unpack(file.read(SEAL.size))[0]
    except OSError:
        return False


def digest(value: Any, without: str = "") -> str:
    """32 hexadecimal digits that two values of `write_plain` share only if they are equal.

    The text `without` does not count: the path of a folder that may be moved.
    """
    arrays: list[np.ndarray] = []
    text = json.dumps(_tree(value, arrays))
    sha = hashlib.sha256((text.replace(json.dumps(without)[1:-1], "") if without else text).encode())
    for array in arrays:
        sha.update(f"{array.dtype.str}{array.shape}".encode())
        sha.update(np.ascontiguousarray(array).tobytes())
    return sha.hexdigest()[:32]


PLAIN = frozenset({type(None), bool, str, int, float})   # what JSON holds as it is


def _tree(value, arrays):
    """The value as JSON, in which numbers of arrays stand for these."""
    kind = type(value)
    if kind in PLAIN:
        return value
    if kind in (list, tuple):
        return {kind.__name__: _trees(value, arrays)}
    if isinstance(value, (np.ndarray, np.generic)):
        return _tree_of_array(value, arrays)
    if kind is dict:
        return {"dict": [_trees(pair, arrays) for pair in value.items()]}
    if is_dataclass(value) and "__getstate__" not in kind.__dict__:
        return {"fields": name_of(kind), "values": _trees((getattr(value, name) for name in _field_names(kind)), arrays)}
    state = kind.__dict__.get("__getstate__", vars)(value)
    return {"object": name_of(kind), "state": dict(zip(state, _trees(state.values(), arrays)))}


def _trees(values, arrays):
    return [item if type(item) in PLAIN else _tree(item, arrays) for item in values]


def _tree_of_array(value, arrays):
    if isinstance(value, np.generic) and value.dtype.kind in "biuf" and value.dtype.itemsize <= 8:
        return {"number": [value.dtype.str, value.item()]}
    if value.dtype.hasobject:
        if value.ndim != 1 or any(type(text) is not str for text in value):
            raise TypeError("An array of objects is no plain value.")
        return {"texts": value.tolist()}
    arrays.append(np.asarray(value))
    return {"array" if isinstance(value, np.ndarray) else "scalar": f"a{len(arrays) - 1}"}


@cache
def _field_names(kind):
    return [attribute.name for attribute in fields(kind)]


def _value(tree, arrays):
    if type(tree) is not dict:
        return tree
    kind, content = next(iter(tree.items()))
    if kind in ("list", "tuple"):
        items = _values(content, arrays)
        return items if kind == "list" else tuple(items)
    if kind == "fields":
        return _object(named(content), dict(zip(_field_names(named(content)), _values(tree["values"], arrays))))
    if kind == "object":
        return _object(named(content), dict(zip(tree["state"], _values(tree["state"].values(), arrays))))
    if kind == "number":
        return np.dtype(content[0]).type(content[1])
    if kind == "texts":
        return np.array(content, object)
    if kind == "array":
        return arrays[content]
    if kind == "scalar":
        return arrays[content][()]
    return dict(_values(pair, arrays) for pair in content)


def _values(trees, arrays):
    return [_value(tree, arrays) if type(tree) is dict else tree for tree in trees]


def _object(kind, state):
    """An object of a class of core, made of what its `__getstate__` gave, or with these attributes."""
    if "__getstate__" in kind.__dict__:
        return kind(**state)
    value = object.__new__(kind)
    vars(value).update(state)   # of frozen classes, too
    return value


# Phases run by threads of this process: for small surveys, and wherever nothing else works.

class Threads(Executor):
    """Executor that uses threads: `count` of them; None for one per processor core, at most four."""

    def __init__(self, count: int | None = None):
        self.count = count

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Any] = ()) -> Iterator[Any]:
        def kept(numbered):
            item, file = numbered
            result = phase.result(item)
            if keep:
                write_results(file, result)
            return result

        return ordered_map(kept, Items(len(items), lambda k: (items[k], keep[k] if keep else None)), progress, self.count)


THREADS = Threads()
