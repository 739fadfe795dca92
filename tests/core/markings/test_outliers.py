"""Points that lie apart from the paint go, paint stays."""

import tracemalloc

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.markings.outliers import OutlierSettings, remove_outliers
from painted_streets import assert_same_points, drive, paint, road_points, shuffled, strip
from scipy.spatial.distance import cdist

FRAME = drive()
LINE = strip(5, 60, 1.0, 1.15)


def with_stray(records, s, d):
    """The same points and a lone one."""
    stray = records[:1].copy()
    stray["s"], stray["d"] = round(s * 1e4), round(d * 1e4)
    x, y = FRAME.road(0).to_map(s, d)
    stray["x"], stray["y"] = round(float(x) * 1e4), round(float(y) * 1e4)
    return np.concatenate([records, stray])


@pytest.mark.parametrize("scope", ["all", "windows"])
def test_a_lone_point_beside_a_line_goes_and_the_line_stays(scope):
    line = paint(FRAME, [LINE])
    kept = remove_outliers(road_points(with_stray(line, 30.0, 1.6), FRAME), OutlierSettings(scope=scope))
    assert kept.all_points().d.max() < 1.2
    assert len(kept) > 0.8 * len(line)


def test_over_everything_the_limit_is_the_one_pcl_defines():
    records = paint(FRAME, [LINE], density=200)
    kept = remove_outliers(road_points(records, FRAME), OutlierSettings(neighbours=12, std_ratio=0.7, scope="all"))
    places = np.c_[records["x"], records["y"], records["z"]] * 1e-4
    distances = np.sort(cdist(places, places), axis=1)[:, 1:13].mean(axis=1)
    limit = distances.mean() + 0.7 * distances.std(ddof=1)
    expected = np.sort(records["s"][distances <= limit])
    np.testing.assert_array_equal(np.sort(kept.all_points().records["s"]), expected)


def test_far_and_worn_paint_is_spared_by_windows_and_eaten_over_everything():
    near, far = paint(FRAME, [LINE], density=3000), paint(FRAME, [strip(5, 60, -5.15, -5.0)], density=150, seed=2)
    points = road_points(np.concatenate([near, far]), FRAME)

    def far_left(scope):
        return np.count_nonzero(remove_outliers(points, OutlierSettings(scope=scope)).all_points().d < 0) / len(far)

    assert far_left("windows") > 0.98
    assert far_left("all") < 0.5


def test_neither_the_order_of_points_nor_the_length_of_sections_matters():
    records = with_stray(paint(FRAME, [LINE], density=400), 33.0, 0.4)
    plain = remove_outliers(road_points(records, FRAME)).all_points().records
    other = remove_outliers(road_points(shuffled(records), FRAME, section_length=7.0)).all_points().records
    assert_same_points(plain, other)


def rounded(records, step):
    """The same points on a grid of so many metres."""
    result, step = records.copy(), round(step * 1e4)
    for name in "xyzsd":
        result[name] = (records[name] + step // 2) // step * step
    return result[np.argsort(result["s"], kind="stable")]


def repeated(records, times):
    """Each point so many times at its place, one after the other, as where the vehicle stood."""
    result = np.repeat(records, times)
    result["time"] += 1e-3 * np.arange(len(result))
    return result


def every_second_repeated(records, times):
    """Not the last one, which is the lone point where there is one."""
    return repeated(records, np.where(np.arange(len(records))[::-1] % 2, times, 1))


EXPORTS = {
    "a grid of 1 cm": lambda records: rounded(records, 0.01),
    "a grid of 10 cm": lambda records: rounded(records, 0.1),
    "every point 25 times": lambda records: repeated(records, 25),
    "every second point 22 times on a grid of 1 cm": lambda records: rounded(every_second_repeated(records, 22), 0.01),
}


def mean_distances_of_all(records, k):
    """(N,) metres, from the distances of every point to every other."""
    places = np.c_[records["x"], records["y"], records["z"]] * 1e-4
    return np.concatenate([np.sort(cdist(some, places), axis=1)[:, 1:k + 1].mean(axis=1)
                           for some in np.array_split(places, len(places) // 500 + 1)])


@pytest.mark.parametrize("export", EXPORTS)
def test_of_rounded_and_repeated_points_those_go_that_pcl_removes(export):
    records = EXPORTS[export](with_stray(paint(FRAME, [strip(5, 15, 1.0, 1.15)], density=150), 8.0, 1.6))
    distances = mean_distances_of_all(records, 20)
    kept = remove_outliers(road_points(records, FRAME), OutlierSettings(scope="all"))
    expected = records[distances <= distances.mean() + distances.std(ddof=1)]
    for name in "sd":
        np.testing.assert_array_equal(np.sort(kept.all_points().records[name]), np.sort(expected[name]))
    # only where all points have as many others at their place as are asked for, none lies apart
    assert len(expected) < len(records) or export == "every point 25 times"


@pytest.mark.parametrize("export", EXPORTS)
@pytest.mark.parametrize("scope", ["all", "windows"])
def test_memory_does_not_depend_on_how_points_are_rounded_or_repeated(export, scope):
    records = EXPORTS[export](paint(FRAME, [LINE, strip(5, 60, -2.6, -2.45)], density=1500))
    points = road_points(records, FRAME)
    tracemalloc.start()
    try:
        remove_outliers(points, OutlierSettings(scope=scope))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 30e6 + 10 * records.nbytes


@pytest.mark.parametrize("export", EXPORTS)
def test_a_lone_point_goes_however_points_are_rounded_or_repeated_and_25_at_one_place_are_not_alone(export):
    records = EXPORTS[export](with_stray(paint(FRAME, [LINE, strip(5, 60, -2.6, -2.45)], density=1500), 33.0, 0.4))
    kept = remove_outliers(road_points(records, FRAME)).all_points()
    assert (abs(kept.d - 0.4) < 0.01).any() == (export == "every point 25 times")
    assert len(kept) > 0.95 * len(records)


def test_a_handful_of_points_is_left_alone():
    records = paint(FRAME, [LINE])[:9]
    assert len(remove_outliers(road_points(records, FRAME))) == 9


@pytest.mark.parametrize("wrong", [dict(neighbours=0), dict(std_ratio=-1.0), dict(scope="sections")])
def test_settings_without_sense_are_refused(wrong):
    with pytest.raises(RoadExtractionError):
        OutlierSettings(**wrong)
