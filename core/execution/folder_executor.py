"""Phases run by other processes, who share points and results with the caller in a folder that all of them see."""

from __future__ import annotations

import concurrent.futures
import queue
import shutil
import tempfile
import time
import weakref
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count, islice
from pathlib import Path
from typing import Any
from uuid import uuid4

from ..common.errors import RoadExtractionError
from ..common.parallel import POLL_INTERVAL, check_cancelled
from ..common.progress import Progress
from .phase import Executor, Phase, name_of, paths_of, read_plain, write_plain
from .weights import EXECUTION


class KilledWorker(Exception):
    """Workers ended at a task; Dask has an exception of the same name."""


@dataclass
class _Part:
    """What becomes of an item of a phase, or of half of one, in a file, or in a list of files."""

    file: Any
    whole: _Part | None = None
    halves: tuple[_Part, ...] = ()
    done: bool = False


class FolderExecutor(Executor):
    """Executor that sends tasks of some items each to an executor of the standard library's kind, and shares a folder with its workers.

    work : folder of the user's in which that folder is made; None takes one for temporary files
    workers : how many there are
    least_together : items of a task, as `items_together`

    folder : own folder of the run, removed at the end; a phase is wanted as long as its file is there
    """

    folder: Path
    worker = "A worker"   # what messages call one

    def __init__(self, work: Path | None, workers: int, least_together: int):
        self.workers, self.least_together = workers, least_together
        self.folder = Path(tempfile.mkdtemp(prefix="lanewright-")) if work is None else work / f"run-{uuid4().hex[:8]}"
        self.folder.mkdir(exist_ok=True)
        # where nobody closes it
        self._left = weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        self._numbers = count()

    def new_pool(self) -> concurrent.futures.Executor:
        """Who computes the tasks of one phase."""
        raise NotImplementedError

    def task(self) -> Callable[..., Any]:
        """What the pool is given, with the arguments of `items_done`."""
        raise NotImplementedError

    def end_pool(self, pool: Any, phase: Path) -> None:
        """End what the pool still does for a phase whose file is gone."""
        raise NotImplementedError

    def check(self, work: Work) -> None:
        """Refuse to wait for what will not come; called while nothing does."""

    def lost(self, work: Work) -> RoadExtractionError:
        """One sentence about tasks of a phase that nobody does any more."""
        raise NotImplementedError

    def ended(self, place: str, last_words: str) -> RoadExtractionError:
        """One sentence about workers who ended, or ran out of memory, at a stretch of road."""
        raise NotImplementedError

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Any] = ()) -> Iterator[Any]:
        """Yield the results of all items in their order; see `Executor`. Successive ones go to one worker together.

        Raises RoadExtractionError of the phase; or if workers ended at half an item, the scheduler is lost, or the folder cannot be used.
        """
        if not len(items):
            return
        shipped = self.folder / f"phase{next(self._numbers)}.plain"
        work = Work(self, phase, shipped)
        try:
            write_plain(shipped, (name_of(phase.function), phase.source.recipe(self.folder), tuple(phase.arguments)))
            parts = [_Part(keep[k] if keep else self.new_file()) for k in range(len(items))]
            work.submit(parts, iter(items), items_together(phase, len(parts), self.workers, self.least_together))
            for part in parts:
                while not part.done:
                    progress.report(work.done / len(parts))
                    check_cancelled()
                    work.take()
                result = work.result(part)
                if not keep:
                    part.file.unlink(missing_ok=True)
                yield result
            progress.report(1.0)
        except OSError as error:
            raise self.disk_error(error) from error
        finally:
            shipped.unlink(missing_ok=True)
            self.end_pool(work.pool, shipped)

    def new_file(self) -> Path:
        return self.folder / f"file{next(self._numbers)}.plain"

    def close(self) -> None:
        self._left.detach()
        until = time.monotonic() + EXECUTION.close_time
        while self.folder.exists() and time.monotonic() < until:
            shutil.rmtree(self.folder, ignore_errors=True)


