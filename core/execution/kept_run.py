"""The stages of a run in a window, whose results hold open files: as long as they depend on the same, the next run goes on from them.

QGIS loads this when it starts, also where numpy is missing.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .keep import Keep


class KeptRun:
    """The last two results of each stage of a run while it is `wanted`, by a digest of all that it depends on; used by one run at a time.

    phases, free : the Keep of these runs, and what frees the disk space of their points
    """

    def __init__(self) -> None:
        self.wanted, self._in_use = False, threading.Lock()
        self.phases: Keep | None = None
        self.free: Callable[[], None] = lambda: None
        self._results: dict[str, dict[str, Any]] = {}   # of each stage, the last one at the end

    def end(self) -> None:
        """Keep no run any more, and free the disk space of the last one."""
        self.wanted = False
        if self.take():
            self.give_back()

    def take(self) -> bool:
        """Whether the caller may use it, until `give_back`; another run that is at work has it."""
        return self._in_use.acquire(blocking=False)

    def give_back(self) -> None:
        if not self.wanted or self.phases is not None and self.phases.full:
            self.drop()
        self._in_use.release()

    def drop(self) -> None:
        """Let all results go, and free the disk space of the points."""
        self.free()
        self._results, self.phases, self.free = {}, None, lambda: None

    def known(self, stage: str, digest: str) -> bool:
        """Whether the result of a stage is here, which is the last one then; where that of the first stage is another one, all go."""
        results = self._results.get(stage, {})
        if digest in results:
            results[digest] = results.pop(digest)
        elif stage == next(iter(self._results), ""):
            self.drop()
        return digest in results

    def result(self, stage: str) -> Any:
        return next(reversed(self._results[stage].values()))

    def before(self, stage: str) -> Any:
        """The last result of a stage that the next one is made from, and is no result any more; None where there is none."""
        return self._results[stage].popitem()[1] if self._results.get(stage) else None

    def keep(self, stage: str, digest: str, result: Any) -> None:
        results = self._results.setdefault(stage, {})
        results[digest] = result
        if len(results) > 2:
            del results[next(iter(results))]


WINDOW = KeptRun()   # of the program's window, which wants it
