"""A scanner that spins many unequal lasers over a street: asphalt is to be one brightness for all of them."""

import numpy as np
import pytest
from lanewright.core.intensity.beams import Beams
from lanewright.core.intensity.correction import correct_intensity
from lanewright.core.intensity.image import make_intensity_image
from lanewright.core.io.geotiff import IntensityImage
from lanewright.core.markings.objects.cluster import cluster_markings
from lanewright.core.markings.paint.extract import extract_markings
from spun_streets import BEAMS, spun

LENGTH = 30.0   # m


def hatching(x, y):
    """An island beside the lane: bars of 0.3 m across a strip, within a frame of lines of 0.15 m."""
    inside = (x > 20) & (x < 26) & (y > 2.5) & (y < 5.0)
    frame = (np.abs(y - 2.575) < 0.075) | (np.abs(y - 4.925) < 0.075)
    return inside & (frame | ((x + y) % 1.5 < 0.3))


def corrected(**street):
    """(frame, road points made alike, report)."""
    points, frame = spun(length=LENGTH, **street)
    return frame, *correct_intensity(points, frame)


@pytest.fixture(scope="module")
def plain():
    return corrected()


@pytest.fixture(scope="module")
def hatched():
    return corrected(paint=hatching)


def scatter(values):
    return np.std(values) / np.mean(values)


@pytest.mark.slow
@pytest.mark.parametrize("by_turn", [False, True])
def test_unequal_beams_are_told_apart_and_made_alike(plain, by_turn):
    _, alike, report = corrected(by_turn=True) if by_turn else plain
    found = alike.all_points()
    assert BEAMS <= report.beams <= BEAMS + 10 and "beams" in report.lines()[0]
    # the noise alone is 0.44 of what it was with unequal beams
    assert scatter(found.value) < 0.5 * scatter(found.intensity.astype(float))


@pytest.mark.slow
def test_paint_stays_brighter_than_asphalt_when_beams_are_made_alike(hatched):
    found = hatched[1].all_points()
    painted = hatching(found.x, found.y)
    assert np.median(found.value[painted]) - np.median(found.value[~painted]) == pytest.approx(25 * 256, rel=0.1)


def test_beams_that_are_alike_already_are_left_alone():
    points, frame = spun(unequal=False, length=LENGTH)
    assert Beams.of(points, frame, 1) is None


@pytest.mark.slow
def test_the_beams_do_not_depend_on_the_length_of_sections(plain):
    results = [found[1].all_points() for found in (plain, corrected(section_length=7.0))]
    by_place = [np.lexsort((p.y, p.x, p.time)) for p in results]
    np.testing.assert_array_equal(results[0].value[by_place[0]], results[1].value[by_place[1]])


def marked_on(street, folder):
    pytest.importorskip("osgeo.gdal")
    frame, alike, _ = street
    make_intensity_image(alike, path=folder / "image.tif").close()
    return extract_markings(alike, IntensityImage.open(folder / "image.tif"), frame)


@pytest.mark.slow
def test_grey_asphalt_under_unequal_beams_is_no_paint(tmp_path, plain):
    assert len(marked_on(plain, tmp_path)) < 20


@pytest.mark.slow
def test_a_hatched_island_under_unequal_beams_is_found(tmp_path, hatched):
    frame, alike, _ = hatched
    marked = marked_on(hatched, tmp_path)
    found, everything = marked.all_points(), alike.all_points()
    assert hatching(found.x, found.y).mean() > 0.8
    assert hatching(found.x, found.y).sum() > 0.6 * hatching(everything.x, everything.y).sum()
    markings, _ = cluster_markings(marked, frame)
    assert 3.0 < sum(g.area for g in markings.outlines.polygons()) < 8.0
