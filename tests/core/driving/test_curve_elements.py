"""The elements of circular curves and the word of the design code."""

import numpy as np
import pytest
from lanewright.core.countries.catalogue import country
from lanewright.core.driving.alignment import FOOT, circular_curve_elements, curve_points, design_check
from lined_streets import EAST, NORTH, Street


@pytest.mark.parametrize("radius", [15.0, 140.8, 900.0])
@pytest.mark.parametrize("delta_deg", [2.0, 10.49, 85.0, 170.0])
def test_the_middle_ordinate_is_the_external_distance_times_the_cosine_of_half_the_turn(radius, delta_deg):
    found = circular_curve_elements(radius, np.radians(delta_deg))
    assert found["middle_m"] == pytest.approx(found["ext_m"] * np.cos(np.radians(delta_deg) / 2), rel=1e-12)
    assert found["middle_m"] < found["ext_m"]
    assert found["chord_m"] < found["length_m"] < 2 * found["tangent_m"]


def test_the_published_curve_of_12_4_degrees_per_100_feet():
    radius = 5729.578 / 12.4 * FOOT
    found = circular_curve_elements(radius, np.radians(10.49))
    assert found["radius_ft"] == pytest.approx(462.06, abs=0.01)
    assert found["degree_ft"] == pytest.approx(12.4, abs=1e-5)
    assert found["tangent_ft"] == pytest.approx(42.42, abs=0.01)
    assert found["chord_ft"] == pytest.approx(84.48, abs=0.01)
    # as corrected: the printed L, M and E contradict the others
    assert found["length_ft"] == pytest.approx(84.60, abs=0.01)
    assert found["middle_ft"] == pytest.approx(1.935, abs=0.001)
    assert found["ext_ft"] == pytest.approx(1.943, abs=0.001)
    assert found["radius_m"] == pytest.approx(140.8, abs=0.05)


@pytest.mark.parametrize("left", [True, False])
def test_pi_lies_on_both_tangents_and_a_chord_apart_are_pc_and_pt(left):
    pc, pi, pt = curve_points((10.0, 20.0), 0.3, 80.0, 0.7, left)
    found = circular_curve_elements(80.0, 0.7)
    assert np.hypot(*(pt - pc)) == pytest.approx(found["chord_m"])
    assert np.hypot(*(pi - pc)) == pytest.approx(np.hypot(*(pt - pi))) == pytest.approx(found["tangent_m"])
    turn = (pt - pc)[1] * np.cos(0.3) - (pt - pc)[0] * np.sin(0.3)
    assert (turn > 0) == left


@pytest.mark.parametrize("radius, length, speed", [
    (84.0, 100.0, None), (86.0, 26.0, 30), (86.0, 20.0, None), (160.0, 100.0, 40), (500.0, 45.0, 50), (500.0, 100.0, 80)])
def test_the_design_code_allows_the_speed_of_its_table(radius, length, speed):
    assert design_check(radius, length)[0] == speed


def test_an_arc_cut_by_the_end_of_the_line_is_judged_by_its_radius_alone():
    speed, text = design_check(210.0, 12.0, complete=False)
    assert speed == 50 and "goes on" in text


def test_a_straight_street_has_no_circular_curve_elements():
    lines, elements = Street().paint(0.0).paint(-3.5).lanes()
    assert len(elements) == 0 and {row["design_kmh"] for row in lines.rows} == {None}


def test_the_table_of_a_bend_has_a_row_per_lane_with_its_own_radius_in_the_direction_of_travel():
    street = Street(length=90.0, radius=100.0, vehicle=-1.75).paint(3.5).paint(0.0, pattern="dashed").paint(-3.5)
    lines, elements = street.lanes()
    outer, inner = elements.rows
    assert {(row["lane"], row["design_kmh"]) for row in lines.rows} == {(1, 30), (2, 30)}
    assert {(row["lane"], row["speed_kmh"]) for row in elements.rows} == {(1, 30), (2, 30)}
    assert outer["radius_m"] == pytest.approx(101.75, rel=2e-3) and inner["radius_m"] == pytest.approx(98.25, rel=2e-3)
    assert (outer["turn"], inner["turn"]) == ("left", "right")
    assert outer["delta_deg"] == pytest.approx(np.degrees(80.0 / 100.0), rel=0.015)
    for row in (outer, inner):
        for point in ("pc", "pt"):
            away = np.hypot(row[f"{point}_x"] - EAST, row[f"{point}_y"] - NORTH - 100.0)
            assert away == pytest.approx(row["radius_m"], abs=0.1)
    assert outer["pc_x"] < outer["pt_x"] and inner["pc_x"] > inner["pt_x"]


@pytest.mark.parametrize("name, radius, speed, code", [
    ("neutral", 210.0, 50, "CJJ 37-2012"), ("japan", 160.0, 60, "Road Structure Ordinance"), ("germany", 500.0, 100, "RAA 2008"),
    ("united-states", 240.0, 80, "AASHTO"), ("germany", 200.0, None, "RAA 2008"),
])
def test_a_curve_is_checked_against_the_code_of_the_country_and_the_text_names_it(name, radius, speed, code):
    found, text = design_check(radius, 80.0, code=country(name))
    assert found == speed
    assert text.startswith(code)
