"""What the stages of the last run gave, kept in a window so that a run with other corrections or late settings goes on from where it differs.

A result is known by a digest of all that it depends on: the stages before it, settings, files and corrections. Of one run alone anything is kept.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any


class KeptRun:
    """The results of the stages of one run, in their order, from when `begin` is called until `end`; used by one run at a time."""

    def __init__(self) -> None:
        self.wanted, self._in_use = False, threading.Lock()
        # {stage: (digest, result, what frees its disk space, whether the next one is made from it)}
        self._results: dict[str, tuple[str, Any, Callable[[], None], bool]] = {}
        self._renewed: dict[str, tuple[Any, Callable[[], None]]] = {}   # results that the next ones are made from

    def begin(self) -> None:
        """Keep runs from now on."""
        self.wanted = True

    def end(self) -> None:
        """Keep no run any more, and free the disk space of the last one."""
        self.wanted = False
        if self.take():
            self.drop_from("")
            self.give_back()

    def take(self) -> bool:
        """Whether the caller may use it, until `give_back`; another run that is at work has it."""
        return self._in_use.acquire(blocking=False)

    def give_back(self) -> None:
        if not self.wanted:
            self.drop_from("")
        self._in_use.release()

    def known(self, stage: str, digest: str) -> bool:
        """Whether the result of a stage is here; if another one is, it goes, and so does all that came after it."""
        if stage in self._results and self._results[stage][0] != digest:
            self.drop_from(stage)
        return stage in self._results

    def before(self, stage: str) -> Any:
        """The last result of a stage that is renewed, which goes into the next one; None where there is none."""
        return self._renewed.pop(stage, (None,))[0]

    def result(self, stage: str) -> Any:
        return self._results[stage][1]

    def keep(self, stage: str, digest: str, result: Any, free: Callable[[], None], renewed: bool = False) -> None:
        """Keep the result of a stage. free : is called when it goes; renewed : it goes when the next one was made from it"""
        self._results[stage] = digest, result, free, renewed

    def drop_from(self, stage: str) -> None:
        """Let the results of a stage and of those after it go, the last ones first; of all for "" """
        for name in reversed(list(self._results)):
            _, result, free, renewed = self._results.pop(name)
            if renewed:
                self._renewed[name] = result, free
            else:
                free()
            if name == stage:
                return
        while not stage and self._renewed:
            self._renewed.popitem()[1][1]()


WINDOW = KeptRun()   # of the program's window, which calls its `begin`
