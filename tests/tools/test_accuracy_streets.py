"""The parts of `make accuracy` that judge streets of every kind by length, and surveys made otherwise."""

import json
from pathlib import Path
from types import SimpleNamespace

import laspy
import numpy as np
import pytest
from shapely import LineString, Polygon, box

pytest.importorskip("osgeo.gdal")

from accuracy.page import page  # noqa: E402
from accuracy.results import results  # noqa: E402
from accuracy.streets import harmonic, judged, percent, pooled  # noqa: E402
from accuracy.variants import VARIANTS, Variant  # noqa: E402
from lanewright.simulator.survey import SampleSettings, make_sample_survey  # noqa: E402

CENTRE = np.array([100.0, 200.0])
TRACK = np.column_stack([np.arange(0.0, 100.0, 0.5), np.full(200, -1.75)])


def line(*places):
    return LineString([(*place, 0.0) for place in places])


def street(**truth):
    """A straight street of 100 m with two lanes, the right one driven; curbs, a corner, an edge of pavement."""
    given = dict(
        edges=[(line((0, 4), (100, 4)), "curb", "main"), (line((0, -4), (60, -4)), "curb", "main"), (line((60, -4), (70, -4)), "dropped", "main"),
               (line((70, -4), (75, -9)), "curb", "corner"), (line((80, -4), (100, -4)), "pavement", "main")],
        driving=[line((0, -1.75), (100, -1.75)), line((100, 1.75), (0, 1.75))], area=box(-5, -20, 105, 20), has={"boundaries", "driving_lines"})
    return SimpleNamespace(truth=SimpleNamespace(**{**given, **truth}))


def figures(edges=(), lanes=()):
    return judged(street(), TRACK, [(edge, {}) for edge in edges], None, [(lane, {}) for lane in lanes])


def test_the_truth_itself_scores_full_marks():
    case = street()
    found = judged(case, TRACK, [(edge, {}) for edge, _, _ in case.truth.edges], None, [(lane, {}) for lane in case.truth.driving])
    assert {percent(found, name) for name in found} == {100.0}
    assert set(found) == {"curbs", "corners", "pavement", "curbs_right", "lanes", "lanes_5", "driven", "driven_5", "lanes_right", "directions"}


def test_curbs_count_by_length_and_those_of_corners_by_themselves():
    found = figures(edges=[line((0, 4.05), (100, 4.05))])
    corner = np.hypot(5, 5)
    assert percent(found, "curbs") == pytest.approx(100 * 100 / (160 + corner), abs=0.5)
    assert percent(found, "corners") == 0 and percent(found, "curbs_right") == 100


def test_a_pavement_edge_is_found_within_20_cm_and_a_curb_within_10_cm():
    found = figures(edges=[line((80, -4.15), (100, -4.15)), line((0, 4.15), (100, 4.15))])
    assert percent(found, "pavement") == pytest.approx(100) and percent(found, "curbs") == 0
    assert percent(found, "curbs_right") == pytest.approx(100 * 20 / 120, abs=0.5)


def test_an_edge_along_a_dropped_curb_is_neither_missed_nor_invented():
    found = figures(edges=[line((60, -4), (70, -4))])
    assert percent(found, "curbs_right") == 100 and percent(found, "curbs") < 1


def test_driven_lanes_are_those_that_a_pass_drove():
    found = figures(lanes=[line((0, -1.75), (100, -1.75))])
    assert percent(found, "driven") == 100 and percent(found, "lanes") == pytest.approx(50)
    found = figures(lanes=[line((0, -1.85), (100, -1.85))])
    assert percent(found, "driven") == 100 and percent(found, "driven_5") == 0


def test_a_lane_against_the_traffic_is_in_its_place_but_not_in_its_direction():
    found = figures(lanes=[line((100, -1.75), (0, -1.75)), line((100, 1.75), (0, 1.75))])
    assert percent(found, "lanes") == 100 and percent(found, "directions") == pytest.approx(50)


def test_what_is_drawn_on_the_track_where_the_truth_has_no_lanes_is_not_judged_and_beside_it_it_is():
    on, beside = line((0, -1.75), (60, -1.75)), line((0, 7.75), (60, 7.75))
    case = street(driving=[line((60, -1.75), (100, -1.75))])
    found = judged(case, TRACK, [], None, [(on, {})])
    # but for what lies as near the end of the true lane as a place that is right
    assert found["lanes_right"] == (2.0, 2.0)
    found = judged(case, TRACK, [], None, [(beside, {})])
    assert percent(found, "lanes_right") == 0


def test_without_any_result_everything_is_missed_and_nothing_is_wrong():
    found = figures()
    assert percent(found, "curbs") == 0 and percent(found, "lanes") == 0
    assert percent(found, "curbs_right") is None and percent(found, "lanes_right") is None and percent(found, "directions") is None


