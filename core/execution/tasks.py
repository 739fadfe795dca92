"""What a worker does: opens what a phase reads from, once, and computes one item after the other."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .phase import Recipe, named
from .plain import read_plain, write_plain

OPEN_PHASES = 2   # phases kept open in a worker: the current one and the one before


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
    """Computes items of phases that lie in files."""

    def __init__(self) -> None:
        self._open: OrderedDict[Path, tuple[Any, Any, tuple[Any, ...]]] = OrderedDict()
        self._sources: dict[Any, Any] = {}   # sources that several phases share, by the keys of their recipes

    def do(self, phase: Path, item: Path, result: Path) -> None:
        """Compute one item.

        Parameters
        ----------
        phase : file of a ShippedPhase
        item : file of the item
        result : file that the result is written to
        """
        function, source, arguments = self._phase(phase)
        write_plain(result, function(source, read_plain(item), *arguments))

    def _phase(self, path):
        if path not in self._open:
            shipped: ShippedPhase = read_plain(path)
            self._open[path] = named(shipped.function), shipped.source.open(self._sources), shipped.arguments
            while len(self._open) > OPEN_PHASES:
                self._open.popitem(last=False)
        return self._open[path]
