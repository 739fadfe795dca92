"""The part of `make accuracy` that judges what runs beside the road."""

import sys
from pathlib import Path

import pytest
from shapely import LineString

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from accuracy.roadside import judged_roadside, roadside_section  # noqa: E402
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


def test_the_table_says_how_many_metres_are_wrong():
    truth = Truth(roadside=[(WALL, dict(kind="wall"))], has={"roadside"})
    figures = [dict(name="one", kind="simulated", has=["roadside"], streets={"as surveyed": judged_roadside(truth, [line(40, 5, "wall")])}),
               dict(name="none", kind="simulated", has=["roadside"], streets={"as surveyed": judged_roadside(
                   Truth(has={"roadside"}), [line(12, 5, "fence")])})]
    rows = roadside_section(figures).splitlines()
    assert rows[-3].split("|")[-4:-1] == [" 100.0 ", " 100.0 ", " 0.0 "]
    assert rows[-2].split("|")[-4:-1] == [" – ", " 0.0 ", " 12.0 "]
    assert rows[-1].startswith("| **all, by length** | 40 |") and "76.9" in rows[-1]


@pytest.mark.parametrize("has", [[], ["markings"]])
def test_without_a_truth_of_the_roadside_there_is_no_section(has):
    assert roadside_section([dict(name="one", kind="real", has=has, streets={"as surveyed": {}})]) == ""
