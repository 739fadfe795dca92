"""Works that each need one phase after the other, on several roads or of several kinds: what is asked for at once is run as one phase."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass
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

    phase, items : as of `Executor.run_together`; works that ask for one function at once ask the same of it
    until : fraction of the work that is done then
    read : gives the answers that the result of an item holds
    """

    phase: Phase
    items: Sequence[Any]
    until: float
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
    progress.report(1.0)
    return results


def _answered(asked, executor, progress):
    """The answers to each of those who ask."""
    phases, places = {one.phase.function: one.phase for one in asked if len(one.items)}, [(one, k) for one in asked for k in range(len(one.items))]

    def item(n):
        one, k = places[n]
        return (name_of(one.phase.function), one.items[k]) if len(phases) > 1 else one.items[k]

    results = iter(executor.run_together(_joined([*phases.values()], executor.folder), Items(len(places), item), progress) if places else ())
    return [[answer for _ in range(len(one.items)) for answer in one.read(next(results))] for one in asked]


# Several phases run as one: an item is the name of a function and an item of its own.


class _Phases:
    """What several phases read from: each by the name of its function; shared : {name: its arguments, and `listed`}."""

    def __init__(self, shared: Mapping[str, tuple[tuple[Any, ...], int]], **sources: Any):
        self.shared = shared
        self.phases = {name: Phase(named(name), sources[name], arguments, listed=listed) for name, (arguments, listed) in shared.items()}

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open what they read from."""
        return Recipe("core.execution.in_step:_Phases", dict({name: phase.source.recipe(folder) for name, phase in self.phases.items()},
                                                            shared=self.shared))


def _joined(phases, folder):
    """The phase that does the items of several; where a folder lies does not matter."""
    if len(phases) < 2:
        return phases[0]
    by_name = {name_of(phase.function): phase for phase in phases}
    shared = {name: digest(phase.arguments, str(folder or "")) for name, phase in by_name.items()}
    known = all(phase.state is not None or isinstance(phase.source, NoSource) for phase in phases)

    def asked(attribute, name, item):
        """What a function of its phase, None for none, tells of an item."""
        function = getattr(by_name[name], attribute)
        return function and function([item] if by_name[name].listed else item)

    source = _Phases({name: (phase.arguments, phase.listed) for name, phase in by_name.items()},
                     **{name: phase.source for name, phase in by_name.items()})
    return Phase(items_of_phases, source, (), lambda items: asked("place", *items[0]),
                 state=(lambda items: [(shared[name], asked("state", name, item)) for name, item in items]) if known else None,
                 listed=min(phase.listed or EXECUTION.items_per_task for phase in phases))


def items_of_phases(source: _Phases, items: Sequence[tuple[str, Any]]) -> list[Any]:
    """The phase: the results of items of several phases, those of one together where its function is given lists."""
    results: list[Any] = []
    for name, of_phase in groupby(items, itemgetter(0)):
        phase, alike = source.phases[name], [item for _, item in of_phase]
        results += phase.result(alike) if phase.listed else map(phase.result, alike)
    return results
