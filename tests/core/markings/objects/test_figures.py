"""Bicycles and the word BUS are told from all other figures, turned, stretched and worn; what is not clear stays a symbol."""

import numpy as np
import pytest
import shapely
from clustered_marks import FRAME, classes, layer_of, markings_of
from lanewright.core.execution.phase import Threads, digest
from lanewright.core.markings.objects.cluster import cluster_markings
from lanewright.core.markings.objects.figures import figure_of_cells
from lanewright.simulator.parts.paint import straight_arrow
from lanewright.simulator.parts.symbols import bicycle, bus_word
from painted_streets import between, paint, painted_by, road_points, strip


def drawn(polygons):
    """A mark of polygons in stations and offsets."""
    area = shapely.union_all([shapely.Polygon(polygon) for polygon in polygons])
    shapely.prepare(area)
    return between(area.bounds[0], area.bounds[2], lambda s, d: shapely.contains_xy(area, s, d))


def mirrored(polygons, offset):
    return tuple(polygon * [1, -1] + [0, 2 * offset] for polygon in polygons)


@pytest.mark.parametrize("length, width", [(1.4, 1.1), (2.2, 1.1), (1.2, 1.2)])
@pytest.mark.parametrize("way", [1, -1])
def test_a_bicycle_is_one_whichever_way_it_looks(length, width, way):
    figure = bicycle(30.0, 1.5, way, length, width)
    assert classes(markings_of([drawn(figure)], density=4000)) == ["bicycle"]
    assert classes(markings_of([drawn(mirrored(figure, 1.5))], density=4000)) == ["bicycle"]


@pytest.mark.parametrize("length, width", [(1.6, 1.8), (2.4, 1.7), (4.0, 1.9)])
@pytest.mark.parametrize("way", [1, -1])
def test_the_word_bus_is_one_marking_however_long_its_letters_are(length, width, way):
    markings = markings_of([drawn(bus_word(30.0, 1.5, way, length, width))], density=4000)
    assert set(classes(markings)) == {"bus"}
    assert set(markings.column("cluster")) == {1}


def test_figures_are_told_with_4_cm_of_noise_and_a_tenth_of_the_points_gone():
    rng = np.random.default_rng(5)
    records = paint(FRAME, [drawn(bicycle(25.0, 1.5, 1, 1.8, 1.2)), drawn(bus_word(35.0, 1.5, 1, 2.4, 1.8))], density=5000)
    records = records[rng.random(len(records)) > 0.1]
    for axis in "xy":
        records[axis] += np.rint(rng.normal(0.0, 400.0, len(records))).astype(records[axis].dtype)
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert set(classes(markings)) == {"bicycle", "bus"}


def letters(text_bars):
    return between(min(bar[0] for bar in text_bars), max(bar[1] for bar in text_bars),
                   lambda s, d: painted_by([strip(*bar) for bar in text_bars], s, d))


def word(*names, s0=30.0, d0=0.5):
    """Letters of seven bars, 2.4 m by 0.5 m, read along the road from left to right."""
    bars = {"top": (2.16, 2.4, 0.0, 0.5), "middle": (1.1, 1.3, 0.0, 0.5), "foot": (0.0, 0.24, 0.0, 0.5), "left": (0.0, 2.4, 0.36, 0.5),
            "right": (0.0, 2.4, 0.0, 0.14)}
    of = {"H": ("left", "right", "middle"), "E": ("left", "top", "middle", "foot"), "L": ("left", "foot"), "O": ("left", "right", "top", "foot"),
          "T": ("left", "top"), "A": ("left", "right", "top", "middle"), "P": ("left", "right", "top")}
    return letters([(s0 + a, s0 + b, d0 - 0.72 * k + c, d0 - 0.72 * k + e)
                    for k, name in enumerate(names) for a, b, c, e in (bars[part] for part in of[name])])


@pytest.mark.parametrize("mark", [word(*"HOL"), word(*"EHE"), word(*"TAP"), word("O"), drawn([straight_arrow(30.0, 1.5, 1)]),
                                  strip(30, 31.2, 0.0, 1.4), between(29.0, 31.0, lambda s, d: np.abs(np.hypot(s - 30, d - 1.5) - 0.5) < 0.06)])
def test_other_figures_are_neither(mark):
    assert not {"bicycle", "bus"} & set(classes(markings_of([mark], density=4000)))


class Noting(Threads):
    """Notes what is asked about markings that may be figures."""

    def __init__(self):
        super().__init__()
        self.asked = []

    def run(self, phase, items, *others):
        if phase.function is figure_of_cells:
            self.asked += [digest(item) for item in items]
        return super().run(phase, items, *others)


def test_what_was_asked_about_a_figure_is_the_same_with_a_line_more_before_it_so_that_its_answer_serves_again():
    figure, asked = between(5.0, 40.0, drawn(bicycle(30.0, 1.5, 1, 1.8, 1.2))), []   # strewn with the same points in both
    for others in ([], [strip(5.0, 8.0, 1.4, 1.6), strip(12.0, 14.0, -1.0, -0.5)]):
        executor = Noting()
        cluster_markings(road_points(paint(FRAME, [figure, *others], density=4000), FRAME), FRAME, executor=executor)
        asked.append(executor.asked)
    assert asked[0] and set(asked[0]) <= set(asked[1])
