"""Where two roads cross, each has points of the paint: a figure is one marking, whichever road its points were given to."""

import numpy as np
import pytest
from clustered_marks import classes, layer_of
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.store.records import COORDINATE_SCALE, ROAD_POINT, to_units
from lanewright.core.survey.store.road_points import RoadPoints
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory
from painted_streets import EAST, NORTH, paint, strip


def crossing_drives():
    """One drive to the east, and another to the north that crosses it at its station 40."""
    s = np.arange(0.0, 80.0, 0.1)
    level = np.zeros(len(s))
    return build_frame(Trajectory(np.r_[s / 10, 60 + s / 10], EAST + np.r_[s, level + 40], NORTH + np.r_[level, s - 40], np.full(2 * len(s), 102.0)))


FRAME = crossing_drives()


def shared_out(records, of_second):
    """RoadPoints of both roads; some of the points of the first are given to the second."""
    points = RoadPoints(SectionStore(ROAD_POINT, 20.0), FRAME.origin)
    points.store.append(0, records[~of_second])
    given = records[of_second].copy()
    s, d = FRAME.road(1).locate(given["x"] * COORDINATE_SCALE, given["y"] * COORDINATE_SCALE)
    given["s"], given["d"] = to_units(s), to_units(d)
    points.store.append(1, given[np.argsort(s, kind="stable")])
    return points


BLOCKS = [strip(36.0, 36.5, d, d + 0.5) for d in np.arange(-3.0, 2.0)]


@pytest.mark.parametrize("share", ["each scan line in turn", "left and right of a line through blocks"])
def test_the_blocks_of_a_give_way_line_are_drawn_once_whichever_road_their_points_were_given_to(share):
    records = paint(FRAME, BLOCKS, density=2500)
    second = np.random.default_rng(3).random(len(records)) < 0.4 if share.startswith("each") else records["s"] * COORDINATE_SCALE > 36.3
    markings, clustered = layer_of(shared_out(records, second), FRAME)
    assert len(FRAME.roads) == 2
    assert classes(markings) == ["give_way"] * 5
    assert markings.column("area_m2") == pytest.approx([0.25] * 5, rel=0.2)
    found = [np.concatenate([clustered.section(road, k).records["cluster"] for k in clustered.sections(road)]) for road in (0, 1)]
    assert set(found[0]) == set(found[1]) == set(markings.column("cluster"))
