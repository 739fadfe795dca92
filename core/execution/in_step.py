"""Works on several roads, each of which needs one phase after the other: what several ask for at once is one phase."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any

from ..common.progress import Progress
from .phase import Executor, Items, NoSource, Phase


@dataclass(frozen=True)
class Asked:
    """What a work asks of a phase whose items hold all that they need.

    function, items, arguments : as of Phase and of `Executor.run`
    until : fraction of the work that is done then
    read : gives the answers that the result of an item holds
    """

    function: Callable[..., Any]
    items: Sequence[Any]
    until: float
    arguments: tuple[Any, ...] = ()
    read: Callable[[Any], list[Any]] = list


Work = Generator[Asked, list[Any], Any]   # yields what it asks for, is sent all answers to that, and returns its result


def in_step(works: Sequence[Work], executor: Executor, place: str, progress: Progress = Progress()) -> list[Any]:
    """The results of some works, whose phases are run together, as many as the work with the most steps has.

    Works that ask for one function at once give it the same arguments. place : names all works, for messages
    """
    results, begin = [None] * len(works), 0.0
    answers: dict[int, Any] = dict.fromkeys(range(len(works)))
    while answers:
        asked: dict[int, Asked] = {}
        for k, answer in answers.items():
            try:
                asked[k] = works[k].send(answer)
            except StopIteration as end:
                results[k] = end.value
        answers, until = {}, max((one.until for one in asked.values()), default=1.0)
        for function in dict.fromkeys(one.function for one in asked.values()):
            alike = {k: one for k, one in asked.items() if one.function is function}
            answers.update(zip(alike, _answered([*alike.values()], executor, place, progress.part(begin, until))))
        begin = until
    return results


def _answered(asked, executor, place, progress):
    """The answers to each of those who ask for one function."""
    places = [(one.items, k) for one in asked for k in range(len(one.items))]
    phase = Phase(asked[0].function, NoSource(), asked[0].arguments, lambda item: place, together=4)
    results = iter(executor.run(phase, Items(len(places), lambda n: places[n][0][places[n][1]]), progress) if places else ())
    return [[answer for _ in range(len(one.items)) for answer in one.read(next(results))] for one in asked]
