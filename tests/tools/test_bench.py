"""`make bench`: rounds of figures in, a page out."""

import json
import os
import sys

import numpy as np
import pytest

pytest.importorskip("osgeo.gdal")

from bench import meaning, measures, surveys  # noqa: E402
from bench.chain import Watch  # noqa: E402
from bench.measures import MEASURES, PARTS  # noqa: E402
from bench.page import page  # noqa: E402
from bench.results import results  # noqa: E402
from bench.rows import ROWS  # noqa: E402
from results_table import Results  # noqa: E402

CHAIN = dict(wall=8.1, cpu=12.0, peak=1024.0, points=18_000_000, road_points=13_000_000, length=200.0, bar_off=0.04,
             seconds=dict(survey=4.0, curbs=1.0, edges=0.1, lines=0.1, driving=0.1), silence=(0.8, "Detecting curbs …"), found={})
READ = dict(wall=3.0, cpu=5.0, points=18_000_000)
MACHINE = dict(processor="A processor", cores=2, of=2, memory_gib=16.0, system="Debian", python="3.11", numpy="1.24", laspy="2", lazrs="0.8",
               scipy="1.10")


def a_round(others=0.0, **more):
    figures = {name: dict(CHAIN) for name in ("profiles", "las", "both", "tiles", "short")}
    figures.update(read=dict(READ), sor_ours=dict(wall=2.0, cpu=2.0), sor_pcl=dict(cpu=4.0), sor_open3d=dict(missing="No Open3D here."))
    figures.update(more)
    return {name: dict(dict(peak=500.0, load=0.1, took=10.0, others=others), **f) for name, f in figures.items()}


def a_table(*rounds, size="full"):
    same = dict(sor_pcl=dict(same=0.9999, ours=900_000, theirs=900_010))
    return results(json.loads(json.dumps(dict(size=size, machine=MACHINE, rounds=rounds, meaning=same, took=600.0))))


def a_page(*rounds, size="full"):
    return page(a_table(*rounds, size=size))


def row(text, unit=""):
    return next(r for r in ROWS if text in r.text and unit in r.unit)


def test_figures_are_ratios_within_a_round_and_the_median_decides():
    slow = {name: dict(f, wall=f["wall"] * 3) if "wall" in f else f for name, f in a_round().items()}
    rounds = [a_round(), a_round(profiles=dict(CHAIN, wall=12.0)), slow]
    whole, table = row("whole road map", "× reading"), a_table(*rounds)
    spread = [table.get("goals", whole.text, whole.unit, name) for name in ("median", "least", "most")]
    assert spread == [pytest.approx(2.7), pytest.approx(2.7), 4.0] and whole.reached(rounds) == "yes"
    assert row("outliers", "PCL").values(rounds) == [0.5] * 3 and row("outliers", "PCL").reached(rounds) == "yes"
    assert row("outliers", "Open3D").values(rounds) == [] and row("outliers", "Open3D").reached(rounds) is None


def test_the_page_opens_with_the_goals_that_are_not_reached():
    heavy = a_round(profiles=dict(CHAIN, peak=1300.0))
    assert row("peak memory, dense").reached([heavy]) == "no"
    text = "| peak memory, dense 200 m | GiB | ≤ 1.2 |"
    first, _, second = a_page(heavy).partition("## Reached")
    assert text in first and text not in second and text in a_page(a_round()).partition("## Reached")[2]


def test_the_page_is_the_same_from_the_table_that_was_saved(tmp_path):
    table = a_table(a_round(), a_round(profiles=dict(CHAIN, wall=12.0)))
    table.write(tmp_path / "benchmarks.csv")
    assert page(Results.read(tmp_path / "benchmarks.csv")).count("(2.70–4.00)") == page(table).count("(2.70–4.00)") == 1


@pytest.mark.parametrize("wall,share,verdict", [(5.5, 10 / 11, "yes"), (6.0, 10 / 12, "no")])
def test_two_cores_that_take_little_more_than_half_the_time_of_one_reach_the_goal(wall, share, verdict):
    figures = a_round(alone_both=dict(CHAIN, wall=10.0, cores=1), both=dict(CHAIN, wall=wall, cores=2))
    assert row("of the default, threads").values([figures]) == [pytest.approx(share)]
    assert row("of the default, threads").reached([figures]) == verdict
    assert "| ≥ 0.9 |" in a_page(figures)


