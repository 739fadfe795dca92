"""The published ways of finding paint that ours is compared with."""

import numpy as np
import pytest
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.io.geotiff import IntensityImage
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.markings.paint.settings import MarkingSettings
from lanewright.products import published_markings as point_segments
from lanewright.products.published_markings import METHODS as ALL_METHODS
from lanewright.products.published_markings import IntensityPeaks, PointSegments, dense_enough, in_chains, profile_peaks, segment_thresholds
from painted_streets import ASPHALT, DENSITY, PAINT, assert_same_points, drive, records_at, road_points, shuffled, street, strip

FRAME = drive()
METHODS = ("intensity-peaks", "point-segments")
PROFILE = 2000  # units of 0.1 mm, 0.2 m


def found_on(records, method, frame=FRAME, section_length=20.0, **settings):
    points = road_points(records, frame, section_length)
    return extract_markings(points, None, frame, MarkingSettings(method=ALL_METHODS[method], **settings)).all_points()


def profile(*paint, noise=0.03, seed=3):
    """One profile of 0.2 m across a road 8 m wide, painted from d0 to d1 for each pair."""
    rng = np.random.default_rng(seed)
    d = np.repeat(np.arange(-4.0, 4.0, 0.02) + 0.01, 6)
    painted = np.any([(d > d0) & (d < d1) for d0, d1 in paint], axis=0) if paint else np.zeros(len(d), bool)
    records = records_at(FRAME, rng.uniform(20.0, 20.2, len(d)), d, np.where(painted, PAINT, ASPHALT) * rng.normal(1, noise, len(d)), 4)
    return records, (records["s"] // PROFILE).astype(np.int64)


def test_one_profile_shows_its_lines_as_peaks_of_their_width():
    _, left, right = profile_peaks(*profile((-3.5, -3.35), (0.0, 0.12), (3.2, 3.5)), IntensityPeaks())
    np.testing.assert_allclose(np.c_[left, right] * 1e-4, [[-3.5, -3.35], [0.0, 0.12], [3.2, 3.5]], atol=0.03)


@pytest.mark.parametrize("paint", [(), ((1.0, 1.04),)])
def test_asphalt_and_a_filled_crack_are_no_peaks(paint):
    assert len(profile_peaks(*profile(*paint), IntensityPeaks())[0]) == 0


def test_a_profile_with_a_shadow_in_it_has_the_same_peak():
    records, row = profile((2.0, 2.15))
    seen = (records["d"] < -10_000) | (records["d"] > 5_000)
    _, left, right = profile_peaks(records[seen], row[seen], IntensityPeaks())
    np.testing.assert_allclose(np.c_[left, right] * 1e-4, [[2.0, 2.15]], atol=0.03)


def test_peaks_chain_along_the_road_and_not_across_it():
    line = np.arange(0, 50)
    drifting = np.rint(20_000 + 300.0 * line).astype(np.int64)     # 3 cm a profile
    scattered = np.array([3, 17, 31]), np.array([-30_000, 5_000, -12_000])
    kept = in_chains(np.r_[line, scattered[0]], np.r_[drifting, scattered[1]], IntensityPeaks())
    np.testing.assert_array_equal(kept, np.r_[np.ones(50, bool), np.zeros(3, bool)])


def test_a_chain_with_more_holes_than_peaks_is_chance():
    row = np.arange(0, 60, 2)
    assert not in_chains(row, np.full(len(row), 10_000), IntensityPeaks()).any()
    assert in_chains(row // 2, np.full(len(row), 10_000), IntensityPeaks()).all()


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("radius", [np.inf, 80.0])
def test_lines_are_found_with_their_width_to_4_cm(method, radius):
    frame = drive(radius=radius)
    paint = found_on(street(frame, [strip(10, 50, 1.2, 1.35)]), method, frame)
    low, high = np.percentile(paint.d, [2.5, 97.5])
    assert (high - low) / 0.95 == pytest.approx(0.15, abs=0.04)
    assert (low + high) / 2 == pytest.approx(1.275, abs=0.01)
    assert paint.s.min() == pytest.approx(10, abs=0.25) and paint.s.max() == pytest.approx(50, abs=0.25)
    assert len(paint) > 0.85 * 40 * 0.15 * DENSITY


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("noise", [0.02, 0.25])
def test_a_road_without_paint_yields_nothing(method, noise):
    assert len(found_on(street(FRAME, noise=noise), method)) == 0


@pytest.mark.parametrize("method", METHODS)
def test_brightness_that_falls_with_distance_hides_no_line(method):
    lines = [strip(10, 50, d, d + 0.15) for d in (-3.5, 0.2, 3.3)]
    records = street(FRAME, lines)
    records["intensity"] = records["intensity"] * (1.6 / (1 + 0.15 * (records["d"] * 1e-4 + 4)))
    paint = found_on(records, method)
    for line in lines:
        assert line(paint.s, paint.d).sum() > 0.8 * line(records["s"] * 1e-4, records["d"] * 1e-4).sum()


def test_segments_find_a_stop_line_that_peaks_cannot_see():
    bar = strip(30.0, 30.4, -3.5, -0.2)
    records = street(FRAME, [bar])
    painted = np.count_nonzero(bar(records["s"] * 1e-4, records["d"] * 1e-4))
    by_segments, by_peaks = (found_on(records, method) for method in ("point-segments", "intensity-peaks"))
    assert np.count_nonzero(bar(by_segments.s, by_segments.d)) > 0.8 * painted
    assert len(by_peaks) == 0


def test_bright_points_strewn_over_asphalt_are_not_dense_enough():
    records = street(FRAME, [strip(0, 80, 1.2, 1.35)], length=10.0, density=1000)
    rng = np.random.default_rng(4)
    records["intensity"][rng.choice(len(records), 300, replace=False)] = PAINT
    bright = records[records["intensity"] > 2 * ASPHALT]
    kept = bright[dense_enough(bright, np.ones(len(bright), bool), PointSegments())]
    on_line = (kept["d"] > 12_000) & (kept["d"] < 13_500)
    assert on_line.mean() > 0.95
    assert np.count_nonzero(on_line) > 0.85 * np.count_nonzero((bright["d"] > 12_000) & (bright["d"] < 13_500))


def test_points_at_one_place_are_asked_for_once_and_judged_as_when_each_is_asked(monkeypatch):
    bright = np.repeat(street(FRAME, [strip(0, 80, 1.2, 1.35)], length=2.0, density=300), 25)
    own, asked = np.arange(len(bright)) % 3 > 0, []

    class Tree(point_segments.cKDTree):
        def query_ball_point(self, places, *args, **kwargs):
            asked.append(len(places))
            return super().query_ball_point(places, *args, **kwargs)

    monkeypatch.setattr(point_segments, "cKDTree", Tree)
    once = dense_enough(bright, own, PointSegments())
    monkeypatch.setattr(point_segments, "occupied", lambda s, d: (np.stack([s, d], axis=1), np.arange(len(s))))
    each = dense_enough(bright, own, PointSegments())
    np.testing.assert_array_equal(once, each)
    assert asked == [len(bright) // 25, own.sum()] and 0 < once.sum() < own.sum()


def test_each_segment_has_a_threshold_of_its_own_between_asphalt_and_paint():
    records = street(FRAME, [strip(0, 80, 1.2, 1.35), strip(0, 80, -2.4, -2.25)], level=lambda s, d: np.where(d > 0, 3.0, 1.0), length=10.0)
    records["intensity"][records["d"] > 12_000] = np.minimum(records["intensity"][records["d"] > 12_000] * 2.0, 65535)
    limits = segment_thresholds(records, PointSegments())
    assert ASPHALT < limits[-3] < PAINT
    assert 3 * ASPHALT < limits[1] and np.isinf(limits[3])


@pytest.mark.parametrize("method", METHODS)
def test_neither_the_order_of_points_nor_the_length_of_sections_matters(method):
    records = street(FRAME, [strip(10, 50, 1.2, 1.35), strip(39, 43, -2, -1.8)], density=500)
    plain = found_on(records, method).records
    assert len(plain)
    assert_same_points(plain, found_on(shuffled(records), method, section_length=7.0).records)


@pytest.mark.parametrize("method", METHODS)
def test_driving_the_other_way_finds_the_same_paint(method):
    marks = [strip(10, 50, 1.2, 1.35)]
    ahead = found_on(street(FRAME, marks), method)
    mirrored = street(FRAME, marks)
    s, d = mirrored["s"].copy(), mirrored["d"].copy()
    back = records_at(FRAME, 60.0 - s * 1e-4, -d * 1e-4, mirrored["intensity"].astype(float), 4.0)
    back = found_on(back, method)
    assert len(back) == pytest.approx(len(ahead), rel=0.01)
    assert np.median(back.d) == pytest.approx(-np.median(ahead.d), abs=0.005)


@pytest.mark.parametrize("method", METHODS)
def test_the_mask_covers_the_paint_in_the_pixels_of_the_image(tmp_path, method):
    pytest.importorskip("osgeo.gdal")
    line, frame = strip(10, 50, 1.2, 1.35), drive(radius=80.0)
    records = street(frame, [line])
    points = road_points(records, frame)
    make_intensity_image(points, path=tmp_path / "image.tif").close()
    image = IntensityImage.open(tmp_path / "image.tif")
    extract_markings(points, image, frame, MarkingSettings(method=ALL_METHODS[method]), mask_path=tmp_path / "mask.tif")
    mask = IntensityImage.open(tmp_path / "mask.tif")
    assert (mask.geotransform, mask.width, mask.height) == (image.geotransform, image.width, image.height)
    covered = mask.sample(records["x"] * 1e-4, records["y"] * 1e-4, frame.origin) == 1
    painted = line(records["s"] * 1e-4, records["d"] * 1e-4)
    assert covered[painted].mean() > 0.85
    assert painted[covered].mean() > 0.70
