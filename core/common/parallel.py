"""Worker threads with ordered results, and cancellation of long work."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import TypeVar

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
