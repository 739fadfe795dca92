"""Intensity correction: asphalt of one brightness near and far, whichever scanner saw it."""

import html
import re
from dataclasses import replace

import numpy as np
import pytest
from heard import Heard
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.intensity import correction as intensity
from lanewright.core.intensity.asphalt_model import UNKNOWN_DISTANCE, VehicleDistances
from lanewright.core.intensity.correction import IntensitySettings, correct_intensity
from lanewright.core.intensity.scatter import ScannerScatter
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, Points, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory
from lanewright.products.report.page import html_page

LENGTH, HEIGHT = 60.0, 2.5


def straight_drive(time=True, reverse=False):
    along = np.linspace(0, LENGTH, 301)
    clock = along / 10 + 1000
    x = along[::-1] if reverse else along
    return build_frame(Trajectory(clock, x + 500_000, np.zeros(301) + 5_400_000, np.full(301, 100 + HEIGHT), has_time=time))


def falling(across, scanner):
    """What asphalt returns: less with distance, each scanner on its own level and highest on its own side."""
    return np.where(scanner == 0, 6000, 4000) / (1 + ((across - np.where(scanner == 0, 0.7, -0.7)) / 4) ** 2)


def street(law=falling, paint=2.5, seed=7, count=120_000, line=(3.4, 3.55), logarithmic=False):
    """Points of two scanners on a road 12 m wide, driven 2 m right of its middle; an edge line along it.

    Returns the records, the offset of each point from the vehicle, and whether it is paint.
    """
    rng = np.random.default_rng(seed)
    x, across = rng.uniform(0, LENGTH, count), rng.uniform(-4, 8, count)
    scanner = rng.integers(0, 2, count)
    painted = (across > line[0]) & (across < line[1])
    level = law(across, scanner)
    if logarithmic:
        value = 150 + 40 * np.log10(level / 5000) + np.where(painted, 45, 0) + rng.normal(0, 6, count)
    else:
        value = level * np.where(painted, paint, 1) * rng.lognormal(0, 0.12, count)
    records = np.zeros(count, ROAD_POINT)
    records["x"], records["y"], records["s"], records["d"] = to_units(x), to_units(across), to_units(x), to_units(across)
    records["time"] = x / 10 + 1000
    records["scanner"], records["intensity"], records["corrected"] = scanner, np.rint(value), np.nan
    return records, across, painted


def road_points(records, section_length=20.0):
    found = RoadPoints(SectionStore(ROAD_POINT, section_length), np.array([500_000.0, 5_400_000.0, 100.0]))
    found.store.append(0, records)
    return found


def corrected(records, frame=None, settings=IntensitySettings(), section_length=20.0):
    found, report = correct_intensity(road_points(records, section_length), frame or straight_drive(), settings)
    return found.all_points(), report


