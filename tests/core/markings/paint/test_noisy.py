"""Paint on streets seen by a noisy spinning scanner: strokes and rows of dashes are found, and what only looks bright is not."""

import numpy as np
import pytest
from lanewright.core.intensity.correction import correct_intensity
from lanewright.core.markings.objects.repeating import likely_rows, rows_of_dashes
from lanewright.core.markings.objects.shape import measure
from lanewright.core.markings.paint.extract import extract_markings
from lanewright.core.markings.paint.noisy import CellAverages, ViewSamples, noisy_paint_cells
from lanewright.core.markings.weights import NOISY
from scipy.ndimage import gaussian_filter
from spun_streets import spun


class NoImage:
    """Averages are taken of the points: the image is not used."""


def strip(x0, x1, y0, y1):
    return lambda x, y: (x >= x0) & (x < x1) & (y >= y0) & (y < y1)


def dashes(count, first=12.0, length=0.5, gap=0.5, y=2.6, width=0.15, oblique=0.0):
    """A row of dashes along the road, or `oblique` radians to it."""
    def painted(px, py):
        along = (px - first) * np.cos(oblique) + (py - y) * np.sin(oblique)
        across = (py - y) * np.cos(oblique) - (px - first) * np.sin(oblique)
        number = np.floor(along / (length + gap))
        return (np.abs(across) < width / 2) & (number >= 0) & (number < count) & (along - number * (length + gap) < length)
    return painted


ALONG, OBLIQUE, ACROSS = dashes(6, first=8.0, y=3.5), dashes(6, first=16.0, y=1.0, oblique=0.7), dashes(6, first=24.0, y=-5.0, oblique=np.pi / 2)
SPOT = dashes(1, first=32.0, y=2.0)
LINE, STOP_LINE = strip(8.0, 20.0, -2.5, -2.35), strip(28.0, 28.3, -3.0, 0.0)
CURB_FACE, BENEATH_A_CAR = strip(30.0, 42.0, 5.0, 5.15), strip(33.0, 39.0, -5.0, -4.7)
STREAK, PATCH = strip(10.0, 16.0, -6.0, -5.7), strip(35.0, 41.0, 0.5, 2.5)
LED_ON, ALONE, PAIR = dashes(4, first=14.0, y=3.5), dashes(4, first=14.0, y=-1.0), dashes(2, first=33.0, y=-2.0)
WORN = 2.4   # of 256 levels that a worn dash is brighter than asphalt: a tenth of fresh paint
FRESH = (ALONG, OBLIQUE, ACROSS, LINE, STOP_LINE)
PAINTED = (*FRESH, LED_ON, ALONE)
BRIGHT = FRESH + (SPOT, CURB_FACE, BENEATH_A_CAR)


def glare(x, y, turn):
    """A streak that shines at the vehicle as it passes, a patch of lighter asphalt that fades out, and worn dashes."""
    patch = 14 * np.exp(-0.5 * (((x - 38) / 1.5) ** 2 + ((y - 1.5) / 0.4) ** 2))
    return np.where(STREAK(x, y) & (turn >= 25) & (turn < 28), 220, 0) + patch + np.where(LED_ON(x, y) | ALONE(x, y) | PAIR(x, y), WORN, 0)


def everything_and_found(section_length=20.0):
    """All points of one street with everything on it, and those that were found to be paint."""
    points, frame = spun(lambda x, y: np.any([mark(x, y) for mark in BRIGHT], axis=0), section_length=section_length, glare=glare, noisy=True,
                         height=lambda x, y: 0.08 * np.clip((y - 5.0) / 0.15, 0, 1) * ((x > 29) & (x < 43)),
                         covered=strip(33.0, 39.0, -6.0, -4.0))
    points = correct_intensity(points, frame)[0]
    return points.all_points(), extract_markings(points, NoImage(), frame).all_points()


@pytest.fixture(scope="module")
def street():
    return everything_and_found()


def found_of(mark, street):
    """Share of a mark's points that were found."""
    everything, found = street
    return mark(found.x, found.y).sum() / mark(everything.x, everything.y).sum()


@pytest.mark.parametrize("row", [ALONG, OBLIQUE, ACROSS])
def test_short_dashes_in_a_row_are_found_whichever_way_the_row_runs(street, row):
    assert found_of(row, street) > 0.6


def test_lines_and_stop_lines_are_found_by_their_shape_alone(street):
    assert found_of(LINE, street) > 0.7 and found_of(STOP_LINE, street) > 0.7


