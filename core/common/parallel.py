"""Work on sections side by side, results in order."""

import os
import threading
from collections import deque
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager

from .errors import Cancelled
from .progress import Progress

POLL_INTERVAL = 0.2   # s between two questions whether to go on, while a result is waited for

_thread = threading.local()


def ordered_map(function, items, progress=Progress(), threads=None):
    """Yield function(item) for every item, in order, computed by a few threads.

    No more results wait than there are threads, so memory stays bounded. An
    error or a cancel stops the rest and is raised here; a cancel is heard while a
    result is waited for too, and ends the workers at their next `check_cancelled`. numpy and scipy
    release the interpreter lock in their heavy loops, which is where the time goes.
    """
    items = list(items)
    threads = threads or min(4, os.cpu_count() or 1)
    stop = threading.Event()

    def ask():
        if stop.is_set():
            raise Cancelled

    def work(item):
        _thread.ask = ask
        return function(item)

    with ThreadPoolExecutor(threads) as pool:
        waiting = deque()
        try:
            for done in range(len(items)):
                while len(waiting) <= threads and done + len(waiting) < len(items):
                    waiting.append(pool.submit(work, items[done + len(waiting)]))
                while not wait(list(waiting)[:1], POLL_INTERVAL).done:
                    progress.report(done / len(items))
                yield waiting.popleft().result()
                progress.report((done + 1) / len(items))
        finally:
            stop.set()
            for future in waiting:
                future.cancel()


@contextmanager
def cancellation_scope(progress):
    """While this lasts, `check_cancelled` in this thread asks `progress` whether to go on."""
    before = getattr(_thread, "ask", None)
    _thread.ask = progress.check_cancelled
    try:
        yield
    finally:
        _thread.ask = before


def check_cancelled():
    """Called now and then in long work that has no `progress` at hand.

    Raises
    ------
    Cancelled
        Where the user pressed Cancel (`cancellation_scope`), or in a thread of `ordered_map` whose results
        are no longer taken.
    """
    ask = getattr(_thread, "ask", None)
    if ask is not None:
        ask()
