"""Python's filters of warnings belong to the whole process: no thread of ours changes them for a while."""

import warnings
from contextlib import contextmanager

import numpy as np
import pytest
import shapely
from lanewright.core.intensity.asphalt_model import _mixed
from lanewright.core.io.crs import parse_crs, same_crs
from lanewright.core.io.text_table import _parse
from lanewright.products.assess.layers import AssessedLayer, in_crs


@contextmanager
def filters_untouched():
    """While this lasts, nobody may change a filter (before and after it pytest does)."""
    def refuse(*_, **__):
        raise AssertionError("the filters of the whole process would be changed")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(warnings, "simplefilter", refuse)
        patch.setattr(warnings, "filterwarnings", refuse)
        yield


@pytest.mark.filterwarnings("error")
def test_a_table_with_words_among_its_numbers_is_read():
    with filters_untouched():
        values, dropped, _ = _parse(b"1 2 3\n4 none 6\n7 8 9\n1 2\n", " ", 3)
    np.testing.assert_array_equal(values, [[1, 2, 3], [4, np.nan, 6], [7, 8, 9]])
    assert dropped == 1


@pytest.mark.filterwarnings("error")
def test_a_table_of_numbers_is_read():
    with filters_untouched():
        values, *_ = _parse(b"1;2.5;-3e2\n;5;nan\n", ";", 3)
    np.testing.assert_array_equal(values, [[1, 2.5, -300], [np.nan, 5, np.nan]])


def test_two_spellings_of_one_crs_are_one_place():
    a = parse_crs("EPSG:32632")
    b = parse_crs(a.to_wkt("WKT1_ESRI").replace("WGS_1984_UTM_Zone_32N", "as the scanner has it"))
    with filters_untouched():
        assert same_crs(a, b) and not same_crs(a, parse_crs("EPSG:32633"))


def test_a_layer_is_brought_to_another_zone():
    layer = AssessedLayer("Lines", [shapely.LineString([(700_000, 5_400_000), (700_100, 5_400_000)])], [{}], parse_crs("EPSG:32632").to_wkt())
    with filters_untouched():
        moved = in_crs(layer, parse_crs("EPSG:32633").to_wkt(), print)
    assert abs(moved.geometries[0].length - 100) < 0.5


@pytest.mark.filterwarnings("error")
def test_a_bin_that_stands_out_from_those_around_it_is_found_beside_bins_that_nobody_saw():
    level, spread = np.full((2, 1, 40), np.nan)
    level[0, 20:30], level[0, 29] = 4000.0, 9000.0
    spread[0, 20:30], spread[0, 25] = 0.1, 1.0
    with filters_untouched():
        np.testing.assert_array_equal(np.flatnonzero(_mixed(level, spread)[0]), [25, 29])
