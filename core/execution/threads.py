"""Phases run by threads of this process: for small surveys, and wherever nothing else works."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError
from ..common.parallel import ordered_map
from ..common.progress import Progress
from .phase import Phase


class Threads:
    """Executor that uses threads.

    Parameters
    ----------
    count : number of threads; None for one per processor core, at most four
    """

    def __init__(self, count: int | None = None):
        self.count = count
        self.folder: Path | None = None

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        """Yield the results of all items in their order; see `Executor`. Nothing is kept by it."""
        return ordered_map(phase.result, items, progress, self.count)

    def passing(self) -> Threads:
        """Itself: it keeps nothing."""
        return self

    def disk_error(self, error: OSError) -> RoadExtractionError:
        """One sentence about a folder that cannot be used."""
        return RoadExtractionError(f"A file cannot be written: {error}.")

    def sees(self, paths: Sequence[Path]) -> bool:
        """What this process sees."""
        return True

    def forget(self) -> None:
        """Nothing is kept between phases."""

    def release(self) -> None:
        """Nothing is kept between phases."""

    def close(self) -> None:
        """Nothing is left to end."""


THREADS = Threads()