def test_what_runs_on_one_core_each_lose_side_by_side_is_the_ceiling_of_efficiency():
    figures = a_round(alone_both=dict(CHAIN, wall=9.0), side_by_side=dict(wall=10.0, cpu=9.8))
    assert row("ceiling").values([figures]) == [pytest.approx(0.9)] and row("ceiling").reached([figures]) is None


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="cores are chosen on Linux only")
def test_runs_side_by_side_have_a_core_each_and_their_mean_is_told(tmp_path, monkeypatch):
    told = "import json, os; found = os.sched_getaffinity(0); print(json.dumps(dict(wall=sum(found), cpu=len(found), peak=os.getpid())))"
    python = tmp_path / "python"
    python.write_text(f"#!/bin/sh\nexec {sys.executable} -c '{told}'\n")
    python.chmod(0o755)
    monkeypatch.setattr(measures.sys, "executable", str(python))
    found = measures.side_by_side("alone_both", "quick")
    assert found["cpu"] == 1 and found["wall"] == pytest.approx(np.mean(sorted(os.sched_getaffinity(0))))


def test_a_busy_machine_is_told_of_and_a_quiet_one_is_not():
    assert "was not quiet" in a_page(a_round(others=0.9))
    assert "was not quiet" not in a_page(a_round(others=0.02))


def test_a_program_that_is_not_here_is_left_out_and_said_so():
    text = a_page(a_round())
    assert "Open3D (outliers): No Open3D here." in text
    assert "99.99 %" in text and "not measured" in text


def test_the_short_form_says_that_it_is_no_measurement():
    assert "not to be quoted" in a_page(a_round(), size="quick")
    assert "not to be quoted" not in a_page(a_round())


def test_how_long_cancel_took_is_told_where_it_was_tried():
    waits = [(1.0, 0.2, "Reading the survey …"), (5.0, 0.9, "Detecting curbs …"), (9.0, 0.1, "Reading the survey …")]
    text = a_page(a_round(cancel=dict(wall=10.0, waits=waits, left=[])))
    assert "3 random moments" in text and "0.90 s at most (“Detecting curbs …”)" in text and "behind: none" in text
    assert "random moments" not in a_page(a_round())


def test_every_part_measures_what_there_is_and_every_row_can_be_filled():
    names = {name for part in PARTS.values() for name in part}
    assert names | {"prepare"} == set(MEASURES)
    assert {name for r in ROWS for name in r.needs} <= names


def test_a_bar_that_moves_evenly_is_not_off_and_the_longest_silence_is_found(monkeypatch):
    now = [0.0]
    monkeypatch.setattr("bench.chain.time.perf_counter", lambda: now[0])
    watch = Watch()
    for second, what in ((1.0, "Reading"), (2.0, "Curbs"), (5.0, ""), (6.0, ""), (8.0, "")):
        now[0] = second
        watch.report(second / 8.0)
        if what:
            watch.info(what)
    assert watch.figures() == dict(bar_off=0.0, silence=(3.0, "Curbs"))
    watch.report(0.5)
    assert watch.figures()["bar_off"] == pytest.approx(0.5)


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.setattr(surveys, "SURVEYS", tmp_path)
    monkeypatch.setattr(meaning, "prepared", lambda name, size: tmp_path / name)
    return tmp_path


def test_clusters_are_alike_whatever_their_numbers(files):
    ours = np.array([0, 0, 0, 1, 1, 2])
    np.save(files / "clusters_ours.npy", ours)
    np.save(files / "clusters_pcl.npy", 7 - ours)
    assert meaning.same_clusters("full", "pcl") == dict(same=1.0, ours=3, theirs=3)
    np.save(files / "clusters_pcl.npy", np.array([5, 5, 5, 5, 5, 9]))  # the first two are one
    found = meaning.same_clusters("full", "pcl")
    assert found["same"] == pytest.approx((3 * 3 / 5 + 2 * 2 / 5 + 1) / 6)


def test_outliers_are_alike_where_both_keep_or_leave_a_point(files):
    np.save(files / "sor_ours.npy", np.array([True, True, False, True]))
    np.save(files / "sor_pcl.npy", np.array([True, False, False, True]))
    assert meaning.same_outliers("full", "pcl") == dict(same=0.75, ours=3, theirs=2)
