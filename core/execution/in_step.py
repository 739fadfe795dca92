"""Works that each need one phase after the other, on several roads or of several kinds: what is asked for at once is run as one phase."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import Any

from ..common.progress import Progress
from .phase import Executor, Items, NoSource, Phase, Recipe, digest, name_of, named
from .weights import EXECUTION


@dataclass(frozen=True)
class Asked:
    """What a work asks of a phase.

    phase, items : as of `Executor.run`; works that ask for one function at once ask the same of it
    until : fraction of the work that is done then
    together : how many items at most the function is given as a list, as of `Executor.run_together`; 0 where it is given one
    read : gives the answers that the result of an item holds
    """

    phase: Phase
    items: Sequence[Any]
    until: float
    together: int = 0
    read: Callable[[Any], list[Any]] = lambda result: [result]


Work = Generator[Asked, list[Any], Any]   # yields what it asks for, is sent all answers to that, and returns its result


def in_step(works: Sequence[Work], executor: Executor, progress: Progress = Progress()) -> list[Any]:
    """The results of some works, whose phases are run together, as many as the work with the most steps has."""
    results, begin = [None] * len(works), 0.0
    answers: dict[int, Any] = dict.fromkeys(range(len(works)))
    while answers:
        asked: dict[int, Asked] = {}
        for k, answer in answers.items():
            try:
                asked[k] = works[k].send(answer)
            except StopIteration as end:
                results[k] = end.value
        until = max((one.until for one in asked.values()), default=1.0)
        answers = dict(zip(asked, _answered([*asked.values()], executor, progress.part(begin, until))))
        begin = until
    return results


def _answered(asked, executor, progress):
    """The answers to each of those who ask."""
    parts = {one.phase.function: one for one in asked if len(one.items)}
    places = [(one, k) for one in asked for k in range(len(one.items))]
    if len(parts) > 1:
        items = Items(len(places), lambda n: (name_of(places[n][0].phase.function), places[n][0].items[places[n][1]]))
        together = min(one.together or EXECUTION.items_per_task for one in parts.values())
        results = executor.run_together(_joined({name_of(function): one for function, one in parts.items()}), items, together, progress)
    else:
        items = Items(len(places), lambda n: places[n][0].items[places[n][1]])
        results = iter(())
        for one in parts.values():
            phase = one.phase if one.together else replace(one.phase, together=EXECUTION.items_per_task)
            results = executor.run_together(phase, items, one.together, progress)
    return [[answer for _ in range(len(one.items)) for answer in one.read(next(results))] for one in asked]


# Several phases run as one: an item is the name of a function and an item of its own.


@dataclass(frozen=True)
class _Phases:
    """What several phases read from: each by the name of its function, and whether that is given lists."""

    phases: Mapping[str, tuple[Phase, bool]]

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open what they read from."""
        return Recipe("core.execution.in_step:_phases", dict(
            {name: phase.source.recipe(folder) for name, (phase, _) in self.phases.items()},
            shared={name: (phase.arguments, listed) for name, (phase, listed) in self.phases.items()}))


def _phases(shared: Mapping[str, tuple[tuple[Any, ...], bool]], **sources: Any) -> _Phases:
    """What `_Phases.recipe` describes."""
    return _Phases({name: (Phase(named(name), sources[name], arguments), listed) for name, (arguments, listed) in shared.items()})


def _joined(parts):
    """The phase that does the items of all parts: {name of the function: Asked}."""
    phases = {name: one.phase for name, one in parts.items()}
    source = _Phases({name: (one.phase, bool(one.together)) for name, one in parts.items()})

    @cache
    def shared(name):
        return digest(phases[name].arguments)

    def state(items):
        return [(shared(name), (of := phases[name].state) and of([item] if parts[name].together else item)) for name, item in items]

    def place(items):
        name, item = items[0]
        return phases[name].place([item] if parts[name].together else item)

    known = all(phase.state is not None or isinstance(phase.source, NoSource) for phase in phases.values())
    return Phase(items_of_phases, source, (), place, state=state if known else None)


def items_of_phases(source: _Phases, items: Sequence[tuple[str, Any]]) -> list[Any]:
    """The phase: the results of items of several phases, those of one together where its function is given lists."""
    results: list[Any] = []
    for name, of_phase in groupby(items, itemgetter(0)):
        phase, listed = source.phases[name]
        alike = [item for _, item in of_phase]
        results += phase.result(alike) if listed else map(phase.result, alike)
    return results