def test_what_is_found_is_paint(street):
    _, found = street
    assert np.any([mark(found.x, found.y) for mark in PAINTED], axis=0).mean() > 0.7


def test_a_single_bright_spot_as_large_as_a_dash_is_no_marking(street):
    assert found_of(SPOT, street) == 0


def test_the_face_of_a_curb_as_bright_as_paint_is_no_line(street):
    assert found_of(CURB_FACE, street) < 0.02


def test_what_shines_beneath_a_parked_car_is_no_line(street):
    assert found_of(BENEATH_A_CAR, street) == 0


def test_a_streak_that_is_bright_from_one_place_only_is_no_line(street):
    everything, _ = street
    beside = strip(10.0, 16.0, -6.9, -6.2)
    bright, dark = (everything.value[area(everything.x, everything.y)].mean() for area in (STREAK, beside))
    line = everything.value[LINE(everything.x, everything.y)].mean()
    assert bright - dark > 0.5 * (line - dark)
    assert found_of(STREAK, street) == 0


def test_a_patch_of_lighter_asphalt_that_fades_out_is_no_paint(street):
    assert found_of(PATCH, street) == 0


def test_worn_dashes_are_found_where_they_lead_on_a_row_or_are_one_and_two_of_them_are_not(street):
    assert found_of(LED_ON, street) > 0.3 and found_of(ALONE, street) > 0.3 and found_of(PAIR, street) == 0


@pytest.mark.parametrize(("rows", "columns", "is_paint"), [(slice(40, 140), slice(60, 64), True), (slice(60, 64), slice(20, 120), True),
                                                            (slice(40, 140), slice(60, 72), True),
                                                            (slice(40, 65), slice(60, 64), False), (slice(40, 140), slice(60, 80), False)])
def test_a_long_piece_no_broader_than_a_stop_line_is_paint_though_it_is_faint_and_a_short_or_broader_one_is_none(rows, columns, is_paint):
    mark = np.zeros((180, 140), bool)
    mark[rows, columns] = True
    found = found_in_averages(mark, 2.2)
    assert (found[mark].mean() > 0.7) == is_paint
    assert found.any() == is_paint and found[~mark].mean() < 0.02


def found_in_averages(mark, brightness, rim=3.0, slope=0.0):
    """Cells of paint where a mark is so many spreads brighter than asphalt, at so many metres from the rim, and steep in metres per metre."""
    rng = np.random.default_rng(3)
    noise = gaussian_filter(rng.normal(size=mark.shape), NOISY.spot_sigma)
    contrast = (0.4 * noise / noise.std() + gaussian_filter(brightness * mark, NOISY.spot_sigma)).astype(np.float32)
    tilt = np.stack([np.where(mark, slope, 0.0), np.zeros(mark.shape)])
    averages = CellAverages(contrast, np.full(mark.shape, 50.0), np.ones(mark.shape, np.float32), tilt.astype(np.float32))
    samples = ViewSamples(np.arange(contrast.size), contrast.ravel(), np.zeros(contrast.size, bool))
    return noisy_paint_cells(averages, np.full(mark.shape, rim), samples, threshold=3.0)


@pytest.mark.parametrize(("rim", "slope", "is_paint"), [(0.16, 0.0, True), (0.16, 0.05, False), (0.04, 0.0, False), (3.0, 0.05, False)])
def test_a_stroke_near_the_rim_of_the_road_is_paint_if_it_is_flat_and_not_at_the_very_rim(rim, slope, is_paint):
    mark = np.zeros((180, 140), bool)
    mark[40:100, 60:64] = True
    assert (found_in_averages(mark, 8.0, rim, slope)[mark].mean() > 0.7) == is_paint


@pytest.mark.parametrize("count", [1, 6])
def test_blocks_as_broad_as_long_are_paint_in_a_row_and_one_of_them_is_none(count):
    mark = np.zeros((180, 140), bool)
    for row in range(30, 30 + 14 * count, 14):
        mark[row:row + 7, 60:67] = True
    assert (found_in_averages(mark, 4.0)[mark].mean() > 0.7) == (count == 6)


@pytest.mark.slow
def test_the_length_of_sections_does_not_change_what_is_found(street):
    places = [np.sort(points.x * 1e4 + points.y) for points in (street[1], everything_and_found(7.0)[1])]
    np.testing.assert_array_equal(*places)


