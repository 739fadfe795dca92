"""Results of one run, remembered for the next ones over the same survey, which may ask much the same."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..common.parallel import free_memory
from ..common.progress import Progress
from .phase import THREADS, Executor, Items, NoSource, Phase, digest, name_of
from .weights import EXECUTION


class RememberedResults(Executor):
    """Executor that remembers the results of phases whose items hold all that they need, or that say in which state they read the rest.

    A few that are missing are computed by threads: workers take longer to start. So is what a later run asks for a whole road at once.
    """

    def __init__(self, executor: Executor):
        self.executor, self.folder = executor, executor.folder
        self._results: dict[str, Any] = {}   # by digests of what they depend on
        self._first = 0   # how many there were after the first run
        # all but the work itself is that of the executor
        self.sees, self.disk_error, self.forget, self.release, self.close = (  # type: ignore[method-assign]
            executor.sees, executor.disk_error, executor.forget, executor.release, executor.close)

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        return self.run_together(replace(phase, listed=0), items, progress)

    def run_together(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress()) -> Iterator[Any]:
        """As of `Executor`; each item is remembered by itself, whatever others it comes with."""
        if phase.state is None and not isinstance(phase.source, NoSource):
            yield from self.executor.run_together(phase, items, progress)
            return
        shared, state = digest((name_of(phase.function), phase.arguments)), phase.state or (lambda item: None)
        names = [digest((shared, item, state([item] if phase.listed else item))) for item in items]
        missing = {name: k for k, name in enumerate(names) if name not in self._results}
        rows = list(missing.values())
        few = 2 * len(rows) < len(names) or self._first and len(rows) <= EXECUTION.few_items
        results = iter((THREADS if few else self.executor).run_together(phase, Items(len(rows), lambda k: items[rows[k]]), progress))
        for name in names:
            if name in missing:
                del missing[name]   # a later item may be the same
                self._results[name] = next(results)
            yield self._results[name]
        progress.report(1.0)

    @property
    def full(self) -> bool:
        """Whether so much is remembered that the next run had better begin anew; asked between two runs."""
        self._first = self._first or len(self._results)
        return len(self._results) > EXECUTION.runs_remembered * self._first

    def clear(self) -> None:
        """Remember nothing any more, and remove the files of the folder, which nobody reads."""
        self._results, self._first = {}, 0
        free_memory()   # Windows removes no file that is held open
        for path in self.folder.glob("points-*.bin") if self.folder is not None else ():
            path.unlink(missing_ok=True)
