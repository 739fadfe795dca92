"""What a worker does: opens what a phase reads from, once, and computes one item after the other."""

from __future__ import annotations

import threading
import traceback
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..common.errors import Cancelled, RoadExtractionError
from ..common.parallel import free_memory, is_lack_of_memory
from .phase import Phase, Recipe, named, read_plain, write_plain

OPEN_PHASES = 2   # phases kept open in a worker: the current one and the one before
WORK_ROUNDS = 8   # of work that a worker has in a phase at least, where its items come several together, so that all end at about the same time


def items_together(phase: Phase, count: int, workers: int, usual: int = 1) -> int:
    """How many items, one after the other along the road, a worker is given at once.

    Parameters
    ----------
    phase : Phase, which may ask for some
    count : of all its items
    workers : that share them
    usual : where the phase asks for fewer; in any case there are no more than leave every worker some rounds of work
    """
    return max(min(max(phase.together, usual), count // (WORK_ROUNDS * max(workers, 1))), 1)


@dataclass(frozen=True)
class ShippedPhase:
    """A Phase in a file.

    function : "module:name" within core
    source : Recipe
    arguments : plain values
    """

    function: str
    source: Recipe
    arguments: tuple[Any, ...]


class Tasks:
    """Computes items of phases that lie in files; several threads may share it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._open: OrderedDict[Path, tuple[Any, Any, tuple[Any, ...]]] = OrderedDict()
        self._sources: dict[Any, Any] = {}   # sources that several phases share, by the keys of their recipes

    def answer(self, phase: Path, item: Path, result: Path) -> dict[str, str]:
        """Compute one item.

        Parameters
        ----------
        phase : file of a ShippedPhase
        item : file of the item
        result : file that the result is written to; unfinished, it lies beside the phase

        Returns
        -------
        empty, or what went wrong: one of the keys "refused", "cancelled", "memory", "disk" and "bug", and words
        """
        try:
            function, source, arguments = self._phase(phase)
            write_plain(result, function(source, read_plain(item), *arguments), phase.parent)
        except RoadExtractionError as error:
            return {"refused": str(error)}
        except Cancelled:
            return {"cancelled": "the caller has ended the phase"}
        except Exception as error:
            if is_lack_of_memory(error):
                return {"memory": "out of memory"}
            return {"disk": str(error)} if isinstance(error, OSError) else {"bug": traceback.format_exc()}
        return {}

    def forget(self) -> None:
        """Close what is kept open between items, and return its memory to the operating system; no item is being computed."""
        with self._lock:
            self._open.clear()
            self._sources.clear()
        free_memory()

    def _phase(self, path):
        with self._lock:
            if path not in self._open:
                shipped: ShippedPhase = read_plain(path)
                self._open[path] = named(shipped.function), shipped.source.open(self._sources), shipped.arguments
                while len(self._open) > OPEN_PHASES:
                    self._open.popitem(last=False)
            return self._open[path]


def raise_answer(answer: dict[str, str], phase: Phase, item: Any, worker: str) -> None:
    """Raise what went wrong with an item, in the words for users.

    Parameters
    ----------
    answer : of `Tasks.answer`
    phase, item : that were asked for
    worker : what messages call the worker

    Raises
    ------
    RoadExtractionError
        Of the phase, or if the worker ran out of memory.
    OSError
        If a file could not be read or written.
    RuntimeError
        Of a bug, with its traceback.
    """
    if "refused" in answer:
        raise RoadExtractionError(answer["refused"])
    if "memory" in answer:
        raise RoadExtractionError(f"{worker} ran out of memory at {phase.place(item)}. Try fewer workers.")
    if "disk" in answer:
        raise OSError(answer["disk"])
    if answer:
        raise RuntimeError(f"{worker} failed at {phase.place(item)}:\n{answer.get('bug', answer)}")
