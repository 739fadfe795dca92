"""Work on sections side by side, results in order."""

import os
from collections import deque
from concurrent.futures import ThreadPoolExecutor

from .progress import Progress


def in_order(function, items, progress=Progress(), threads=None):
    """Yield function(item) for every item, in order, computed by a few threads.

    No more results wait than there are threads, so memory stays bounded. An
    error or a cancel stops the rest and is raised here. numpy and scipy release
    the interpreter lock in their heavy loops, which is where the time goes.
    """
    items = list(items)
    threads = threads or min(4, os.cpu_count() or 1)
    with ThreadPoolExecutor(threads) as pool:
        waiting, done = deque(), 0
        try:
            for item in items:
                waiting.append(pool.submit(function, item))
                if len(waiting) > threads:
                    yield waiting.popleft().result()
                    done += 1
                    progress.at(done / len(items))
            while waiting:
                yield waiting.popleft().result()
                done += 1
                progress.at(done / len(items))
        finally:
            for future in waiting:
                future.cancel()
