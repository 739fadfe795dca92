"""Worker threads with ordered results, work of this process while others do theirs, and cancellation of long work."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import Generic, TypeVar

from .errors import Cancelled
from .progress import Progress

POLL_INTERVAL = 0.2   # s between two checks for cancellation while a result is awaited
MAX_WORKERS = 4       # threads by default at most

_thread = threading.local()

Item = TypeVar("Item")
Result = TypeVar("Result")


def ordered_map(function: Callable[[Item], Result], items: Iterable[Item], progress: Progress = Progress(),
                threads: int | None = None) -> Iterator[Result]:
    """Apply a function to every item in several threads and yield the results in the order of the items.

    At most one result more than there are threads is computed ahead, so memory stays bounded. While a result is
    awaited, cancellation is checked too, by `progress` and by `check_cancelled`. numpy and scipy release the
    interpreter lock in their heavy loops, which is where most of the time is spent.

    Parameters
    ----------
    function : called with one item, in a worker thread
    items : items in order
    progress : reports the share of the items that are done
    threads : number of threads; by default one per processor core, at most four

    Yields
    ------
    function(item) for every item

    Raises
    ------
    Cancelled
        If the user cancelled; the worker threads end at their next `check_cancelled`.
    Exception
        Whatever `function` raises; the remaining items are dropped.
    """
    items = list(items)
    threads = threads or min(MAX_WORKERS, os.cpu_count() or 1)
    stop = threading.Event()

    def check_stopped() -> None:
        if stop.is_set():
            raise Cancelled

    def work(item: Item) -> Result:
        _thread.check = check_stopped
        return function(item)

    with ThreadPoolExecutor(threads) as pool:
        waiting: deque[Future[Result]] = deque()
        try:
            for done in range(len(items)):
                while len(waiting) <= threads and done + len(waiting) < len(items):
                    waiting.append(pool.submit(work, items[done + len(waiting)]))
                while not wait(list(waiting)[:1], POLL_INTERVAL).done:
                    progress.report(done / len(items))
                    check_cancelled()
                yield waiting.popleft().result()
                progress.report((done + 1) / len(items))
        finally:
            stop.set()
            for future in waiting:
                future.cancel()


@contextmanager
def cancellation_scope(progress: Progress) -> Iterator[None]:
    """Within this context, `check_cancelled` in the current thread checks `progress` for cancellation."""
    before = getattr(_thread, "check", None)
    _thread.check = progress.check_cancelled
    try:
        yield
    finally:
        _thread.check = before


def check_cancelled() -> None:
    """Check for cancellation in long work that has no `progress` argument.

    Raises
    ------
    Cancelled
        If the user cancelled (see `cancellation_scope`), or in a worker thread of `ordered_map` whose results are no
        longer used.
    """
    check = getattr(_thread, "check", None)
    if check is not None:
        check()


class InBackground(Generic[Result]):
    """A function that a thread of its own computes; use it as a context, which the thread does not outlive.

    Parameters
    ----------
    function : of a Progress; what it reads must not change meanwhile
    """

    def __init__(self, function: Callable[[Progress], Result]):
        self._function, self._heard = function, _Heard()
        self._found: list[Result] = []
        self._failed: BaseException | None = None
        self._thread = threading.Thread(target=self._work, daemon=True)

    def _work(self) -> None:
        try:
            with cancellation_scope(self._heard):
                self._found.append(self._function(self._heard))
        except BaseException as error:
            self._failed = error

    def __enter__(self) -> InBackground[Result]:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._heard.ended.set()
        self._thread.join()

    def result(self, progress: Progress = Progress()) -> Result:
        """What the function returns, as soon as it does; what it had to say is said now, in its order.

        Parameters
        ----------
        progress : Progress

        Raises
        ------
        Cancelled
            If the user cancelled.
        Exception
            Whatever the function raises.
        """
        while self._thread.is_alive():
            progress.check_cancelled()
            self._thread.join(POLL_INTERVAL)
        for say, text in self._heard.messages:
            getattr(progress, say)(text)
        if self._failed is not None:
            raise self._failed
        return self._found[0]


class _Heard(Progress):
    """Keeps messages, as a dialog is spoken to by one thread only, and ends work whose result is not wanted any more."""

    def __init__(self) -> None:
        self.messages: list[tuple[str, str]] = []
        self.ended = threading.Event()

    def report(self, fraction: float) -> None:
        self.check_cancelled()

    def check_cancelled(self) -> None:
        if self.ended.is_set():
            raise Cancelled

    def info(self, text: str) -> None:
        self.messages.append(("info", text))

    def warn(self, text: str) -> None:
        self.messages.append(("warn", text))
