"""Results of one run, remembered for the next one, which may ask much the same."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ..common.progress import Progress
from .phase import THREADS, Executor, NoSource, Phase, digest, name_of


class RememberedResults(Executor):
    """Executor that remembers, from one run to the next, the results of phases whose items hold all that they need."""

    def __init__(self) -> None:
        self.executor: Executor = THREADS
        self._before: dict[str, Any] = {}   # results of the run before and of this one, by digests of what they depend on
        self._results: dict[str, Any] = {}

    def of_next_run(self, executor: Executor) -> RememberedResults:
        """The same for the next run, whose work another executor does."""
        self.executor, self.folder = executor, executor.folder
        self._before, self._results = self._results or self._before, {}
        return self

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        if not isinstance(phase.source, NoSource):
            yield from self.executor.run(phase, items, progress, keep)
            return
        names = [digest((name_of(phase.function), phase.arguments, item)) for item in items]
        self._results.update((name, self._before[name]) for name in names if name in self._before)
        missing = {name: item for name, item in zip(names, items) if name not in self._results}
        results = self.executor.run(phase, list(missing.values()), progress)
        for name in names:
            if name in missing:
                del missing[name]   # a later item may be the same
                self._results[name] = next(results)
            yield self._results[name]
        progress.report(1.0)
