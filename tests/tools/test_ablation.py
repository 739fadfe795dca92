"""`make ablation`: rules switched off in turn, and what each brings."""

import json
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("osgeo.gdal")

from ablation.__main__ import _code  # noqa: E402
from ablation.measure import ALL_VARIANTS, STAGES, Survey, measure  # noqa: E402
from ablation.page import page, write_csv  # noqa: E402
from ablation.swap import Watch, original_of, replaced, same  # noqa: E402
from ablation.switches import DEFAULT, SWITCHES, Switch, gives, nearest_steps, nth  # noqa: E402
from ablation.weight import rule_parts, weight  # noqa: E402
from accuracy.otherwise import street_figures  # noqa: E402
from accuracy.surveys import read_case  # noqa: E402
from accuracy.variants import Variant  # noqa: E402
from lanewright.core.curves import robust  # noqa: E402
from lanewright.core.markings.lines import selection  # noqa: E402
from lanewright.core.road.common.corners import CurbSteps  # noqa: E402
from lanewright.core.road.common.curb_limits import CurbLimits  # noqa: E402


@pytest.mark.parametrize("switch", SWITCHES.values(), ids=SWITCHES)
def test_a_switch_replaces_what_there_is_and_puts_it_back(switch):
    before = [original_of(place)[0] for place, _ in switch.swaps]
    with replaced(switch.swaps):
        assert all(original_of(place)[0] is not old for (place, _), old in zip(switch.swaps, before))
    assert [original_of(place)[0] for place, _ in switch.swaps] == before
    assert "," not in switch.name   # names are listed with commas between
    assert switch.swaps or switch.settings != DEFAULT and switch.stage in STAGES


@pytest.mark.parametrize("switch", SWITCHES.values(), ids=SWITCHES)
def test_every_part_of_a_rule_is_in_the_core(switch):
    for part in switch.rule:
        assert weight(replace(switch, rule=(part,)))[0] > 0, part


def test_a_rule_is_off_wherever_the_core_calls_it():
    # the file that imported the function calls the stand-in too
    with replaced([("curves.robust:median", gives(7.0))]):
        assert robust.median(np.array([1.0])) == selection.median(np.array([1.0])) == 7.0
    assert selection.median(np.array([1.0])) == 1.0


def test_a_rule_that_gives_what_stands_in_for_it_is_not_felt():
    first = Switch("the first", "", (("curves.robust:median", lambda values: values[0]),))
    seven = Switch("seven", "", (("curves.robust:median", gives(7.0)),))
    never = Switch("never", "", (("curves.robust:percentiles", nth(0)),))
    watch = Watch([first, seven, never])
    watch.stage = "lines"
    with watch.watching():
        assert robust.median(np.array([2.0, 2.0])) == 2.0
    assert watch.felt == {"the first": set(), "seven": {"lines"}, "never": set()}
    assert watch.called == {"the first", "seven"}


def test_results_are_compared_by_value():
    nothing = np.array([1.0, np.nan])
    assert same([nothing, "a"], [nothing.copy(), "a"]) and same(0.0, np.float64(0.0)) and same(np.zeros(3), 0.0)
    assert not same(nothing, nothing[:1]) and not same((1, 2), (1, 3)) and not same(None, np.zeros(1)) and not same(True, None)


def test_the_weight_of_a_rule_is_what_nothing_else_uses():
    whole, alone = SWITCHES["pieces in line"], SWITCHES["steps followed by few points"]
    assert weight(whole)[0] > 50 > weight(alone)[0] > 5
    # lines across gaps serve road edges too
    assert not any(name == "GapLine" for _, name in rule_parts(whole.rule))
    assert any(name == "_is_curb" for _, name in rule_parts(whole.rule))


def test_a_rule_is_found_in_its_room_when_its_file_is_another():
    assert original_of("curves.no_such_file:median")[0] is robust.median
    # two files of the room have one of that name
    with pytest.raises(LookupError):
        original_of("road.no_such_room:_stays_up")


def test_stations_that_begin_earlier_lengthen_the_drive_straight_back():
    rows = np.column_stack([np.arange(9.0), np.arange(9.0) * 3, np.zeros((9, 5))])
    moved = Variant("moved", moved=0.3).trajectory(rows, np.zeros(2))
    assert moved[0, :2] == pytest.approx([-0.1, -0.3]) and (moved[1:] == rows).all()