def test_streets_are_pooled_by_length():
    both = pooled([{"curbs": (10.0, 10.0)}, {"curbs": (0.0, 30.0), "lanes": (1.0, 2.0)}])
    assert percent(both, "curbs") == 25 and percent(both, "lanes") == 50
    assert harmonic({"paint": (9.0, 10.0), "paint_right": (9.0, 18.0)}, "paint", "paint_right") == pytest.approx(2 * 90 * 50 / 140)


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.name)
def test_a_map_of_a_variant_comes_back_to_where_the_street_is(variant):
    shape = Polygon([(90, 190, 1), (130, 195, 2), (110, 230, 3)])
    ring = np.array(shape.exterior.coords)
    there = Polygon(np.column_stack([variant.places(ring[:, :2], CENTRE), ring[:, 2]]))
    assert variant.back(there, CENTRE).equals_exact(shape.reverse() if variant.reversed else shape, 1e-9)


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.name)
def test_the_heading_of_a_variant_is_where_it_drives(variant):
    angle = np.linspace(0.0, 1.0, 50)
    drive = np.column_stack([angle * 30, 100 + 50 * np.sin(angle), 200 - 50 * np.cos(angle), np.zeros(50), np.full(50, 2.0), np.full(50, 1.0),
                             90.0 - np.degrees(angle)])
    made = variant.trajectory(drive, CENTRE)
    assert np.all(np.diff(made[:, 0]) > 0)
    driven = np.degrees(np.arctan2(*np.diff(made[:, 1:3], axis=0).T)) % 360
    assert np.abs((made[:-1, 6] - driven + 180) % 360 - 180).max() < 1.0
    # a road that falls to the right of one direction falls to the left of the other, and of its mirror image
    assert made[0, 4] == (-2.0 if variant.mirrored or variant.reversed else 2.0)


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.name)
def test_points_of_a_variant_stay_on_the_way_of_its_vehicle(variant, tmp_path):
    sample = make_sample_survey(SampleSettings(length=20.0, pulse_rate=10_000.0, rotation_rate=50.0))
    sample.write_cloud(tmp_path / "cloud.laz")
    t = sample.trajectory
    rows = np.column_stack([t.time, t.x, t.y, t.z, t.roll, t.pitch, t.heading])
    centre = np.rint(rows[:, 1:3].mean(axis=0))
    variant.write_cloud(tmp_path / "cloud.laz", tmp_path / "other.laz", centre, (rows[0, 0], rows[-1, 0]))
    made = variant.trajectory(rows, centre)

    def ranges(path, rows):
        las = laspy.read(path)
        here = [np.interp(las.gps_time, rows[:, 0], rows[:, k]) for k in (1, 2, 3)]
        return np.sort(np.linalg.norm(np.stack([las.x, las.y, las.z]) - here, axis=0))

    before, after = ranges(tmp_path / "cloud.laz", rows), ranges(tmp_path / "other.laz", made)
    assert len(after) == -(-len(before) // variant.every)
    if variant.every == 1:
        np.testing.assert_allclose(after, before, atol=0.003)
    # traffic of a mirrored street drives on the other side than that of the country where it lay
    assert (laspy.read(tmp_path / "other.laz").header.parse_crs() is None) == variant.mirrored


def test_the_page_says_how_much_each_variant_changes():
    whole = {"curbs": (90.0, 100.0), "lanes": (98.0, 100.0), "lanes_right": (99.0, 100.0), "directions": (50.0, 50.0)}
    other = {"curbs": (88.0, 100.0), "lanes": (98.0, 100.0), "lanes_right": (98.0, 100.0), "directions": (50.0, 50.0)}
    about = dict(kind="simulated", text="", points=1)
    given = [{"name": "one", **about, "streets": {"as surveyed": whole, "mirrored": other, "driven the other way": other}},
             {"name": "two", **about, "streets": {"as surveyed": whole, "mirrored": {"refused": "No road."}}}]
    table = results(given)
    text = page(table, samples=True)
    assert "| one (simulated) | 90.0 |" in text and "**all, by length**" in text
    assert "| mirrored (no map of 1) | -2.0 | – | – | – | · | – | +1.0 | · |" in text
    assert "| driven the other way (1 of 2 surveys) | -2.0 | – | – | – | · | – | +1.0 | – |" in text
    assert table.get("streets", "two", "mirrored", "refused") == "No road."
    assert "Not measured." in page(results([{"name": "one", **about, "streets": {"as surveyed": whole}}]), samples=True)


def test_a_street_without_a_map_is_on_the_page_with_the_reason():
    given = [{"name": "one", "kind": "real", "text": "", "points": 1, "streets": {"as surveyed": {"refused": "No road."}}}]
    assert "| one (real) | no map: No road. |" in page(results(given), samples=False)


def test_variants_are_those_that_the_page_tells_of():
    assert [variant.name for variant in VARIANTS] == ["mirrored", "turned by 37°", "driven the other way", "thinned by half"]
    assert Variant("as surveyed").places(TRACK, CENTRE) == pytest.approx(TRACK)


def test_only_some_surveys_are_measured_anew_and_the_page_keeps_the_figures_of_the_others(tmp_path, monkeypatch):
    from accuracy import __main__ as command

    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        for file in ("cloud.laz", "trajectory.csv", "truth.gpkg"):
            (tmp_path / name / file).touch()
    measured = []

    def run(arguments, check):
        survey, into = arguments[arguments.index("--one") + 1], arguments[arguments.index("--into") + 1]
        measured.append(Path(survey).name)
        right = float(len(measured))
        Path(into).write_text(json.dumps({"name": Path(survey).name, "kind": "real", "text": "", "points": 1, "steps": False,
                                          "streets": {"as surveyed": {"curbs": (right, 10.0)}}}))

    monkeypatch.setattr(command.subprocess, "run", run)
    for arguments in ([], ["--only", "two"]):
        monkeypatch.setattr("sys.argv", ["accuracy", "--surveys", str(tmp_path), *arguments])
        command.main()
    assert measured == ["one", "two", "two"]
    page = (tmp_path / "accuracy.md").read_text()
    assert "| one (real) | 10.0 |" in page and "| two (real) | 30.0 |" in page
    monkeypatch.setattr("sys.argv", ["accuracy", "--surveys", str(tmp_path), "--only", "three"])
    with pytest.raises(SystemExit, match="There is no survey three; there are one, two."):
        command.main()
