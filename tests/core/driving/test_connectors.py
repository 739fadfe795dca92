"""Where the vehicle turned from one road into another, a connector leads from lane to lane."""

import numpy as np
import pytest
from drives import ahead, bend, chain, drive, joined
from lanewright.core.common.features import MARKING_LINES, Features
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.survey.frame.road_frame import build_frame
from shapely.geometry import LineString

RADIUS = 12.0
WEST = 100.0    # m of the street before the turn


@pytest.fixture(scope="module")
def turned():
    """A street of 220 m driven straight on, then again as far as 100 m and left into a side street: both have two lanes of 3.5 m."""
    frame = build_frame(joined(drive(chain(ahead(220.0))), drive(chain(ahead(WEST), bend(RADIUS, 90.0), ahead(100.0)), start=5000.0)))
    assert [(p.road, p.direction) for p in frame.passes] == [(0, 1), (0, 1), (1, 1)]
    lines = Features("LineStringZ", MARKING_LINES)
    main = [(np.arange(a, b, 0.25), offset) for a, b in ((5.0, 92.0), (130.0, 215.0)) for offset in (5.25, 1.75, -1.75)]
    side = [(np.arange(30.0, 105.0, 0.25), offset) for offset in (5.25, 1.75, -1.75)]
    for k, (s, offset) in enumerate(main + side):
        x, y = frame.to_map(0, s, offset) if k < len(main) else (500_000.0 + WEST + RADIUS - offset + 0 * s, 5_400_000.0 + s)
        kind, pattern = ("lane", "dashed") if offset == 1.75 else ("edge", "solid")
        places = np.c_[x, y, np.full(len(s), 100.0)]
        lines.add(LineString(places), road=int(k >= len(main)), kind=kind, pattern=pattern, status="measured", line=k + 1)
    return make_driving_lines(PaintedLines.from_features(lines, frame), frame)[2]


def row_of(lanes, name):
    return lanes.lane_id.tolist().index(name)


def turning(lanes):
    """Rows of the connectors that lead to another road."""
    return [k for k in range(len(lanes)) if lanes.type[k] == "connector"
            and any(lanes.road[row_of(lanes, name)] != lanes.road[k] for name in lanes.successors[k])]


def test_a_left_turn_leads_from_the_lane_that_was_left_to_the_lane_that_was_entered(turned):
    k, = turning(turned)
    entered, = (row_of(turned, name) for name in turned.successors[k])
    left, = (row for row in range(len(turned)) if turned.lane_id[k] in turned.successors[row])
    assert (turned.road[left], turned.road[entered]) == (0, 1) and turned.type[left] == turned.type[entered] == "driving"
    for side in (0, 1):
        border = turned.borders(k)[side]
        np.testing.assert_allclose(border[0, :2], turned.borders(left)[side][-1, :2], atol=0.1)
        np.testing.assert_allclose(border[-1, :2], turned.borders(entered)[side][0, :2], atol=0.1)


def test_a_turn_is_inferred_as_wide_as_its_lanes_and_as_long_as_the_drive(turned):
    k, = turning(turned)
    assert turned.status[k] == "inferred" and turned.confidence[k] <= 0.5
    assert turned.width[k] == pytest.approx(3.5, abs=0.1)
    # from 92 m on the street, round the bend, to 30 m up the side street
    assert turned.length[k] == pytest.approx(WEST - 92.0 + RADIUS * np.pi / 2 + 30.0 - RADIUS, abs=1.5)


def test_the_drive_straight_on_has_a_connector_of_its_own(turned):
    straight = [k for k in range(len(turned)) if turned.type[k] == "connector" and k not in turning(turned)]
    assert len(straight) == 1 and turned.road[straight[0]] == 0
    assert len(set(turned.lane_id)) == len(turned)
