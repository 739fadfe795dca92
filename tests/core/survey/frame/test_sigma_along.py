"""Where one number no longer tells how uncertain a line is."""

import numpy as np
import pytest
from lanewright.core.survey.frame.row_table import cuts_where_it_changes

ALONG = np.arange(0.0, 400.5, 0.5)


def test_a_stretch_amid_a_line_is_told_apart():
    worse = (ALONG > 150.0) & (ALONG < 200.0)
    cuts = cuts_where_it_changes(ALONG, np.where(worse, 0.04, 0.004))
    np.testing.assert_allclose(ALONG[cuts], [150.0, 200.0], atol=5.0)


def test_what_rises_evenly_from_little_to_much_is_cut_in_the_rise():
    cuts = cuts_where_it_changes(ALONG, np.interp(ALONG, [180.0, 230.0], [0.0, 0.057]))
    assert len(cuts) in (1, 2) and ALONG[cuts].min() > 180.0 and ALONG[cuts].max() < 220.0


@pytest.mark.parametrize("sigma", [np.full(len(ALONG), 0.05), np.where(ALONG < 200.0, 0.001, 0.009), np.where(ALONG < 200.0, 0.04, 0.06),
                                   np.where(np.abs(ALONG - 200.0) < 2.0, 0.03, 0.004)],
                         ids=["everywhere alike", "by millimetres", "less than twice", "a few metres"])
def test_what_changes_little_or_briefly_is_not_cut(sigma):
    assert not len(cuts_where_it_changes(ALONG, sigma))


def test_a_line_too_short_to_be_told_apart_is_one():
    assert not len(cuts_where_it_changes(ALONG[:30], np.where(ALONG[:30] < 7.0, 0.001, 0.1)))
    assert not len(cuts_where_it_changes(np.empty(0), np.empty(0)))
