"""The middles of exported lanes are the driving lines, as far as the tolerance allows."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.features import DRIVING_LINES, Features
from lanewright.products.export.opendrive.exporter import OpenDriveSettings, draft_opendrive
from lanewright.products.export.opendrive.xodr import layers_of_opendrive, opendrive_text, read_opendrive
from lanewright.products.export.shared_borders import with_driven_middles, with_shared_borders
from lanewright.products.export.sources import RoadMapSource, border_misses, checked, driving_line_misses
from made_lanes import double_line, street
from map_files import written


def driven(lanes, aside):
    """Driving lines `aside` metres left of the middles of lanes, as (lane,) numbers."""
    layer = Features("LineStringZ", DRIVING_LINES, crs=lanes.crs)
    for k in range(len(lanes)):
        left, right = lanes.borders(k)
        across = (left - right) / np.linalg.norm(left - right, axis=1)[:, None]
        layer.add(shapely.linestrings((left + right) / 2 + aside[k] * across), road=1, lane=int(lanes.lane[k]), status="measured")
    return layer


@pytest.mark.parametrize("aside", [(0.008, 0.0), (0.008, -0.008), (0.005, 0.005)])
def test_driving_lines_beside_the_middle_come_out_in_the_middle(tmp_path, aside):
    lanes = street(((60.0, 0.0, 0.0), (60.0, 1 / 90, 1 / 90)))
    source = checked(RoadMapSource(lanes, driven(lanes, aside)))
    draft = draft_opendrive(source, OpenDriveSettings(tolerance=0.02))
    draft.map.reference = "EPSG:25832"
    shown = layers_of_opendrive(read_opendrive(written(tmp_path, opendrive_text(draft.map))), lanes.crs).lanes
    assert border_misses(lanes, shown)[0].largest <= 0.02
    before, after = (driving_line_misses(source.driving_lines, one).largest for one in (lanes, with_driven_middles(source, 0.01).lanes))
    assert before == pytest.approx(max(map(abs, aside)), abs=1e-4) and after < 0.0005
    assert driving_line_misses(source.driving_lines, shown).p95 < 0.006


def test_no_border_moves_by_more_than_the_limit_and_neighbours_keep_their_border():
    lanes = street()
    moved = with_driven_middles(RoadMapSource(lanes, driven(lanes, (0.1, -0.1))), 0.01).lanes
    for name in ("left", "right"):
        assert np.linalg.norm(getattr(moved, name) - getattr(lanes, name), axis=1).max() <= 0.01 + 1e-9
    (own, _), (other, _) = moved.borders(0), moved.borders(1)
    assert own == pytest.approx(other[::-1])


def test_without_driving_lines_lanes_stay_as_they_are():
    lanes = street()
    assert with_driven_middles(RoadMapSource(lanes), 0.01).lanes is lanes


def test_beside_a_double_line_the_driving_line_is_held_against_the_lane_between_its_own_stripes():
    lanes = double_line()
    layer = driven(lanes, np.zeros(len(lanes)))
    source = with_shared_borders(checked(RoadMapSource(lanes, layer)))
    assert with_driven_middles(source, 0.01).lanes.left == pytest.approx(source.lanes.left, abs=1e-6)
    whole, apart = (driving_line_misses(layer, source.lanes, apart_from=places) for places in (None, source.led_to_middles()))
    assert whole.largest > 0.05 and 0 <= apart.places < whole.places and not apart.largest > 0.001