def items_together(phase: Phase, count: int, workers: int, usual: int = 1) -> int:
    """How many of the `count` items of a phase, one after the other along the road, one of some `workers` is given at once.

    As many as the phase asks for, at least the `usual` number, but no more than leave every worker some rounds of work.
    """
    return max(min(max(phase.together, usual), count // (EXECUTION.work_rounds * max(workers, 1))), 1)


class Work:
    """The tasks of a phase, each of some parts: sent, awaited, sent again part by part, then in halves."""

    def __init__(self, executor: FolderExecutor, phase: Phase, shipped: Path):
        self.executor, self.phase, self.shipped = executor, phase, shipped
        self.pool, self.done = executor.new_pool(), 0
        self.pending: dict[concurrent.futures.Future, tuple[Sequence[_Part], Path]] = {}
        self.heard = time.monotonic()   # when a task ended last
        self._ended: queue.SimpleQueue = queue.SimpleQueue()

    @property
    def name(self) -> str:
        return self.phase.function.__name__

    def submit(self, parts: Sequence[_Part], items: Iterator[Any], together: int = 1) -> None:
        """Send parts, so many successive ones in a task, with their items, which lie in a file from then on."""
        for k in range(0, len(parts), together):
            check_cancelled()
            task, file = parts[k:k + together], self.executor.new_file()
            write_plain(file, list(islice(items, len(task))))
            future = self.pool.submit(self.executor.task(), str(self.shipped), str(file),
                                      [[*map(str, part.file)] if isinstance(part.file, list) else str(part.file) for part in task])
            self.pending[future] = task, file
            future.add_done_callback(self._ended.put)

    def take(self) -> None:
        """Wait a moment for a task to end, and see what became of it."""
        try:
            future = self._ended.get(timeout=POLL_INTERVAL)
        except queue.Empty:
            self.executor.check(self)
            return
        self.heard = time.monotonic()
        parts, file = self.pending.pop(future)
        try:
            if future.cancelled():
                raise self.executor.lost(self)
            error = future.exception()
            if type(error).__name__ == KilledWorker.__name__:
                self._divide(parts, read_plain(file), str(error))
            else:
                self._answered(parts, file, future.result())
        finally:
            file.unlink(missing_ok=True)

    def _answered(self, parts, file, answer):
        if "refused" in answer:
            raise RoadExtractionError(answer["refused"])
        if "disk" in answer:
            raise OSError(answer["disk"])
        if "memory" in answer:
            self._divide(parts, read_plain(file), "")
        elif answer:
            at = self.phase.place(read_plain(file)[answer.get("at", 0)])
            raise RuntimeError(f"{self.executor.worker} failed at {at}:\n{answer.get('bug', answer)}")
        else:
            for part in parts:
                self._finish(part)

    def _finish(self, part):
        part.done = True
        if part.whole is None:
            self.done += 1
        elif all(half.done for half in part.whole.halves):
            write_plain(part.whole.file, self.phase.join([self.result(half) for half in part.whole.halves]), self.executor.folder)
            for half in part.whole.halves:
                half.file.unlink(missing_ok=True)
            self._finish(part.whole)

    def _divide(self, parts, items, last_words):
        """Send the parts of a task at which workers end one by one, or the halves of a single one; what is finished is not computed again.

        Refuses a single part that is half already, or cannot be halved.
        """
        if len(parts) > 1:
            self.submit(parts, iter(items))
            return
        part, item = parts[0], items[0]
        *place, first, last = item if self.phase.join else (0, 0)
        if part.whole is not None or last - first < 2:
            raise self.executor.ended(self.phase.place(item), last_words)
        middle = (first + last) // 2
        part.halves = _Part(self.executor.new_file(), part), _Part(self.executor.new_file(), part)
        self.submit(part.halves, iter([(*place, first, middle), (*place, middle, last)]))

    def result(self, part: _Part) -> Any:
        until = time.monotonic() + EXECUTION.result_time
        while not all(path.exists() for path in paths_of(part.file)) and time.monotonic() < until:
            time.sleep(POLL_INTERVAL)
        return [*map(read_plain, part.file)] if isinstance(part.file, list) else read_plain(part.file)
