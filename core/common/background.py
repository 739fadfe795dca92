"""Work of this process that goes on while others, such as worker processes, do theirs."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from .errors import Cancelled
from .parallel import POLL_INTERVAL, cancellation_scope
from .progress import Progress

Result = TypeVar("Result")


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
