"""Tasks that take turns, so that what they ask for at the same time is computed for all of them at once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Generator, Sequence
from typing import Any, TypeVar

from ....core.common.progress import Progress

Result = TypeVar("Result")
# A task yields (function, argument) and is sent the answer; the function takes the arguments of all tasks and returns their answers.
Steps = Generator[tuple[Callable[[list[Any]], Sequence[Any]], Any], Any, Result]

MOST_AT_ONCE = 200   # source: measured on maps of 80 to 300 roads: more tasks save no time, and cost memory


def side_by_side(tasks: Sequence[Steps[Result]], progress: Progress = Progress()) -> list[Result]:
    """The results of tasks.

    A fit of one road is many small steps, each of which costs numpy more to begin than to do. As the steps of all roads are made together, the
    cost of beginning is shared.
    """
    results: dict[int, Result] = {}
    waiting: dict[int, tuple[Callable[[list[Any]], Sequence[Any]], Any]] = {}

    def resume(number: int, answer: Any) -> None:
        try:
            waiting[number] = tasks[number].send(answer)
        except StopIteration as finished:
            results[number] = finished.value

    later = iter(range(len(tasks)))
    while len(results) < len(tasks):
        for number in (number for number, _ in zip(later, range(MOST_AT_ONCE - len(waiting)))):
            resume(number, None)
        asked: dict[Callable[[list[Any]], Sequence[Any]], dict[int, Any]] = defaultdict(dict)
        for number, (function, argument) in waiting.items():
            asked[function][number] = argument
        waiting.clear()
        for function, arguments in asked.items():
            for number, answer in zip(arguments, function(list(arguments.values()))):
                resume(number, answer)
        progress.report(len(results) / len(tasks))
    return [results[number] for number in range(len(tasks))]
