"""The formulas behind every figure, held against published tables."""

import numpy as np
import pytest
from lanewright.products.assess.matching import Errors, Rates, f1_of

# Published recall, precision and F1, per cent, of the driving-line thesis (tables 4.13 and 4.14)
THESIS = [
    (90.06, 92.53, 91.28), (93.73, 95.04, 94.38), (90.42, 93.05, 91.72), (88.02, 89.59, 88.80), (92.71, 94.97, 93.83),
    (72.95, 90.89, 80.94), (74.95, 92.02, 82.61), (82.84, 90.95, 86.71), (81.83, 90.47, 85.93), (76.27, 91.88, 83.35),
    (85.34, 91.17, 88.16),
]
# Precision, recall and F of the scanline paper (table 3)
SCANLINES = [(93.71, 95.37, 94.53), (93.62, 94.96, 94.29), (92.45, 96.50, 94.43), (92.41, 92.80, 92.60), (93.01, 94.89, 93.94)]


@pytest.mark.parametrize("recall, precision, f1", [*THESIS, *((r, p, f) for p, r, f in SCANLINES)])
def test_the_published_tables_obey_the_usual_f1(recall, precision, f1):
    assert f1_of(precision, recall) == pytest.approx(f1, abs=0.011)


@pytest.mark.parametrize("recall, precision, f1", THESIS)
def test_the_formulas_as_printed_do_not_give_the_thesis_s_own_tables(recall, precision, f1):
    """Counts with the published recall and precision: printed precision is tp / (tp + fn), printed F1 2 tp / (fp + fn) + 1."""
    right = 1e6
    false, missed = right * (100 / precision - 1), right * (100 / recall - 1)
    rates = Rates(right, false, missed)
    assert 100 * rates.precision == pytest.approx(precision) and 100 * rates.recall == pytest.approx(recall)
    assert 100 * rates.f1 == pytest.approx(f1, abs=0.011)
    assert abs(100 * right / (right + missed) - precision) > 1.0
    assert 2 * right / (false + missed) + 1 > 1.0


def test_seven_right_two_false_one_missed():
    rates = Rates(7, 2, 1)
    assert rates.precision == 7 / 9 and rates.recall == 7 / 8
    assert rates.f1 == pytest.approx(14 / 17) and rates.iou == pytest.approx(0.7)


def test_without_a_result_nothing_is_right_and_precision_is_unknown():
    rates = Rates(0, 0, 5)
    assert rates.recall == 0 and rates.f1 == 0 and rates.iou == 0 and np.isnan(rates.precision)


def test_where_there_is_nothing_at_all_there_is_no_rate():
    assert np.isnan(Rates(0, 0, 0).f1)


def test_errors_keep_sign_in_the_mean_and_size_in_the_rest():
    errors = Errors.of([0.01, -0.03, np.nan])
    assert errors.count == 2 and errors.mean == pytest.approx(-0.01)
    assert errors.rmse == pytest.approx(np.sqrt(5e-4)) and errors.maximum == pytest.approx(0.03)
    assert Errors.of([]).count == 0 and np.isnan(Errors.of([]).rmse)


def test_longer_pieces_weigh_more():
    assert Errors.of([0.0, 0.1], [9.0, 1.0]).mean == pytest.approx(0.01)
