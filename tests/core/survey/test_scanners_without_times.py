"""Scanners of clouds whose points have no times."""

import numpy as np
from drives import ahead, bend, chain, drive, surveyed_points, write_cloud
from lanewright.core.survey.open_survey import open_survey


def test_without_times_sources_along_the_same_road_are_scanners_and_tiles_of_it_are_not(tmp_path):
    trajectory = drive(chain(ahead(80), bend(60, 60), ahead(60)))
    x, y, z, time = surveyed_points(trajectory)
    scanners, tiles = np.arange(len(x)) % 2 + 1, 1 + (time > np.median(time))
    for source, found in ((scanners, ("point_source_id", [1, 2])), (tiles, (None, [0]))):
        survey = open_survey([write_cloud(tmp_path / "timeless.laz", x, y, z, crs="EPSG:32632", source=source)], trajectory)
        assert not survey.has_time and (survey.scanner_field, survey.scanners) == found
