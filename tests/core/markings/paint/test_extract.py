"""Which points of a street are paint."""

from dataclasses import replace

import numpy as np
import pytest
from heard import Heard
from lanewright.core.common import parallel
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.execution.keep import Keep
from lanewright.core.execution.phase import THREADS, Threads
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.io.geotiff import IntensityImage
from lanewright.core.markings.paint import windows
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.markings.paint.settings import MarkingSettings
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore, StoreIndex
from lanewright.core.survey.trajectory.trajectory import Trajectory
from lanewright.products.published_markings import METHODS
from painted_streets import ASPHALT, DENSITY, assert_same_points, drive, records_at, road_points, shuffled, street, strewn, strip
from scipy.ndimage import gaussian_filter

gdal = pytest.importorskip("osgeo.gdal")

FRAME = drive()


def grained(s, d, share, seed):
    """(N,) brightness of places where a grain of two pixels of a photograph has some share of it."""
    grain = gaussian_filter(np.random.default_rng(seed).normal(size=(3100, 800)), 2.0)
    return 1.0 + share * grain[(s / 0.02).astype(int), ((d + 8.0) / 0.02).astype(int)] / grain.std()


def found_on(records, folder, frame=FRAME, section_length=20.0, mask=None, progress=Progress(), of_colours=False):
    points = replace(road_points(records, frame, section_length), of_colours=of_colours)
    path = folder / "image.tif"
    make_intensity_image(points, path=path).close()
    return extract_markings(points, IntensityImage.open(path), frame, progress=progress, mask_path=mask).all_points()


def test_paint_and_mask_are_the_same_whether_the_image_is_read_from_its_file_or_not(tmp_path):
    records = street(FRAME, [strip(10, 50, 1.0, 1.15), strip(20, 20.5, -3.0, 1.0)])
    usual = found_on(records, tmp_path, mask=tmp_path / "a.tif")
    image = make_intensity_image(road_points(records, FRAME))
    found = extract_markings(road_points(records, FRAME), image, FRAME, mask_path=tmp_path / "b.tif").all_points()
    assert len(found) > 1000
    assert_same_points(found.records, usual.records)
    masks = [IntensityImage.open(tmp_path / name) for name in ("a.tif", "b.tif")]
    np.testing.assert_array_equal(*(mask.read_pixels(0, 0, mask.width, mask.height) for mask in masks))


def test_where_a_road_changed_tiles_and_paint_nearby_are_made_anew_and_the_map_is_as_if_all_were(monkeypatch):
    """Tiles of 20 m that are touched, and the windows of 20 m that take their levels from there."""
    frame = drive(length=320.0, radius=150.0)
    records = street(frame, [strip(10, 290, 1.0, 1.15)], length=300.0, density=200)
    before = road_points(records, frame, 5.0)
    for key in before.all_sections():
        before.section(*key)
    after = replace(before, store=SectionStore(ROAD_POINT, 5.0))
    after.store.adopt(StoreIndex.of((key, part) for key, part in before.store._sections.items() if key != (0, 21)))
    darker = np.array(before.section(0, 21).records)
    darker["intensity"] //= 2
    after.store.put(0, 21, darker)
    asked, run = {}, Threads.run

    def noting(self, phase, items, *others):
        asked[phase.function.__name__] = len(items)
        return run(self, phase, items, *others)

    def made(points, before=None):
        """The image, its pixels, and what is paint."""
        image = make_intensity_image(points, before=before)
        return image, image.read_pixels(0, 0, image.width, image.height), extract_markings(points, image, frame).all_points().records

    alone = made(after)
    monkeypatch.setattr(RoadPoints, "executor", Keep(THREADS))
    first = made(before)
    monkeypatch.setattr(Threads, "run", noting)
    again = made(after, first[0])
    np.testing.assert_array_equal(again[1], alone[1])
    assert_same_points(again[2], alone[2])
    assert not np.array_equal(again[1], first[1], equal_nan=True)
    # of 15 windows; a bend shows some more of the road
    assert 1 <= asked["paint_of_window"] <= 5


