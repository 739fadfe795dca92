"""Normalized scanlines of streets of known section."""

import numpy as np
import pytest
from scanned_streets import CURB, SECTION, START, driven, scanned, survey_of

from lanewright.core.road.scanlines import Scanlines
from lanewright.core.road.section_planes import ScanlineSettings, all_scanlines, scanlines_of
from lanewright.core.survey.scan_lattice import find_lattice


def street_height(d):
    """Height of the street's section above the road."""
    return np.where(np.abs(d) > 3.5, CURB, 0.0)


def on_street(survey, road=0, **settings):
    return Scanlines.join(all_scanlines(survey, road, ScanlineSettings(**settings)))


def heights(survey, lines):
    """Heights of vertices above the road."""
    return lines.z + survey.frame.origin[2] - 100.0


@pytest.mark.parametrize("case", [dict(), dict(yaw=0.0), dict(yaw=-45.0, rotation=-100.0), dict(wander=0.01, rounded=1e-6)],
                         ids=["yawed", "straight across", "the other way", "wandering"])
def test_scanlines_lie_on_the_street(case):
    survey = survey_of(scanned(**case))
    lines = on_street(survey)
    d, h = lines.d, heights(survey, lines)
    # between the last point of a face and the first above it lies a straight piece, as long as points are apart
    off_face = np.abs(np.abs(d) - 3.5) > 0.10
    np.testing.assert_allclose(h[off_face], street_height(d[off_face]), atol=2e-4)
    assert ((h > -2e-4) & (h < CURB + 2e-4)).all()
    stations = np.unique(np.rint(lines.station / 0.10).astype(int))
    middle = stations[(stations > 150) & (stations < 450)]
    np.testing.assert_array_equal(middle, np.arange(151, 450))


def test_a_scanline_crosses_the_whole_street_in_one_piece():
    survey = survey_of(scanned())
    lines = scanlines_of(survey, 0, 30.0, 32.0)
    assert len(lines) == 20
    np.testing.assert_allclose(lines.station, np.arange(300, 320) * 0.10)
    for first, last in zip(lines.first[:-1], lines.first[1:]):
        assert lines.d[first] < -7.0 and lines.d[last - 1] > 7.0
        assert (np.diff(lines.d[first:last]) >= 0).all()


def test_intensity_is_carried_along():
    survey = survey_of(scanned())
    lines = scanlines_of(survey, 0, 30.0, 32.0)
    np.testing.assert_allclose(lines.intensity, 3000 + 100 * lines.d, atol=2.0)
