"""Points that lie apart from the paint go, paint stays."""

import numpy as np
import pytest
from lanewright.core.errors import RoadExtractionError
from lanewright.core.markings import outliers
from lanewright.core.markings.crowds import may_be_lonely
from lanewright.core.markings.neighbours import mean_distances
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


def test_where_paint_crowds_the_same_points_go_as_when_every_point_is_asked(monkeypatch):
    records = paint(FRAME, [LINE, strip(20, 24, -1.0, 2.0)], density=4000)
    for k in range(40):
        records = with_stray(records, 6.0 + 1.3 * k, 1.25 + 0.01 * k)
    points, asked = road_points(records, FRAME), []
    of = outliers.Neighbours.of
    monkeypatch.setattr(outliers.Neighbours, "of", lambda self, rows: asked.append(len(rows)) or of(self, rows))
    few = remove_outliers(points)
    assert sum(asked) < len(records) / 2
    monkeypatch.setattr(outliers, "MOST", len(records))
    every = remove_outliers(points)
    assert_same_points(few.all_points().records, every.all_points().records)
    assert 30 < len(records) - len(every) < 200


@pytest.mark.parametrize("neighbours", [1, 20])
def test_no_point_beyond_the_limit_is_taken_for_one_among_many(neighbours):
    records = paint(FRAME, [LINE, strip(20, 60, 0.2, 0.25)], density=3000)
    units = np.c_[records["x"], records["y"], records["z"]]
    distances = mean_distances(units, neighbours)
    looked = np.arange(0, len(records), 7)
    limit = 2.5 * np.median(distances)
    found = may_be_lonely(records, neighbours, looked, distances[looked], limit, 0.0)
    assert set(np.flatnonzero(distances > limit)) <= set(found)
    assert len(found) < len(records) / 2


def test_a_handful_of_points_is_left_alone():
    records = paint(FRAME, [LINE])[:9]
    assert len(remove_outliers(road_points(records, FRAME))) == 9


@pytest.mark.parametrize("wrong", [dict(neighbours=0), dict(std_ratio=-1.0), dict(scope="sections")])
def test_settings_without_sense_are_refused(wrong):
    with pytest.raises(RoadExtractionError):
        OutlierSettings(**wrong)
