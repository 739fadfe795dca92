"""Where the points are too few to say that there is no curb."""

import numpy as np
import pytest
from lanewright.core.road.surface.extract import ThinMargin, said_of_thin, thin_margins
from lanewright.core.road.surface.ground_grid import GroundCells, is_thin
from lanewright.core.road.surface.pavement_edge import Carriageway

ROWS, COLUMNS = 200, 80    # 100 m of road, 10 m to either side


def road(left, right, hidden=(), edges=""):
    """A carriageway 8 m wide with `left` and `right` points per m² (numbers or one for each row); `hidden` rows show no ground on the left.

    edges : sides that have one
    """
    offsets = (np.arange(COLUMNS) - COLUMNS / 2 + 0.5) * 0.25
    density = np.where(offsets > 0, np.broadcast_to(left, ROWS)[:, None], np.broadcast_to(right, ROWS)[:, None])
    count = np.where(density * 0.125 >= 3, density * 0.125, 0).astype(np.float32)   # three points make ground
    ground = count > 0
    ground[np.ix_(list(hidden), np.flatnonzero(offsets > 2))] = False
    flat = np.zeros((ROWS, COLUMNS), np.float32)
    cells = GroundCells(40, -COLUMNS // 2, 0.5, 0.25, flat, flat, flat, flat, count, flat)
    edge = np.full(ROWS, 4.0)
    return Carriageway(cells, flat, ground, -edge, edge, *(np.full(ROWS, side in edges) for side in ("right", "left")), 0.05)


def test_a_side_without_an_edge_and_with_few_points_is_told_with_its_place():
    margins = thin_margins(1, road(np.where(np.arange(ROWS) < 80, 200.0, 32.0), 200.0))
    assert margins == [ThinMargin(1, "left", 60.0, 120.0, pytest.approx(32.0))]
    said = said_of_thin(margins)
    assert "along 60 m" in said and "road 1, left side, station 60 to 120 m" in said and "32 per m²" in said and "18 cm apart" in said


def test_where_an_edge_was_drawn_or_points_are_enough_nothing_is_told():
    assert thin_margins(0, road(32.0, 32.0, edges="left and right")) == [] and len(thin_margins(0, road(32.0, 32.0, edges="right"))) == 1
    assert thin_margins(0, road(120.0, 300.0)) == []
    assert said_of_thin([]) == "" and said_of_thin([ThinMargin(0, "left", 0.0, 10.0, 30.0)]) == ""


def test_a_row_of_parked_cars_does_not_count_as_few_points():
    assert thin_margins(0, road(200.0, 200.0, hidden=range(40, 120))) == []


def test_many_places_are_counted_and_the_longest_named():
    margins = [ThinMargin(0, "right", 50.0 * k, 50.0 * k + 10.0 + k, 40.0) for k in range(8)]
    said = said_of_thin(margins)
    assert said.count("road 0, right") == 4 and "station 350 to 367 m" in said and "; …" in said and "along 108 m" in said


def test_a_cloud_is_thin_where_the_ground_beside_the_track_holds_few_points_too():
    """Cells of 1 m by 0.1 m, 10 m across: 10 points each are 100 per m², and beside the track there are four times as many."""
    everywhere = np.full((20, 100), 10)
    beside_track = np.where(np.abs(np.arange(100) - 50) < 15, 40, everywhere)
    assert is_thin(everywhere, 1.0, 0.1, 320.0) and not is_thin(beside_track, 1.0, 0.1, 320.0)
    # the end of the road is in sight of the last place of the drive
    beside_track[5:] = 0
    assert not is_thin(beside_track, 1.0, 0.1, 320.0) and is_thin(np.zeros((20, 100)), 1.0, 0.1, 320.0)
