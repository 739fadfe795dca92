"""The part of `make accuracy` that judges what runs beside the road."""

import sys
from pathlib import Path

from shapely import LineString

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from accuracy.results import results  # noqa: E402
from accuracy.roadside import judged_roadside  # noqa: E402
from accuracy.surveys import Truth  # noqa: E402

WALL, RAIL = LineString([(0, 5, 1), (40, 5, 1)]), LineString([(0, -5, 1), (60, -5, 1)])


def line(length, offset, kind):
    return LineString([(0, offset, 1), (length, offset, 1)]), dict(kind=kind)


def test_a_line_is_right_beside_a_true_one_of_its_kind_alone():
    truth = Truth(roadside=[(WALL, dict(kind="wall")), (RAIL, dict(kind="guard_rail"))], has={"roadside"})
    found = judged_roadside(truth, [line(40, 5.2, "wall"), line(30, -5.1, "guard_rail"), line(20, -5.0, "fence"), line(60, 3.0, "gutter")])
    assert found["roadside wall"] == (400, 400) and found["roadside_right wall"] == (400, 400)
    # within 30 cm of the end counts, too
    assert found["roadside guard_rail"] == (303, 600) and found["roadside_right fence"] == (0, 200)
    assert found["roadside"] == (703, 1000) and found["roadside_right"] == (700, 900)


def test_the_results_say_how_many_metres_are_wrong():
    truth = Truth(roadside=[(WALL, dict(kind="wall"))], has={"roadside"})
    figures = [dict(name="one", kind="simulated", text="", points=1, streets={"as surveyed": judged_roadside(truth, [line(40, 5, "wall")])}),
               dict(name="none", kind="simulated", text="", points=1, streets={"as surveyed": judged_roadside(
                   Truth(has={"roadside"}), [line(12, 5, "fence")])})]
    table = results(figures)

    def row(name):
        figures = ("roadside", "roadside right", "roadside m", "roadside m wrong")
        return [value if value is None else round(value, 1) for value in (table.get("streets", name, "as surveyed", figure) for figure in figures)]

    assert row("one") == [100.0, 100.0, 40.0, 0.0]
    assert row("none") == [None, 0.0, None, 12.0]
    assert row("all") == [100.0, 76.9, 40.0, 12.0]


def test_a_survey_without_a_truth_of_the_roadside_has_no_figures_of_it():
    table = results([dict(name="one", kind="real", text="", points=1, streets={"as surveyed": {}})])
    assert not [key for key in table.values if key[1] == "one" and key[3].startswith("roadside")]
