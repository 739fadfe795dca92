"""A drive whose points are given to two offices in two stretches that share 90 m: with the whole trajectory for both their maps agree there."""

import laspy
import numpy as np
import pytest
import shapely
from lanewright.core.pipeline import road_map as chain

LENGTH, SHARED = 130.0, (20.0, 110.0)   # m of road
FROM_CUT = 20.0                         # m from the end of either's points: what is measured and averaged there lacks the other side


@pytest.fixture(scope="module")
def jobs(made_survey, tmp_path_factory):
    """(whole trajectory, points of the first stretch, points of the second)."""
    made, path = made_survey(length=LENGTH, pulse_rate=60_000.0)
    drive = made.trajectory
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(drive.x), np.diff(drive.y)))]
    first, last = np.interp(SHARED, driven, drive.time)
    cloud, folder = laspy.read(path), tmp_path_factory.mktemp("jobs")
    for name, own in (("first", cloud.gps_time <= last), ("second", cloud.gps_time >= first)):
        part = laspy.LasData(cloud.header)
        part.points = cloud.points[own]
        part.write(folder / f"{name}.las")
    return drive, folder / "first.las", folder / "second.las"


def apart(ours, theirs, drive):
    """(N,) m from places every half metre along either's lines, in the middle of what both share, to the other's."""
    track, found = shapely.LineString(np.c_[drive.x, drive.y]), []
    for some, others in ((ours, theirs), (theirs, ours)):
        places = shapely.points(np.concatenate([shapely.get_coordinates(shapely.segmentize(line, 0.5)) for line in some]))
        station = shapely.line_locate_point(track, places)
        places = places[(station > SHARED[0] + FROM_CUT) & (station < SHARED[1] - FROM_CUT)]
        tree = shapely.STRtree(others)
        near = tree.query_nearest(places, all_matches=False)
        found.append(shapely.distance(places[near[0]], tree.geometries[near[1]]))
    return np.concatenate(found)


def lines_of(features):
    return [shapely.LineString(np.asarray(geometry.coords)) for geometry, _ in features]


@pytest.fixture(scope="module")
def mapped(jobs, tmp_path_factory):
    """Both road maps, and the curb points of both with the frames they were found in."""
    drive, *clouds = jobs
    find, found, folder = chain.find_curb_points, [], tmp_path_factory.mktemp("maps")

    def noted(survey, *arguments, **options):
        found.append((survey.frame, find(survey, *arguments, **options)))
        return found[-1][1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chain, "find_curb_points", noted)
        maps = [chain.make_road_map([cloud], drive, folder / f"{k}.tif") for k, cloud in enumerate(clouds)]
    for made in maps:
        made.road_points.close()
    return maps, found


@pytest.mark.slow
def test_both_offices_find_the_same_curb_points_by_profiles(mapped):
    found = []
    for frame, by_method in mapped[1]:
        points = by_method["profiles"]
        middle = (points.station > SHARED[0] + FROM_CUT) & (points.station < SHARED[1] - FROM_CUT) & (points.kind == "main")
        measured = middle & (points.status == "measured")
        # each counts from an origin of its own
        places = np.c_[points.x[measured] + frame.origin[0], points.y[measured] + frame.origin[1], points.height[measured]]
        found.append(places[np.lexsort(places.T)])
    assert len(found[0]) > 30
    np.testing.assert_allclose(*found, atol=1e-6)


@pytest.mark.slow
def test_most_places_of_both_maps_lie_within_a_centimetre(jobs, mapped):
    maps, drive = mapped[0], jobs[0]
    for layer, share in (("edges", 0.95), ("marking_lines", 0.85)):
        distance = apart(*(lines_of(made.layer(layer)) for made in maps), drive)
        assert len(distance) > 300 and np.median(distance) < 0.003 and np.quantile(distance, share) < 0.010, layer