@pytest.mark.parametrize("radius", [np.inf, 80.0])
def test_a_painted_strip_is_found_with_its_width_to_2_cm(tmp_path, radius):
    frame = drive(radius=radius)
    paint = found_on(street(frame, [strip(10, 50, 1.0, 1.15)]), tmp_path, frame)
    low, high = np.percentile(paint.d, [2.5, 97.5])
    assert (high - low) / 0.95 == pytest.approx(0.15, abs=0.02)
    assert (low + high) / 2 == pytest.approx(1.075, abs=0.01)
    assert paint.s.min() == pytest.approx(10, abs=0.1) and paint.s.max() == pytest.approx(50, abs=0.1)


def test_asphalt_without_paint_yields_nothing(tmp_path):
    assert len(found_on(street(FRAME), tmp_path)) < 20


@pytest.mark.parametrize("brighter", [1.35, 1.5, 1.6, 1.7])
def test_patches_seams_and_worn_tracks_are_not_paint_nor_are_the_rims_of_patches(tmp_path, brighter):
    def level(s, d):
        patch = (s > 30) & (s < 36) & (d > -2) & (d < 1)
        return np.where(patch, brighter, 1.0) * (1 + 0.15 * np.cos(3 * d)) * np.where(np.abs(s - 50) < 0.03, 0.5, 1.0)

    assert len(found_on(street(FRAME, level=level), tmp_path)) == 0


