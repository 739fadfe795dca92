"""Normalized scanlines as a layer and as evenly spaced points: nothing is lost on the way but what was to be."""

import laspy
import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import Features
from lanewright.core.road.scanlines.grid import Scanlines
from lanewright.core.road.scanlines.section_planes import ScanlineSettings, all_scanlines
from lanewright.products.scanline_layer import (
    LineSpool,
    ResampledPoints,
    ScanlineLayerSettings,
    coordinates_of,
    line_lengths,
    resample_scanlines,
    scanlines_from_features,
    simplified_lines,
    write_scanlines,
)
from scanned_streets import CURB, scanned, survey_of


@pytest.fixture(scope="module")
def survey():
    return survey_of(scanned())


def as_features(spool):
    features = Features(spool.geometry_type, spool.schema, crs=spool.crs)
    for wkb, row in spool:
        features.add(wkb, **row)
    return features


def profile(d, z):
    """One scanline through places across the road."""
    return Scanlines(np.array([10.0]), np.array([0]), np.array([0]), np.array([0, len(d)]), np.asarray(d, float), np.asarray(z, float),
                     np.arange(len(d), dtype=np.float32))


def test_what_a_layer_says_is_what_was_cut(survey):
    settings = ScanlineSettings(interval=0.5)
    cut = Scanlines.join(all_scanlines(survey, 0, settings))
    spool, count = write_scanlines(survey, settings, ScanlineLayerSettings(simplify=0.0))
    assert count == len(cut)
    found, interval = scanlines_from_features(as_features(spool), survey.frame)
    long = cut[line_lengths(cut) >= 0.10]
    assert interval == 0.5 and list(found) == [0] and len(found[0]) == len(long)
    np.testing.assert_array_equal(found[0].first, long.first)
    np.testing.assert_allclose(found[0].station, long.station, atol=1e-4)
    for name, within in (("d", 2e-4), ("z", 1e-6), ("intensity", 0.0)):
        np.testing.assert_allclose(getattr(found[0], name), getattr(long, name), atol=within)
    np.testing.assert_array_equal(found[0].scanner, long.scanner)


def test_a_thinned_scanline_lies_within_its_deviation():
    d = np.linspace(-5.0, 5.0, 1001)
    z = np.where(np.abs(d) > 3.5, CURB, 0.0) + 0.001 * np.sin(40 * d)
    lines = profile(d, z)
    fewer = simplified_lines(lines, 0.002)
    assert len(fewer.d) < 30
    assert fewer.d[0] == -5.0 and fewer.d[-1] == 5.0
    upright = np.abs(np.abs(d) - 3.5) < 0.02
    np.testing.assert_allclose(np.interp(d, fewer.d, fewer.z)[~upright], z[~upright], atol=0.0021)
    # every vertex that is left is one that was there, with its own intensity
    np.testing.assert_array_equal(lines.d[fewer.intensity.astype(int)], fewer.d)


def test_points_along_a_scanline_are_evenly_spaced_around_corners_too():
    line, d, z, intensity = resample_scanlines(profile([-2.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.5, 0.5]), 0.25)
    assert (line == 0).all() and len(d) == 15
    np.testing.assert_allclose(np.hypot(np.diff(d), np.diff(z)), 0.25)
    np.testing.assert_allclose(intensity[[0, 4, 8, 10, 14]], [0.0, 0.5, 1.0, 2.0, 3.0])


def test_resampled_points_lie_on_the_street_at_every_plane(survey, tmp_path):
    path = tmp_path / "even.laz"
    with ResampledPoints(path, survey.frame.origin, "", ScanlineLayerSettings(spacing=0.10)) as points:
        write_scanlines(survey, ScanlineSettings(interval=0.05), None, points)
    cloud = laspy.read(path)
    assert len(cloud.points) == points.count
    y, z = np.asarray(cloud.y) - 2000.0, np.asarray(cloud.z) - 100.0
    away = np.abs(np.abs(y) - 3.5) > 0.15
    np.testing.assert_allclose(z[away], np.where(np.abs(y[away]) > 3.5, CURB, 0.0), atol=5e-4)
    stations = np.rint(np.asarray(cloud["station_m"]) / 0.05).astype(int)
    # lines were scanned 0.10 m apart: half of the planes had none of their own
    near = (np.abs(y) < 5.0) & (stations > 400) & (stations < 800)
    counts = np.bincount(stations[near])[401:800]
    assert counts.min() > 95 and counts.max() < 110


def test_a_failed_run_leaves_no_points(survey, tmp_path):
    with pytest.raises(ZeroDivisionError):
        with ResampledPoints(tmp_path / "even.laz", survey.frame.origin, "") as points:
            write_scanlines(survey, ScanlineSettings(interval=1.0), None, points)
            raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


def test_scanlines_of_another_trajectory_are_refused(survey):
    spool, _ = write_scanlines(survey, ScanlineSettings(interval=2.0), ScanlineLayerSettings())
    features = as_features(spool)
    features.rows = [dict(row, station_m=row["station_m"] + 5.0) for row in features.rows]
    with pytest.raises(RoadExtractionError, match="same trajectory"):
        scanlines_from_features(features, survey.frame)


def test_an_empty_layer_is_refused(survey):
    with pytest.raises(RoadExtractionError, match="empty"):
        scanlines_from_features(Features("LineStringZM", []), survey.frame)


def test_lines_come_back_from_a_spool_as_they_went_in():
    rng = np.random.default_rng(3)
    spool = LineSpool("LineStringZM", [])
    lines = [rng.normal(size=(n, 4)) for n in (2, 5, 3)]
    spool.add(np.concatenate(lines[:2]), np.array([0, 2, 7]), road=1, station_m=np.array([0.5, 1.0]))
    spool.add(lines[2], np.array([0, 3]), road=2, station_m=np.array([1.5]))
    found = list(spool)
    assert len(spool) == len(found) == 3
    assert [row for _, row in found] == [dict(road=1, station_m=0.5), dict(road=1, station_m=1.0), dict(road=2, station_m=1.5)]
    for (wkb, _), line in zip(found, lines):
        np.testing.assert_array_equal(coordinates_of(wkb), line)
