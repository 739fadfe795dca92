"""Crossings, compound clusters and figures: worker processes find in small tasks what threads find together, to the last bit."""

from contextlib import closing

import numpy as np
import pytest
from lanewright.core.countries.painted_symbols import SYMBOLS
from lanewright.core.driving.alignment import curves_of_lanes
from lanewright.core.execution.in_step import Asked, in_step
from lanewright.core.execution.keep import Keep
from lanewright.core.execution.phase import NoSource, Phase, Threads
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.execution.tasks import find_interpreter
from lanewright.core.markings.objects import cluster as phases
from lanewright.core.markings.objects.cluster import asked, combs_of_windows, pieces_of_clusters
from lanewright.core.markings.objects.figures import figure_of_cells, figures_of
from lanewright.core.markings.road_grid import CELL_SIZE

RNG = np.random.default_rng(3)


def patch_of_paint(s0, s1, d0, d1):
    """(N, 2) units of 0.1 mm, points of a painted rectangle."""
    return RNG.integers((s0 * 10_000, d0 * 10_000), (s1 * 10_000, d1 * 10_000), (int(900 * (s1 - s0) * (d1 - d0)) + 9, 2)).astype(np.int32)


# a line that a stop line touches, the stripes of a crossing, and dashes
COMPOUND = np.concatenate([patch_of_paint(0, 14, 1.0, 1.15), patch_of_paint(13.6, 14, -3.0, 1.15)])
STRIPES = [patch_of_paint(20, 24, d, d + 0.5) for d in range(-4, 4)]
DASHES = [patch_of_paint(s, s + 3, 0.0, 0.12) for s in range(30, 80, 9)]


