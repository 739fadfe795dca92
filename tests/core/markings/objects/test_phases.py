"""Crossings, compound clusters, shapes of clusters and figures: worker processes find in small tasks what threads find together, to the last bit."""

from contextlib import closing

import numpy as np
import pytest
from lanewright.core.common.progress import Progress
from lanewright.core.countries.painted_symbols import SYMBOLS
from lanewright.core.execution.phase import Threads
from lanewright.core.execution.processes import WorkerProcesses
from lanewright.core.execution.tasks import find_interpreter
from lanewright.core.markings.objects import cluster as phases
from lanewright.core.markings.objects.cluster import ApartWork
from lanewright.core.markings.objects.figures import figures_of
from lanewright.core.markings.road_grid import CELL_SIZE
from lanewright.core.survey.store.columns import Columns

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


def found_by(executor):
    """The results of all phases."""
    with closing(executor):
        work = ApartWork(executor, 0)
        clusters = [COMPOUND, *STRIPES, *DASHES]
        s, d = np.concatenate(clusters).T.copy()
        spacing = np.zeros(len(s), np.uint16)
        bounds = np.cumsum([0, *map(len, clusters)])
        spots = np.unique(np.concatenate(STRIPES + DASHES) // 400, axis=0) * 0.04
        windows = [np.flatnonzero(np.abs(spots[:, 0] - station) < 2.5) for station in range(18, 80, 3)]
        combs = work.combs(spots, [rows for rows in windows if len(rows) > 3], Progress())
        parts = work.parts(s, d, spacing, list(zip(bounds[:4].tolist(), bounds[1:5].tolist())), Progress())
        records = Columns(dict(s=s, d=d, spacing=spacing), [("s", "i4"), ("d", "i4"), ("spacing", "u2")])
        shapes = work.shapes(records, bounds, Progress())
        shown = [*map(figure, SYMBOLS), np.argwhere(np.ones((9, 30)))]
        figures = list(work.figures([(cells, np.zeros(len(cells))) for cells in shown], 0.0, 1.0, Progress()))
        return ([comb and (comb.middle.tobytes(), *comb._replace(middle=None)) for comb in combs],
                [(part.tobytes(), count) for part, count in parts], shapes, [type(value) for shape in shapes for value in vars(shape).values()],
                figures)


@pytest.mark.slow
def test_worker_processes_find_what_threads_find(monkeypatch):
    combs, parts, shapes, _, figures = known = found_by(Threads(1))
    assert set(figures) == {"bicycle", "bus", ""} and figures[-1] == ""
    assert sum(comb is not None for comb in combs) >= 2 and None in combs
    assert parts[0][1] >= 2 and len(shapes) == len(STRIPES) + len(DASHES) + 1
    assert found_by(Threads(3)) == known
    monkeypatch.setattr(phases, "TASK_POINTS", 200)
    assert found_by(WorkerProcesses(find_interpreter(), 2)) == known


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


def test_where_there_is_no_paint_there_is_nothing_to_do():
    empty = np.empty(0, np.int32)
    work = ApartWork(Threads(1), 0)
    assert work.combs(np.empty((0, 2)), [], Progress()) == work.parts(empty, empty, empty, [], Progress()) == []
