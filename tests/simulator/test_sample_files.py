"""The files of a made survey, and what makes none."""

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.simulator.survey import SampleSettings, make_sample_survey


def survey(**settings):
    """A thin survey of a street, quick to make: a tenth of the pulses of the demo's."""
    return make_sample_survey(SampleSettings(**{"pulse_rate": 60_000.0, "rotation_rate": 100.0, **settings}))


def test_the_file_holds_the_points_with_time_scanner_and_crs(tmp_path):
    laspy = pytest.importorskip("laspy")
    sample = survey(length=20.0)
    count = sample.write_cloud(tmp_path / "made.laz")
    cloud, points = laspy.read(tmp_path / "made.laz"), sample.points()
    assert len(cloud) == count == len(points)
    assert str(cloud.header.version) == "1.4" and cloud.header.point_format.id == 6
    assert cloud.header.global_encoding.wkt and cloud.header.parse_crs().to_epsg() == 32650
    assert cloud.header.global_encoding.gps_time_type == 1
    for axis in "xyz":
        np.testing.assert_allclose(getattr(cloud, axis), points[axis], atol=0.00051)
    np.testing.assert_array_equal(cloud.gps_time, points["time"])
    np.testing.assert_array_equal(cloud.point_source_id, points["scanner"])
    t = sample.trajectory.time
    assert t[0] <= cloud.gps_time.min() and cloud.gps_time.max() <= t[-1]


def test_a_folder_that_is_not_there_is_named_and_nothing_is_left(tmp_path):
    with pytest.raises(RoadExtractionError, match="nowhere"):
        survey(length=20.0).write_cloud(tmp_path / "nowhere" / "made.laz")
    assert list(tmp_path.iterdir()) == []


def test_cancelling_leaves_no_file(tmp_path):
    from lanewright.core.common.errors import Cancelled
    from lanewright.core.common.progress import Progress

    class Impatient(Progress):
        def report(self, fraction):
            if fraction > 0.2:
                raise Cancelled

    sample = survey(length=60.0, pulse_rate=200_000.0)
    with pytest.raises(Cancelled):
        sample.write_cloud(tmp_path / "made.laz", Impatient())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("setting, value, word", [
    ("scene", "harbour", "street, rural, urban"), ("length", 3.0, "from 20 to 20000 m"), ("seed", -1, "seed"),
    ("speed_kmh", float("nan"), "speed"), ("curb_height", 0.6, "curb height")])
def test_settings_that_make_no_street_are_refused_by_name(setting, value, word):
    with pytest.raises(RoadExtractionError, match=word):
        SampleSettings(**{setting: value})


def test_a_geographic_crs_is_refused():
    with pytest.raises(RoadExtractionError, match="geographic"):
        make_sample_survey(SampleSettings(crs="EPSG:4326"))