@pytest.fixture(scope="module")
def short(short_street, tmp_path_factory):
    """The short street, the rules switched off, and its results as surveyed."""
    folder = short_street
    chosen = {name: SWITCHES[name] for name in ("common trend", "zigzag lines", "beams made alike", "correction of intensity")}
    into = tmp_path_factory.mktemp("ablation") / "as surveyed.json"
    measure(folder / "short", "as surveyed", chosen, {"both": ["common trend", "zigzag lines"]}, into, _code())
    return folder, chosen, into


@pytest.mark.slow
def test_the_map_with_every_rule_is_the_product_s(short):
    folder, _, into = short
    figures = json.loads(into.read_text())["figures"]
    product = street_figures(read_case(folder / "short"), variants=False)["as surveyed"]
    assert {name: tuple(figures[name]) for name in product if name in figures} == {name: product[name] for name in product if name in figures}
    assert figures["classes"][0] > 0.9 * figures["classes"][1] > 0


@pytest.mark.slow
def test_only_rules_that_a_street_calls_are_run_without(short):
    off = json.loads(short[2].read_text())["off"]
    assert off["zigzag lines"]["outcome"] in ("not called", "no effect") and off["beams made alike"]["outcome"] == "no effect"
    assert off["correction of intensity"]["outcome"] == "another map" and off["both"]["outcome"] == off["common trend"]["outcome"]


@pytest.mark.slow
def test_rules_without_effect_can_all_be_off_at_once(short, tmp_path, monkeypatch):
    with closing(Survey(short[0] / "short", ALL_VARIANTS["as surveyed"], tmp_path, [*SWITCHES.values()])) as survey:
        idle = [switch for switch in SWITCHES.values() if survey.idle([switch])]
        assert len(idle) > 50
        monkeypatch.setattr(survey, "_stages", lambda switches: set(STAGES))
        assert survey.without(idle)["outcome"] == "same map"


@pytest.mark.slow
def test_results_are_kept_and_only_what_is_missing_is_measured(short, monkeypatch):
    folder, chosen, into = short
    before = into.read_text()
    monkeypatch.setattr("ablation.measure.Survey", None)
    measure(folder / "short", "as surveyed", chosen, {}, into, json.loads(before)["code"])
    assert into.read_text() == before


@pytest.mark.slow
def test_the_table_names_who_feels_a_rule_and_who_does_not(short, tmp_path):
    _, chosen, into = short
    results = {("short", "as surveyed"): json.loads(into.read_text())}
    groups = {"both": ["common trend", "zigzag lines"]}
    text = page(chosen, groups, results)
    felt, silent = text.split("## Felt by no survey")
    assert "| zigzag lines | markings.objects" in silent and "zigzag lines |" not in felt.split("## Felt")[1].split("| both")[0]
    write_csv(tmp_path / "table.csv", chosen, groups, results)
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 1 + len(chosen) + len(groups)


def test_the_thesis_takes_the_step_nearest_the_vehicle_that_is_high_and_steep_enough():
    names = ("s", "u", "h", "skew", "height", "run", "noise", "scanner_noise", "support", "behind", "hidden")
    values = {name: np.zeros(5) for name in names}
    values.update(s=np.array([0.0, 0.0, 0.25, 0.25, 0.5]), u=np.array([4.0, 2.0, 3.0, 5.0, 3.0]),
                  height=np.array([0.1, 0.1, 0.02, 0.1, 0.1]), run=np.array([0.02, 0.02, 0.01, 0.02, 0.5]))
    chain, = nearest_steps(CurbSteps(profile=np.array([0, 0, 1, 1, 2]), **values), None, 0.25, CurbLimits(0.05, np.radians(60)))
    np.testing.assert_array_equal(chain.steps, [1, 3])
    assert (chain.start, chain.end) == (0.0, 0.25)


def test_every_variant_has_a_name_of_its_own():
    assert len(ALL_VARIANTS) == 8 and "stations moved by 0.3 m" in ALL_VARIANTS
