"""What can be sent to another process: a function by its name, what it reads from as a recipe, and plain settings."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from ..common.errors import RoadExtractionError
from ..common.progress import Progress

CORE = __name__.rpartition(".execution.")[0]   # name of the package `core`


@dataclass(frozen=True)
class Recipe:
    """How a source is opened in another process.

    function : "module:name" within core
    arguments : by name: plain values, or the Recipe of another source
    """

    function: str
    arguments: dict[str, Any]

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


class Source(Protocol):
    """What a phase reads from."""

    def recipe(self, folder: Path) -> Recipe:
        """Put into the folder what another process needs, unless it is there, and say how the source is opened."""


class NoSource:
    """What phases read from whose items hold all that they need, which is little."""

    def recipe(self, folder: Path) -> Recipe:
        """There is nothing to open."""
        return Recipe("execution.phase:NoSource", {})


def no_place(item: Any) -> str:
    """What messages call an item of which nothing is known."""
    return str(item)


def no_size(item: Any) -> float:
    """The size of items that are alike."""
    return 0.0


@dataclass(frozen=True)
class Phase:
    """One step of the work, the same for all sections of road.

    function : public function of a module of core, called as `function(source, item, *arguments)`. It changes nothing; its
        result, an item and the arguments are plain values (see plain.py)
    source : what it reads from, open in this process
    arguments : plain values that all items share
    place : names the stretch of road that an item is, for messages
    size : tells items apart by how long they take; any unit
    together : so many items, one after the other along the road, are best given to one worker, which keeps what they share
    join : the result of an item from those of the two halves of its range of numbers; None where an item cannot be halved
    """

    function: Callable[..., Any]
    source: Any
    arguments: tuple[Any, ...] = ()
    place: Callable[[Any], str] = field(default=no_place, compare=False)
    size: Callable[[Any], float] = field(default=no_size, compare=False)
    join: Callable[[list[Any]], Any] | None = field(default=None, compare=False)
    together: int = field(default=1, compare=False)

    def result(self, item: Any) -> Any:
        """The result of one item, computed here."""
        return self.function(self.source, item, *self.arguments)


class Executor(Protocol):
    """Who runs phases."""

    @property
    def folder(self) -> Path | None:
        """That all workers see, for what phases write; None where the workers are threads of this process."""

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        """Yield the results of all items in their order.

        Parameters
        ----------
        phase, items : the work
        progress : Progress
        keep : a file for every item, which the executor may write the result to as soon as it is computed; it stays

        Raises
        ------
        Cancelled
            If the user cancelled.
        Exception
            Whatever the function raises.
        """

    def passing(self) -> Executor:
        """Who runs phases whose results are not worth keeping for a later run."""

    def disk_error(self, error: OSError) -> RoadExtractionError:
        """One sentence about the folder, which cannot be used."""

    def sees(self, paths: Sequence[Path]) -> bool:
        """Whether all workers can read these files, which are point clouds."""

    def forget(self) -> None:
        """Free the memory in which workers keep what the phases before read from; no phase is running."""

    def release(self) -> None:
        """Free all memory that is of use in further phases alone; it is some time until the next one."""

    def close(self) -> None:
        """End what was started and remove what was written."""


def name_of(function: Any) -> str:
    """ "module:name" of a function or class of core.

    Raises
    ------
    TypeError
        If it is not a public one of a module of core.
    """
    package, _, module = function.__module__.partition(f"{CORE}.")
    if package or not module or "." in function.__qualname__ or function.__qualname__.startswith("<"):
        raise TypeError(f"{function.__module__}.{function.__qualname__} cannot be sent: it is not named in a module of {CORE}.")
    return f"{module}:{function.__qualname__}"


def named(name: str) -> Any:
    """The function or class that `name_of` named."""
    module, _, attribute = name.partition(":")
    return getattr(import_module(f"{CORE}.{module}"), attribute)