def figure(symbol):
    """Cells of 4 cm of a figure that is drawn as large as most of its kind."""
    image = figures_of(symbol)[0].image
    width, height = (round(sum(limits) / 2 / CELL_SIZE) for limits in (symbol.width, symbol.height))
    column, row = np.meshgrid(np.arange(width) * image.shape[1] // width, np.arange(height) * image.shape[0] // height)
    return np.argwhere((image > 0.3 * image.max())[row, column])


def asking_all():
    """A work that asks for all, and gives the answers."""
    clusters = [COMPOUND, *STRIPES, *DASHES]
    s, d = np.concatenate(clusters).T.copy()
    bounds = np.cumsum([0, *map(len, clusters)])
    members = [np.arange(*ends) for ends in zip(bounds, bounds[1:])]

    def columns(rows):
        return s[rows], d[rows], np.zeros(len(rows), np.uint16), s[rows], d[rows]

    spots = np.unique(np.concatenate(STRIPES + DASHES) // 400, axis=0) * 0.04
    windows = [np.flatnonzero(np.abs(spots[:, 0] - station) < 2.5) for station in range(18, 80, 3)]
    combs = yield asked(combs_of_windows, lambda rows: (spots[rows],), [rows for rows in windows if len(rows) > 3], 0.2)
    pieces = yield asked(pieces_of_clusters, columns, members, 0.4, [number < 4 for number in range(len(members))])
    shown = [*map(figure, SYMBOLS), np.argwhere(np.ones((9, 30)))]
    compared = Phase(figure_of_cells, NoSource(), (), str)
    figures = yield Asked(compared, [(cells, np.zeros(len(cells))) for cells in shown], 1.0)
    return ([comb and (comb.middle.tobytes(), comb.heading, comb.pitch, comb.phase, comb.coherence) for comb in combs],
            [(None if parts is None else parts.tobytes(), of_parts) for parts, of_parts in pieces],
            [type(value) for _, shapes in pieces for shape in shapes for value in vars(shape).values()], figures)


def found_by(executor, works=1):
    """The results of all phases of some works."""
    with closing(executor):
        return in_step([asking_all() for _ in range(works)], executor)


@pytest.mark.slow
def test_worker_processes_find_what_threads_find(monkeypatch):
    (combs, pieces, _, figures), = known = found_by(Threads(1))
    assert set(figures) == {"bicycle", "bus", ""} and figures[-1] == ""
    assert sum(comb is not None for comb in combs) >= 2 and None in combs
    (parts, of_parts), (whole, alone) = pieces[0], pieces[-1]
    assert parts is not None and len(of_parts) >= 2 and whole is None and len(alone) == 1 and len(pieces) == len(STRIPES) + len(DASHES) + 1
    assert found_by(Threads(3)) == known
    monkeypatch.setattr(phases, "TASK_POINTS", 200)
    assert found_by(WorkerProcesses(find_interpreter(), 1)) == known
    assert found_by(Threads(2), 3) == 3 * known


def test_where_a_cluster_changes_the_tasks_of_others_stay_as_they_were():
    """A corrected curb at the beginning of a road changes few tasks of the whole road."""
    sizes = np.random.default_rng(3).integers(20, 900, 5000)

    def tasks(sizes):
        cuts = phases._lasting_cuts(np.cumsum([7, *sizes]), 20_000)
        assert cuts[0] == 0 and cuts[-1] == len(sizes)
        return [sizes[a:b].tobytes() for a, b in zip(cuts[:-1], cuts[1:])]

    known, changed = tasks(sizes), sizes.copy()
    changed[10:14] -= 9
    assert sizes.sum() / 30_000 < len(known) < sizes.sum() / 14_000
    assert len(set(tasks(changed)) - set(known)) <= 3


def test_works_on_several_roads_ask_together_though_one_has_fewer_steps():
    """The phases are as many as those of the road with the most, whatever each asks for."""
    phases_run = []

    class Noting(Threads):
        def run(self, phase, items, *others):
            phases_run.append((phase.function.__name__, len(items)))
            return super().run(phase, items, *others)

    def looking(count):
        spots = np.unique(STRIPES[0] // 400, axis=0) * 0.04
        for _ in range(count):
            yield asked(combs_of_windows, lambda rows: (spots[rows],), [np.arange(len(spots))], 0.5)
        return count

    assert in_step([looking(2), looking(0), looking(1)], Noting(1)) == [2, 0, 1]
    assert phases_run == [("combs_of_windows", 2), ("combs_of_windows", 1)]


@pytest.mark.parametrize("executor", [Threads(2), Keep(Threads(1)), WorkerProcesses(find_interpreter(), 1)])
def test_different_phases_that_are_asked_for_at_once_are_run_as_one(executor, monkeypatch):
    """One of them is given lists of items, the other one by one; each work gets the answers to what it asked for."""
    tasks, run = [], type(executor).run
    monkeypatch.setattr(type(executor), "run", lambda self, *others: tasks.append(1) or run(self, *others))
    lines = [(np.arange(20.0), slope * np.arange(20.0), "whole") for slope in range(5)]
    spots = np.unique(STRIPES[0] // 400, axis=0) * 0.04

    def fitting():
        return (yield Asked(Phase(curves_of_lanes, NoSource(), (), str, listed=2), lines, 1.0))

    def looking():
        return (yield asked(combs_of_windows, lambda rows: (spots[rows],), [np.arange(len(spots))] * 3, 1.0))

    with closing(executor):
        fits, combs = in_step([fitting(), looking()], executor)
    assert len(tasks) == (0 if isinstance(executor, Keep) else 1) and combs == [None] * 3
    for slope, fit in enumerate(fits):
        np.testing.assert_allclose(np.tan(fit.curve.heading(0.0)), slope, atol=1e-9)


def test_where_there_is_no_paint_there_is_nothing_to_do():
    def asking():
        combs = yield asked(combs_of_windows, lambda rows: (rows,), [], 0.5)
        return combs + (yield asked(pieces_of_clusters, lambda rows: (rows,) * 5, [], 1.0, []))

    assert in_step([asking()], Threads(1)) == [[]] and in_step([], Threads(1)) == []