def shape_of(s, d, length=0.5, width=0.15):
    """Shape of a dash along the road with its middle at s, d."""
    along, across = np.meshgrid(np.arange(s - length / 2, s + length / 2, 0.04), np.arange(d - width / 2, d + width / 2, 0.04))
    return measure(*(np.rint(axis.ravel() / 1e-4).astype(np.int64) for axis in (along, across)))


def test_four_dashes_in_line_are_a_row_and_three_are_none():
    shapes = [shape_of(s, 0.02 * s) for s in (0.0, 1.0, 2.0, 3.0)]
    assert [row.tolist() for row in rows_of_dashes(shapes)] == [[0, 1, 2, 3]]
    assert rows_of_dashes(shapes[:3]) == []


@pytest.mark.parametrize("dash, gap", [(1.0, 2.0), (0.9, 2.7), (0.5, 1.0)])
def test_dashes_are_a_row_at_any_gap_that_is_up_to_three_times_as_long_as_they(dash, gap):
    """A metre with gaps of two, as along bus stops; three feet with gaps of nine, as lines are extended in the United States."""
    uneven = np.array([0.0, 0.05, -0.04, 0.03, 0.05])
    assert [len(row) for row in rows_of_dashes([shape_of(s, 0.0, dash) for s in (dash + gap) * np.arange(5) + uneven])] == [5]


def test_a_dash_worn_away_does_not_end_a_row_and_dashes_beside_each_other_are_none():
    assert [len(row) for row in rows_of_dashes([shape_of(s, 0.0) for s in (0.0, 0.9, 2.7, 3.6, 4.5)])] == [5]
    assert rows_of_dashes([shape_of(0.0, d) for d in (0.0, 1.0, 2.0, 3.0)]) == []


def test_a_row_leads_on_to_dim_dashes_one_or_two_steps_ahead_at_either_end_and_not_past_three():
    shapes = [shape_of(s, 0.1 * s) for s in (3.0, 1.0, 2.0, 4.0, 6.0, 7.0, 0.0, 10.0)]
    dim = np.array([2.0, 2.0, 2.0, 2.0, -1.0, -1.0, -1.0, -1.0])
    assert [sorted(row.tolist()) for row in likely_rows(shapes, dim)] == [[0, 1, 2, 3, 4, 5, 6]]


def test_a_row_does_not_lead_on_to_what_lies_beside_its_line_or_is_no_dash_of_its_length():
    shapes = [shape_of(s, 0.0) for s in (1.0, 2.0, 3.0, 4.0)]
    others = [shape_of(5.0, 0.2), shape_of(5.0, 0.0, length=1.6), shape_of(4.4, 0.0), shape_of(5.0, 0.0, width=0.48)]
    rows = likely_rows(shapes + others, np.array([2.0] * 4 + [-1.0] * 4))
    assert [sorted(row.tolist()) for row in rows] == [[0, 1, 2, 3]]


def test_two_dashes_are_no_row_however_bright_and_four_dim_ones_at_an_even_pace_are():
    assert likely_rows([shape_of(s, 0.0) for s in (1.0, 2.0)], np.array([9.0, 9.0])) == []
    assert [len(row) for row in likely_rows([shape_of(s, 0.0) for s in (1.0, 2.0, 3.0, 4.0)], np.zeros(4))] == [4]
    assert likely_rows([shape_of(s, d) for s, d in ((1.0, 0.0), (1.7, 0.1), (3.3, 0.0), (4.0, 0.1))], np.zeros(4)) == []


def test_spots_strewn_about_are_no_row():
    rng = np.random.default_rng(3)
    places = rng.uniform(0, 12, (40, 2))
    assert sum(len(row) for row in rows_of_dashes([shape_of(s, d) for s, d in places])) < 8


def test_paint_is_no_ground_that_it_is_compared_with():
    shape, rng = (300, 150), np.random.default_rng(8)
    cell = np.repeat(np.arange(shape[0] * shape[1]), 2)
    row, column = np.divmod(cell, shape[1])
    bar = (row >= 150) & (row < 160) & (column >= 30) & (column < 120)
    value = 100.0 + 60.0 * bar + rng.normal(0.0, 40.0, len(cell))
    middle = np.s_[153:157, 50:100]
    height = np.zeros(len(cell), np.int32)
    known, counted = (np.median(CellAverages.of(cell, value, height, shape, paint=paint).contrast[middle]) for paint in (3.0, np.inf))
    assert known > 0.8 * 60.0 and known > 1.15 * counted