@pytest.mark.parametrize("pixels, points, photographs", [(400, 0, True), (100, 80, True), (0, 400, False)])
def test_brightness_of_photographs_stays_as_it_is_wherever_the_vehicle_drove_and_a_scanner_s_own_is_corrected(pixels, points, photographs):
    """Photographs may be noisy and even; what two points of one pixel differ by is less than what a scanner's points do."""
    records, across, _ = street()
    grain = np.random.default_rng(1).normal(0, pixels, (2000, 400))
    pixel = grain[(records["s"] // 400).astype(int), (records["d"] // 400 + 200).astype(int)]
    by_point = np.random.default_rng(2).normal(0, points, len(records))
    records["intensity"] = np.rint(4000 + 200 * across + pixel + by_point)
    road_points, report = corrected(records)
    assert ("photographs" in report.reason) == photographs
    assert np.isnan(road_points.corrected).all() == photographs


@pytest.mark.parametrize("light, count, photographs", [(0.3, 300_000, True), (0.3, 90_000, True), (0.0, 300_000, False)])
def test_neighbours_that_are_little_alike_are_of_photographs_where_both_scanners_see_each_place_as_bright(light, count, photographs):
    records, across, _ = street(count=count)
    rng = np.random.default_rng(1)
    metre, pixel = ((records["s"] // side, records["d"] // side + 40_000 // side) for side in (10_000, 400))
    level = 4000 * np.exp(rng.normal(0, light, (61, 13))[metre]) if light else falling(across, records["scanner"])
    records["intensity"] = np.rint(level * (1 + rng.normal(0, 0.05, (2000, 400))[pixel] + rng.normal(0, 0.042, len(records))))
    _, report = corrected(records)
    assert ("photographs" in report.reason) == photographs


@pytest.mark.parametrize("new", [lambda s: s < 30, lambda s: s % 20 < 8])
def test_asphalt_that_is_new_along_part_of_a_street_is_no_photograph_though_range_was_corrected(new):
    """Both scanners see it as dark, wherever it lies across the road."""
    records, _, _ = street(law=lambda across, scanner: np.full(len(across), 5000.0))
    records["intensity"] = np.rint(records["intensity"] * np.where(new(records["s"] * 1e-4), 0.5, 1.0))
    assert "photographs" not in corrected(records)[1].reason


@pytest.mark.parametrize("nats, text", [(1.0, "Along 40 m .* as alike as in photographs.*"), (-1.0, ".* nearly as alike .*"), (-9.0, "")])
def test_brightness_that_may_be_of_photographs_is_warned_of(nats, text):
    scatter = ScannerScatter({}, {(0, window): np.array([window]) for window in range(3)}, nats)
    assert re.fullmatch(text, scatter.doubt(20.0))


@pytest.mark.parametrize("noise, shorter, count", [(0.02, 1, 240_000), (0.04, 8, 300_000)])
def test_what_a_quiet_scanner_sees_fall_with_distance_is_corrected_and_not_taken_for_photographs_however_dense_its_points(noise, shorter, count):
    """Neighbours are as far from the vehicle, but no more alike than its noise lets them be."""
    records, across, _ = street(count=count)
    for name in "xs":
        records[name] //= shorter
    records["time"] = 1000 + (records["time"] - 1000) / shorter
    records["intensity"] = np.rint(6000 / (1 + (across / 4) ** 2) * np.random.default_rng(2).normal(1, noise, count))
    road_points, report = corrected(records)
    assert "photographs" not in report.reason
    assert np.isfinite(road_points.corrected).mean() > 0.9


def levels(points, value, paint):
    """Median of asphalt in each metre across and for each scanner, (scanners, metres)."""
    metre = np.floor(points.d).astype(int)
    return np.array([[np.median(value[(metre == m) & (points.scanner == k) & ~paint]) for m in range(-4, 8)] for k in (0, 1)])


def painted_of(points):
    return (points.d > 3.4) & (points.d < 3.55)


def test_asphalt_is_equally_bright_near_and_far_and_for_both_scanners():
    points, report = corrected(street()[0])
    before = levels(points, points.intensity, painted_of(points))
    after = levels(points, points.corrected, painted_of(points))
    assert before.max() / before.min() > 4
    assert after.max() / after.min() < 1.06
    assert report.scale == "linear" and len(report.scanners) == 2
    assert report.spread_after < 3 < 20 < report.spread_before


def test_a_line_painted_along_the_whole_road_stays_as_bright_as_its_paint():
    points, _ = corrected(street()[0])
    paint = painted_of(points)
    asphalt = np.median(points.corrected[~paint])
    assert abs(np.median(points.corrected[paint]) / asphalt - 2.5) < 0.15


def test_a_line_that_fills_its_distance_does_not_become_asphalt():
    points, _ = corrected(street(line=(3.05, 3.4))[0])
    paint = (points.d > 3.05) & (points.d < 3.4)
    beside = (points.d > 2.6) & (points.d < 2.95)
    assert abs(np.median(points.corrected[paint]) / np.median(points.corrected[beside]) - 2.5) < 0.25


@pytest.mark.parametrize("gutter", [(7.5, 8.0), (7.4, 8.0), (-4.0, -3.5), (3.5, 4.0)])
def test_a_gutter_that_fills_its_distance_from_the_vehicle_is_as_bright_after_the_correction_as_before(gutter):
    points, _ = corrected(street(line=gutter, paint=1.9)[0])
    concrete = (points.d > gutter[0]) & (points.d < gutter[1])
    # beyond the last known distance asphalt falls on, by a tenth in half a metre
    assert np.median(points.corrected[concrete]) / np.median(points.corrected[~concrete]) == pytest.approx(1.9, rel=0.12)


def test_logarithmic_intensities_are_shifted_not_scaled():
    records, _, _ = street(logarithmic=True)
    points, report = corrected(records)
    paint = painted_of(points)
    after = levels(points, points.corrected, paint)
    assert report.scale == "logarithmic"
    assert np.ptp(after) < 2.0
    assert abs(np.median(points.corrected[paint]) - np.median(points.corrected[~paint]) - 45) < 3
    far = (points.d > 6) & ~paint
    assert abs(points.corrected[far].std() - 6) < 1.0


def test_a_street_without_falloff_stays_as_it_is():
    points, report = corrected(street(law=lambda across, scanner: np.full(len(across), 5000.0))[0])
    np.testing.assert_allclose(points.corrected, points.intensity, rtol=0.03)
    assert report.spread_before < 1.5


def test_a_pass_driven_backwards_is_corrected_by_its_own_left_and_right():
    forth, _, _ = street(seed=1)
    back, across, _ = street(seed=2)
    # the second pass meets the first's left on its right: its scanners' falloff is mirrored on the road
    back["y"], back["d"] = -back["y"], -back["d"]
    back["time"] = (LENGTH - back["x"] * 1e-4) / 10 + 1020
    back["pass_number"] = 1
    along = np.linspace(0, LENGTH, 301)
    frame = build_frame(Trajectory(np.r_[along / 10 + 1000, along / 10 + 1020], np.r_[along, along[::-1]] + 500_000.0,
                                   np.full(602, 5_400_000.0), np.full(602, 100 + HEIGHT)))
    assert len(frame.passes) == 2 and len(frame.roads) == 1
    points, report = corrected(np.concatenate([forth, back]), frame)
    assert report.spread_after < 3
    for number in (0, 1):
        mine = points[points.pass_number == number]
        assert abs(np.median(mine.corrected) / np.median(points.corrected) - 1) < 0.03


@pytest.mark.parametrize("section_length", [7.0, 60.0])
def test_the_correction_does_not_depend_on_the_length_of_sections(section_length):
    records, _, _ = street(count=20_000)
    a, _ = corrected(records)
    b, _ = corrected(records[::-1], section_length=section_length)
    np.testing.assert_array_equal(np.sort(a.corrected), np.sort(b.corrected))


def test_far_asphalt_with_few_points_is_as_bright_as_near_asphalt():
    records, across, _ = street(paint=1.0)
    few = (np.abs(across) < 3) | (np.arange(len(across)) % 30 == 0)
    points, _ = corrected(records[few])
    far = np.array([np.median(points.corrected[(points.d >= 3) & (points.d < 8) & (points.scanner == scanner)]) for scanner in (0, 1)])
    near = np.median(points.corrected[np.abs(points.d) < 3])
    np.testing.assert_allclose(far, near, rtol=0.1)
    assert np.median(points.corrected[points.d >= 6.5]) == pytest.approx(near, rel=0.15)


def test_where_points_are_dense_stripes_of_road_give_the_same_asphalt(monkeypatch):
    """Of 2000 points a metre each ninth centimetre is sampled, whatever the length of sections."""
    usual, _ = corrected(street()[0])
    monkeypatch.setattr(intensity, "ASPHALT", replace(intensity.ASPHALT, enough_points_per_metre=220))
    striped, report = corrected(street()[0])
    other, _ = corrected(street()[0], section_length=7.3)
    assert np.median(np.abs(striped.corrected / usual.corrected - 1)) < 0.01
    assert sum(row["points"] for row in report.scanners) == len(usual)
    np.testing.assert_array_equal(striped.corrected, other.corrected)


@pytest.mark.parametrize("reverse", [False, True])
def test_points_are_left_or_right_of_the_vehicle_as_it_drove_and_as_far_away_as_measured(reverse):
    records, across, _ = street(count=5_000)
    frame = straight_drive(reverse=reverse)
    driven = frame.passes[0]
    found, away = VehicleDistances(frame.passes, records["time"]).of(Points(records))
    mine = records["d"] * 1e-4 - np.interp(records["time"], driven.time, driven.d)
    np.testing.assert_allclose(found * 1e-4, driven.direction * mine, atol=2e-4)
    there = [np.interp(records["time"], driven.time, row) for row in (driven.x, driven.y)]
    distance = np.hypot(records["x"] * 1e-4 - there[0], records["y"] * 1e-4 - there[1])
    np.testing.assert_allclose(np.abs(away) * 1e-4, distance, atol=0.006)
    late = records.copy()
    late["time"] += 100.0
    assert all((row == UNKNOWN_DISTANCE).all() for row in VehicleDistances(frame.passes, late["time"]).of(Points(late)))


def test_without_time_the_intensity_is_left_raw_and_the_report_says_why():
    points, report = corrected(street(count=5000)[0], straight_drive(time=False))
    assert np.isnan(points.corrected).all() and "gps_time" in report.reason
    assert report.lines() == [report.reason] and "gps_time" in html_page("intensity_correction", report=report)


def test_a_trajectory_of_another_day_leaves_the_intensity_raw():
    records = street(count=5000)[0]
    records["time"] += 86_400
    points, report = corrected(records)
    assert np.isnan(points.corrected).all() and "where the vehicle was" in report.reason


def test_a_handful_of_points_is_too_little_to_learn_from():
    points, report = corrected(street(count=50)[0])
    assert np.isnan(points.corrected).all() and "too few" in report.reason


def test_the_raw_intensity_is_kept():
    records = street(count=20_000)[0]
    points, _ = corrected(records)
    np.testing.assert_array_equal(np.sort(points.intensity), np.sort(records["intensity"]))


def test_an_unknown_scale_is_refused():
    with pytest.raises(RoadExtractionError, match="automatic, linear, logarithmic"):
        IntensitySettings(scale="decibel")


def warned(records):
    heard = Heard()
    _, report = correct_intensity(road_points(records), straight_drive(), progress=heard)
    return heard.warned, report


@pytest.mark.parametrize("scanners", [1, 2])
def test_an_export_that_cuts_off_the_brightest_sixth_of_the_road_is_warned_of(scanners):
    records, _, _ = street()
    records["scanner"] %= scanners
    top = np.percentile(records["intensity"], 84)
    records["intensity"] = np.rint(np.minimum(records["intensity"] * (255 / top), 255))
    warnings, report = warned(records)
    assert len(warnings) == 1 and warnings[0].startswith("16 % of the road's points have the highest intensity, 255:")
    assert warnings[0] in report.lines()
    assert warnings[0] in html.unescape(html_page("intensity_correction", report=report))


def test_an_export_that_cuts_off_the_darkest_third_of_the_road_is_warned_of():
    records, _, _ = street()
    low, top = np.percentile(records["intensity"], [33, 99.9])
    records["intensity"] = np.rint(np.clip((records["intensity"] - low) * (255 / (top - low)), 0, 255))
    warnings, _ = warned(records)
    assert len(warnings) == 1 and "of the road's points have the lowest intensity, 0:" in warnings[0]


def test_cut_off_paint_and_a_road_all_of_one_colour_are_not_warned_of():
    records, _, paint = street(law=lambda across, scanner: np.full(len(across), 5000.0))
    records["intensity"][paint] = 9000
    records["intensity"] = np.minimum(records["intensity"], 9000)
    assert warned(records)[0] == []
    assert 0.01 < np.mean(paint)


def seen_from_afar(records, away, law, scanner=0, count=300):
    """Records to which some road is added that is seen `away` metres left (positive) or right of the vehicle, as across the bend of a turn."""
    rng = np.random.default_rng(3)
    far = np.zeros(count, ROAD_POINT)
    x = rng.uniform(0, LENGTH, count)
    far["x"], far["s"] = to_units(x), to_units(x)
    far["y"] = far["d"] = to_units(np.broadcast_to(away, count))
    far["time"], far["scanner"], far["corrected"] = x / 10 + 1000, scanner, np.nan
    far["intensity"] = np.rint(law(np.broadcast_to(away, count), np.full(count, scanner)))
    return np.concatenate([records, far])


@pytest.mark.parametrize("scale", ["linear", "logarithmic"])
@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_road_seen_from_52_m_and_more_is_corrected_as_that_at_30_m_on_either_side(side, scale):
    away = side * np.r_[np.full(150, 30.2), np.linspace(31.0, 120.0, 150)]
    records = seen_from_afar(street()[0], away, lambda across, scanner: np.full(len(across), 300.0))
    points, report = corrected(records, settings=IntensitySettings(scale=scale))
    far = points.corrected[np.abs(points.d) > 30]
    assert len(far) == 300
    np.testing.assert_allclose(far, far[0], rtol=1e-6)
    assert far[0] > 300 and not report.reason


def test_a_scanner_that_hardly_met_the_road_keeps_its_raw_intensity_and_the_others_are_corrected():
    records = seen_from_afar(street()[0], 5.0, falling, scanner=2, count=100)
    points, report = corrected(records)
    few = points.scanner == 2
    assert np.isnan(points.corrected[few]).all() and np.isfinite(points.corrected[~few]).all()
    np.testing.assert_array_equal(points.value[few], points.intensity[few])
    assert [row["scanner"] for row in report.scanners] == [0, 1] and report.spread_after < 3


def test_points_measured_when_no_vehicle_drove_keep_their_raw_intensity():
    records = street()[0]
    records["time"][:500] += 3600.0
    points, report = corrected(records)
    lost = points.time > 4000
    assert np.isnan(points.corrected[lost]).all() and np.isfinite(points.corrected[~lost]).all()
    assert not report.reason