@pytest.mark.parametrize("darker", [1.5, 3.0])
def test_a_line_in_photographs_is_found_in_the_shadow_of_a_house_and_beside_it_and_its_edge_is_no_paint(tmp_path, darker):
    line = strip(10, 50, 1.0, 1.15)

    def level(s, d):
        """Grain of two pixels, and a shadow whose edge runs across the road."""
        return grained(s, d, 0.06, 1) / np.where((s > 28 + d) & (s < 40 + d), darker, 1.0)

    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    records = records_at(FRAME, s, d, np.where(line(s, d), 1.8, 1.0) * ASPHALT * level(s, d), 4.0)
    found = found_on(records, tmp_path, progress=(heard := Heard()))
    assert "edges of shadows may be taken for it" in " ".join(heard.warned)
    on_line = strip(9.9, 50.1, 0.95, 1.2)(found.s, found.d)
    assert on_line.mean() > 0.98
    assert len(np.unique(found.s[on_line] // 0.5)) >= 78


def test_brightness_of_colours_is_that_of_photographs_also_where_each_point_scatters_by_itself(tmp_path):
    line = strip(10, 50, 1.0, 1.15)
    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    grain = np.random.default_rng(1).normal(1.0, 0.13, len(s)) / np.where((s + d) % 30.0 < 10.0, 2.0, 1.0)
    colours = records_at(FRAME, s, d, np.where(line(s, d), 2.2, 1.0) * ASPHALT * grain, 4.0)
    found = found_on(colours, tmp_path, of_colours=True)
    on_line = strip(9.9, 50.1, 0.95, 1.2)(found.s, found.d)
    assert on_line.mean() > 0.98
    assert len(np.unique(found.s[on_line] // 0.5)) >= 78


@pytest.mark.parametrize("darker", [3.0, 4.0])
def test_sun_between_the_shadows_of_cars_and_leaves_is_no_paint_and_a_line_that_runs_from_the_sun_into_the_shade_is(tmp_path, darker):
    line = strip(5, 55, 1.0, 1.15)

    def lit(s, d):
        """Sun before and behind a row of trees; below them flecks, and the gap between two cars."""
        flecks = np.any([(s - along) ** 2 + (d - across) ** 2 < 0.3**2 for along, across in ((25, -1), (31, -2), (34, 2.5), (41, -1.5))], axis=0)
        return (s < 20) | (s > 45) | flecks | ((np.abs(s - 37.5) < 0.2) & (np.abs(d + 2) < 0.9))

    def level(s, d):
        return grained(s, d, 0.06, 2) / np.where(lit(s, d), 1.0, darker)

    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    found = found_on(records_at(FRAME, s, d, np.where(line(s, d), 1.8, 1.0) * ASPHALT * level(s, d), 4.0), tmp_path)
    on_line = strip(4.9, 55.1, 0.95, 1.2)(found.s, found.d)
    assert on_line.mean() > 0.98
    assert len(np.unique(found.s[on_line] // 0.5)) >= 98


@pytest.mark.parametrize("darker, brighter, width", [(2.0, 1.15, 0.4), (4.0, 1.5, 0.2)])
def test_a_strip_of_asphalt_in_the_shade_that_is_a_little_brighter_or_half_in_the_sun_is_no_paint_in_photographs(tmp_path, darker, brighter, width):
    """It lies far from asphalt in the sun, as paint in the shade does, and is near to asphalt in the shade or darker than the sun nearby."""
    line, strip_in_shade = strip(5, 55, 1.0, 1.15), strip(30, 33, -2.0, width - 2.0)
    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    level = grained(s, d, 0.03, 5) * np.where(strip_in_shade(s, d), brighter, 1.0) / np.where((s > 22) & (s < 42), darker, 1.0)
    found = found_on(records_at(FRAME, s, d, np.where(line(s, d), 1.8, 1.0) * ASPHALT * level, 4.0), tmp_path)
    assert strip(4.9, 55.1, 0.95, 1.2)(found.s, found.d).mean() > 0.98
    assert len(np.unique(found.s // 0.5)) >= 98


def test_a_row_of_stripes_in_the_shade_is_paint_in_photographs_where_a_fleck_of_sun_joins_them(tmp_path):
    """Together they are as broad as long, and darker than the sun nearby; each of them is long and straight."""
    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    stripes = (np.abs(s - 31.5) < 1.5) & (np.abs(d) < 2.75) & ((d + 8.25) % 1.0 < 0.5)
    fleck = (np.abs(s - 31.5) < 0.15) & (np.abs(d) < 2.75)
    lit = np.where((np.abs(s - 32) > 10) | fleck, 1.5, 1.0)
    bright = np.where(stripes, 1.5, 1.0) * ASPHALT * grained(s, d, 0.03, 5) * lit / 1.5
    found = found_on(records_at(FRAME, s, d, bright, 4.0), tmp_path)
    on_stripes = (np.abs(found.s - 31.5) < 1.55) & ((found.d + 8.3) % 1.0 < 0.6)
    assert len(np.unique([found.s[on_stripes] // 0.5, found.d[on_stripes] // 1.0], axis=1).T) >= 36


def test_an_edge_line_in_the_shade_is_paint_in_photographs_where_a_band_of_sun_crosses_it_and_the_band_is_none(tmp_path):
    """Together they are ragged and as bright as the sun; of the line on either side of the band neither is true."""
    line = strip(0, 60, 2.0, 2.15)
    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    band = np.abs(s - 30 - 0.5 * d) < 0.4
    lit = np.where((np.abs(s - 30) > 8) | band, 3.0, 1.0)
    found = found_on(records_at(FRAME, s, d, np.where(line(s, d), 1.8, 1.0) * ASPHALT * grained(s, d, 0.05, 6) * lit / 3.0, 4.0), tmp_path)
    on_line = strip(0, 60, 1.95, 2.2)(found.s, found.d)
    assert on_line.mean() > 0.98
    assert len(np.unique(found.s[on_line] // 0.5)) >= 116


@pytest.mark.parametrize("way", [1, -1])
def test_worn_stripes_are_paint_in_photographs_of_unequal_exposure_that_darken_to_one_side(tmp_path, way):
    exposure = np.array([0.0, 0.2, -0.15, 0.1, -0.2, 0.05, 0.2, -0.1, 0.0, 0.15, -0.2, 0.1, 0.0, 0.2, -0.1])
    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    stripes = (s > 28.5) & (s < 30.5) & (np.abs(d) < 3.25) & ((d + 8.25) % 1.0 < 0.5)
    bright = np.where(stripes, 1.3, 1.0) * ASPHALT * grained(s, d, 0.04, 4) * np.exp(way * 0.08 * d + exposure[(s / 4).astype(int)])
    found = found_on(records_at(FRAME, s, d, bright, 4.0), tmp_path)
    on_stripes = (np.abs(found.s - 29.5) < 1.05) & ((found.d + 8.3) % 1.0 < 0.6)
    assert on_stripes.mean() > 0.98
    assert len(np.unique(found.d[on_stripes] // 0.5)) >= 12


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_specks_in_black_photographs_are_no_paint_and_a_line_before_and_behind_them_is(tmp_path):
    line = strip(0, 60, 1.0, 1.15)
    s, d = strewn(60.0, 4.0, -4.0, DENSITY)
    specks = np.random.default_rng(3).random(len(s)) < 0.001
    bright = np.where(line(s, d), 1.8, 1.0) * ASPHALT * grained(s, d, 0.06, 1) * ((s < 15) | (s > 45) | specks)
    found = found_on(records_at(FRAME, s, d, bright, 4.0), tmp_path)
    assert strip(0, 60, 0.95, 1.2)(found.s, found.d).mean() > 0.98
    assert {0, 1, 2, 9, 10, 11} <= set(np.unique(found.s // 5))


def test_a_line_along_the_rim_of_a_patch_is_paint(tmp_path):
    line = strip(20, 50, 1.0, 1.15)
    found = found_on(street(FRAME, [line], level=lambda s, d: np.where((s > 30) & (s < 36) & (d > -2) & (d < 1), 1.35, 1.0)), tmp_path)
    assert all(np.ptp(found.s[(found.s > s) & (found.s < s + 2)]) > 1.9 for s in range(20, 50, 2))


def test_an_edge_line_behind_a_band_of_water_is_paint_and_no_gutter(tmp_path):
    """The strip beyond the water is as bright as the rest of the road, and its line is the brightest of it."""
    line = strip(10, 50, 3.55, 3.67)
    records = street(FRAME, [line], density=2500, level=lambda s, d: np.where((d > 2.0) & (d < 3.3), 0.25, 1.0))
    records["corrected"] = records["intensity"]
    points = replace(road_points(records, FRAME), has_corrected=True)
    paint = extract_markings(points, make_intensity_image(points), FRAME).all_points()
    on = line(paint.s, paint.d)
    assert on.sum() > 0.9 * 2500 * 40 * 0.12 and on.mean() > 0.95


def test_what_wear_has_left_between_two_runs_of_paint_is_paint_and_a_speck_on_its_own_is_not(tmp_path):
    ends = [strip(10, 30, 1.0, 1.15), strip(33, 60, 1.0, 1.15)]
    specks = [strip(s, s + 0.04, 1.05, 1.10) for s in (30.6, 31.2, 31.8, 32.4)]
    alone = [strip(s, s + 0.04, -2.0, -1.95) for s in (30.6, 31.2, 31.8, 32.4)]
    paint = found_on(street(FRAME, ends + specks + alone, density=3000), tmp_path)
    for speck in specks:
        assert speck(paint.s, paint.d).any()
    assert not any(speck(paint.s, paint.d).any() for speck in alone)


def test_brightness_that_falls_with_distance_hides_no_line(tmp_path):
    lines = [strip(10, 50, d, d + 0.15) for d in (-3.5, 0.0, 3.5)]

    def fall(d):
        return 1.6 / (1 + 0.15 * (d + 4))

    records = street(FRAME, lines, noise=0.25)
    records["intensity"] = records["intensity"] * fall(records["d"] * 1e-4)
    paint = found_on(records, tmp_path)
    for line in lines:
        assert line(paint.s, paint.d).sum() > 0.9 * line(records["s"] * 1e-4, records["d"] * 1e-4).sum()


def test_a_zebra_crossing_and_a_stop_line_are_not_erased(tmp_path):
    marks = [strip(30, 34, d, d + 0.5) for d in np.arange(-3.5, 3.5, 1.0)] + [strip(27.0, 27.3, -3.5, -0.2)]
    records = street(FRAME, marks)
    paint = found_on(records, tmp_path)
    for mark in marks:
        assert mark(paint.s, paint.d).sum() > 0.9 * mark(records["s"] * 1e-4, records["d"] * 1e-4).sum()
    assert np.any([mark(paint.s, paint.d) for mark in marks], axis=0).mean() > 0.95


def test_a_concrete_gutter_is_left_out_and_the_edge_line_beside_it_kept(tmp_path):
    line = strip(5, 55, 3.2, 3.35)
    paint = found_on(street(FRAME, [line, strip(0, 80, 3.6, 4.0), strip(0, 80, -4.0, -3.6)]), tmp_path)
    assert line(paint.s, paint.d).mean() > 0.97
    assert np.count_nonzero(line(paint.s, paint.d)) > 0.9 * 50 * 0.15 * DENSITY


def test_what_parked_cars_leave_to_be_seen_of_a_gutter_is_no_paint(tmp_path):
    line = strip(5, 55, 2.9, 3.05)
    records = street(FRAME, [line], level=lambda s, d: np.where(d > 3.65, 2.6, 1.0))
    # shadows oblique, as a scanner mounted at 45 degrees casts them over the parking strip and the lane beside it
    s, d = records["s"] * 1e-4, records["d"] * 1e-4
    paint = found_on(records[~((d > -1.0) & ((s - d) % 6.0 < 4.0))], tmp_path)
    on_line = line(paint.s, paint.d)
    assert on_line.mean() > 0.97
    assert np.count_nonzero(on_line) > 0.85 * 50 * 0.15 * DENSITY / 3


def test_an_edge_line_painted_right_beside_a_gutter_is_found_and_the_gutter_is_not(tmp_path):
    line = strip(5, 55, 3.52, 3.67)
    street_ = street(FRAME, [line], level=lambda s, d: np.where(np.abs(d) > 3.7, 2.0, 1.0))
    paint = found_on(street_, tmp_path)
    assert line(paint.s, paint.d).mean() > 0.97
    assert np.count_nonzero(line(paint.s, paint.d)) > 0.9 * 50 * 0.15 * DENSITY


def test_a_line_painted_on_a_gutter_is_found_and_a_pale_gutter_as_narrow_as_a_line_is_not(tmp_path):
    lines = [strip(5, 55, 3.65, 3.8), strip(5, 55, 0.0, 0.15)]
    paint = found_on(street(FRAME, lines, level=lambda s, d: np.where(d > 3.5, 2.0, np.where(d < -3.84, 1.8, 1.0))), tmp_path)
    on_line = [line(paint.s, paint.d) for line in lines]
    assert np.any(on_line, axis=0).mean() > 0.97
    assert all(np.count_nonzero(on) > 0.9 * 50 * 0.15 * DENSITY for on in on_line)


@pytest.mark.parametrize("width", [0.12, 0.25])
def test_an_edge_line_with_a_decimetre_of_asphalt_between_it_and_the_curb_is_no_gutter(tmp_path, width):
    line = strip(5, 55, 3.9 - width, 3.9)
    paint = found_on(street(FRAME, [line, strip(5, 55, 0.0, 0.15)]), tmp_path)
    assert np.count_nonzero(line(paint.s, paint.d)) > 0.9 * 50 * width * DENSITY


@pytest.mark.parametrize("factor", [1.4, 2.2])
def test_a_pale_repair_in_a_lane_without_paint_is_road_and_a_line_across_it_is_paint(tmp_path, factor):
    lines = [strip(5, 55, d, d + 0.15) for d in (-3.5, 0.1, 3.35)]

    def repair(s, d):
        return np.where((s > 26) & (s < 33) & (d > -2.6) & (d < 0.8), factor, 1.0)

    paint = found_on(street(FRAME, lines, level=repair), tmp_path)
    on_line = np.any([line(paint.s, paint.d) for line in lines], axis=0)
    assert on_line.mean() > 0.97
    assert np.count_nonzero(strip(27, 32, 0.1, 0.25)(paint.s, paint.d)) > 0.9 * 5 * 0.15 * DENSITY


@pytest.mark.slow
def test_noisy_multi_beam_intensities_show_bars_of_paint_and_stay_silent_without(tmp_path):
    bar = strip(30, 34, 1.0, 1.3)
    s, d = strewn(24, 4, -4, 3000, start=20)
    rng = np.random.default_rng(9)

    def seen(painted):
        level = np.where(painted, 2.2 * ASPHALT, ASPHALT)
        return found_on(records_at(FRAME, s, d, np.abs(level + rng.normal(0, 0.55 * ASPHALT, len(s))), 4.0), tmp_path)

    paint = seen(bar(s, d))
    assert np.count_nonzero(bar(paint.s, paint.d)) > 0.8 * np.count_nonzero(bar(s, d))
    assert bar(paint.s, paint.d).mean() > 0.75
    assert len(seen(np.zeros(len(s), bool))) == 0


@pytest.mark.parametrize("ends, warnings", [((0, 100), 0), ((0, 84), 1), ((33, 100), 1)], ids=["whole", "bright end", "dark end"])
def test_intensities_cut_off_at_an_end_are_warned_of_also_where_nothing_is_corrected(tmp_path, ends, warnings):
    records, listener = street(FRAME, [strip(10, 50, 1.0, 1.15)]), Heard()
    low, high = np.percentile(records["intensity"], ends)
    records["intensity"] = np.rint(np.clip((records["intensity"] - low) / (high - low), 0, 1) * 1000)
    points = road_points(records, FRAME)
    make_intensity_image(points, path=tmp_path / "image.tif").close()
    extract_markings(points, IntensityImage.open(tmp_path / "image.tif"), FRAME, progress=listener)
    assert len(listener.warned) == warnings


def test_neither_the_order_of_points_nor_the_length_of_sections_matters(tmp_path):
    records = street(FRAME, [strip(10, 50, 1.0, 1.15), strip(39, 43, -2, -1.5)], density=500)
    plain = found_on(records, tmp_path).records
    other = found_on(shuffled(records), tmp_path, section_length=7.0).records
    assert_same_points(plain, other)


@pytest.mark.slow
def test_where_points_are_dense_a_share_of_them_gives_the_bins(tmp_path, monkeypatch):
    """Of 12 000 points a metre every fourth is used for the width of the bins."""
    line = strip(5, 55, 1.0, 1.15)
    records = street(FRAME, [line], density=1500)
    usual = found_on(records, tmp_path)
    monkeypatch.setattr(windows, "MAX_OFFSET_POINTS", 60_000)
    some = found_on(records, tmp_path)
    assert_same_points(some.records, found_on(shuffled(records), tmp_path, section_length=7.3).records)
    assert abs(len(some) - len(usual)) < 0.01 * len(usual)
    assert line(some.s, some.d).mean() > 0.97


def test_paint_before_and_after_a_stretch_without_points_is_found_by_any_number_of_threads(tmp_path, monkeypatch):
    line = strip(0, 150, 1.0, 1.15)
    frame = drive(160)
    records = street(frame, [line], length=160.0)
    s = records["s"] * 1e-4
    records = records[(s < 25) | ((s > 85) & (s < 95)) | (s > 130)]
    monkeypatch.setattr(parallel.os, "cpu_count", lambda: 1)
    usual = found_on(records, tmp_path, frame)
    monkeypatch.setattr(parallel.os, "cpu_count", lambda: 7)
    assert_same_points(usual.records, found_on(records, tmp_path, frame).records)
    on_line = line(records["s"] * 1e-4, records["d"] * 1e-4).sum()
    assert line(usual.s, usual.d).mean() > 0.97 and line(usual.s, usual.d).sum() > 0.9 * on_line


def test_paint_of_a_stretch_is_the_same_whatever_the_rest_of_the_road_is_like(tmp_path):
    frame = drive(160)
    faint = strip(40, 60, 1.0, 1.15)
    records = street(frame, [strip(0, 40, 1.0, 1.15), strip(60, 160, 1.0, 1.15)], 160.0, level=lambda s, d: 1 + 0.26 * faint(s, d))
    s = records["s"] * 1e-4
    whole, part = (found_on(some, tmp_path, frame).records for some in (records, records[(s > 35) & (s < 65)]))
    whole, part = (found[(found["s"] >= to_units(40)) & (found["s"] < to_units(60))] for found in (whole, part))
    assert len(whole) > 1000
    assert_same_points(whole, part)


@pytest.mark.slow
def test_the_mask_lies_on_the_image_and_covers_the_paint(tmp_path):
    line = strip(10, 50, 1.0, 1.15)
    frame = drive(radius=80.0)
    records = street(frame, [line])
    found_on(records, tmp_path, frame, mask=tmp_path / "mask.tif")
    image, mask = IntensityImage.open(tmp_path / "image.tif"), IntensityImage.open(tmp_path / "mask.tif")
    assert (mask.geotransform, mask.width, mask.height) == (image.geotransform, image.width, image.height)
    covered = mask.sample(records["x"] * 1e-4, records["y"] * 1e-4, frame.origin) == 1
    painted = line(records["s"] * 1e-4, records["d"] * 1e-4)
    assert covered[painted].mean() > 0.90
    assert painted[covered].mean() > 0.85


def test_settings_without_sense_are_refused():
    with pytest.raises(RoadExtractionError):
        MarkingSettings(separation=-1.0)


def noisy_bar(frame, road, start, end, scanner, noisy, seed=3):
    """Records of a road with a bar of paint from station 30 to 34, seen by a quiet or a noisy scanner."""
    s, d = strewn(end - start, 4, -4, 1200, seed)
    s = s + start
    level = np.where(BAR(s, d), 2.2 * ASPHALT, ASPHALT)
    scatter = np.random.default_rng(seed + 1).normal(0, 0.55 if noisy else 0.08, len(s))
    records = records_at(frame, s, d, np.abs(level + scatter * ASPHALT), 4.0)
    x, y = frame.road(road).to_map(records["s"] * 1e-4, records["d"] * 1e-4)
    records["x"], records["y"] = to_units(x), to_units(y)
    records["scanner"] = scanner
    return records


BAR = strip(30, 34, 1.0, 1.3)


def found_and_said(tiles, frame, folder):
    """Paint of road 0 before station 55, and the sentences about scatter; `tiles` are pairs of road and records."""
    points, listener = RoadPoints(SectionStore(ROAD_POINT, 20.0), frame.origin), Heard()
    for road, records in tiles:
        points.store.append(road, records)
    make_intensity_image(points, path=folder / "image.tif").close()
    found = extract_markings(points, IntensityImage.open(folder / "image.tif"), frame, progress=listener)
    paint = found.window(0, 0, 55)
    return paint, [text for text in listener.said if "on asphalt scatter" in text]


@pytest.mark.parametrize("noisy", [True, False], ids=["noisy", "quiet"])
def test_a_tile_beside_of_another_scanner_leaves_the_method_on_this_street_as_it_is(tmp_path, noisy):
    frame = drive(120)
    street_ = noisy_bar(frame, 0, 0, 60, 0, noisy)
    alone, (said,) = found_and_said([(0, street_)], frame, tmp_path)
    beside = noisy_bar(frame, 0, 60, 110, 1, not noisy, seed=8)
    both, (said_of_both,) = found_and_said([(0, np.concatenate([street_, beside]))], frame, tmp_path)
    on_bar = np.count_nonzero(BAR(street_["s"] * 1e-4, street_["d"] * 1e-4))
    assert np.count_nonzero(BAR(alone.s, alone.d)) > 0.8 * on_bar
    if noisy:
        assert_same_points(np.asarray(alone.records), np.asarray(both.records))
    else:
        assert abs(len(both) - len(alone)) < 0.02 * len(alone)
    assert ("averages" in said) == noisy and "scanner 0" in said and "scanner 1" not in said
    assert "Along " in said_of_both and "scanner 0" in said_of_both and "scanner 1" in said_of_both


def test_another_road_of_a_noisy_scanner_leaves_the_method_on_this_street_as_it_is(tmp_path):
    s = np.arange(0.0, 70.0, 0.1)
    frame = build_frame(Trajectory(np.r_[s / 10, s / 10 + 500], np.r_[s, s] + 500_000, np.repeat([5_400_000.0, 5_400_060.0], len(s)),
                                   np.full(2 * len(s), 102.0)))
    assert len(frame.roads) == 2
    street_, other = noisy_bar(frame, 0, 0, 59.9, 0, noisy=False), noisy_bar(frame, 1, 0, 59.9, 1, noisy=True, seed=8)
    alone, _ = found_and_said([(0, street_)], frame, tmp_path)
    both, (said,) = found_and_said([(0, street_), (1, other)], frame, tmp_path)
    assert len(alone) > 500 and abs(len(both) - len(alone)) < 0.02 * len(alone)
    # one scatters by half of asphalt's level, the other by a twelfth
    assert "Along 60 of 120 m" in said


def test_a_noisy_scanner_that_measured_forty_metres_of_a_quiet_street_is_known_there(tmp_path):
    """None of the windows that are usually examined lies in its 40 m."""
    frame = drive(90)
    quiet = noisy_bar(frame, 0, 0, 79.9, 0, noisy=False)
    outside = quiet[(quiet["s"] < to_units(20)) | (quiet["s"] >= to_units(60))]
    paint, (said,) = found_and_said([(0, np.concatenate([outside, noisy_bar(frame, 0, 20, 59.9, 1, noisy=True, seed=8)]))], frame, tmp_path)
    assert "8 % (scanner 0)" in said and "(scanner 1)" in said and "Along 40 of 80 m" in said
    assert BAR(paint.s, paint.d).mean() > 0.75


def test_a_street_with_too_few_points_to_tell_their_scatter_is_searched_all_the_same(tmp_path):
    frame = drive(90)
    thin = noisy_bar(frame, 0, 0, 79.9, 0, noisy=False)[::60]
    paint, said = found_and_said([(0, thin)], frame, tmp_path)
    assert len(paint) <= len(thin) and not said


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_points_without_a_corrected_intensity_among_corrected_ones_hide_no_paint(tmp_path, method):
    line = strip(10, 50, 1.0, 1.15)
    records = street(FRAME, [line])
    records["corrected"] = records["intensity"]
    records["corrected"][::7] = np.nan
    points = road_points(records, FRAME)
    points.has_corrected = True
    make_intensity_image(points, path=tmp_path / "image.tif").close()
    paint = extract_markings(points, IntensityImage.open(tmp_path / "image.tif"), FRAME, MarkingSettings(method=method)).all_points()
    assert line(paint.s, paint.d).mean() > 0.9
    assert 0.1 < np.isnan(paint.corrected).mean() < 0.2
