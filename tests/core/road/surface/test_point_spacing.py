"""Where the points are too few to say that there is no curb."""

import numpy as np
import pytest
from lanewright.core.road.surface.extract import Margins, ThinMargin, said_of_thin
from lanewright.core.road.surface.ground_grid import GroundCells
from lanewright.core.road.surface.pavement_edge import Carriageway

ROWS, COLUMNS = 200, 80    # 100 m of road, 10 m to either side


NO_CURBS = {"left": np.zeros(ROWS, bool), "right": np.zeros(ROWS, bool)}


def road(left, right, hidden=()):
    """A carriageway 8 m wide with `left` and `right` points per m² (numbers or one for each row); `hidden` rows show no ground on the left."""
    offsets = (np.arange(COLUMNS) - COLUMNS / 2 + 0.5) * 0.25
    density = np.where(offsets > 0, np.broadcast_to(left, ROWS)[:, None], np.broadcast_to(right, ROWS)[:, None])
    count = np.where(density * 0.125 >= 3, density * 0.125, 0).astype(np.float32)   # three points make ground
    ground = count > 0
    ground[np.ix_(list(hidden), np.flatnonzero(offsets > 2))] = False
    flat = np.zeros((ROWS, COLUMNS), np.float32)
    cells = GroundCells(40, -COLUMNS // 2, 0.5, 0.25, flat, flat, flat, flat, count)
    edge = np.full(ROWS, 4.0)
    return Carriageway(cells, flat, ground, -edge, edge, edge < 0, edge < 0, 0.05)


def thin_margins(number, carriageway, curbs, pavement=NO_CURBS):
    margins = Margins()
    margins.add(number, carriageway, curbs, pavement)
    return margins.unknown


def test_a_side_without_a_curb_and_with_few_points_is_told_with_its_place():
    margins = thin_margins(1, road(np.where(np.arange(ROWS) < 80, 200.0, 32.0), 200.0), NO_CURBS)
    assert margins == [ThinMargin(1, "left", 60.0, 120.0, pytest.approx(32.0))]
    said = said_of_thin(margins)
    assert "along 60 m" in said and "road 1, left side, station 60 to 120 m" in said and "32 per m²" in said and "18 cm apart" in said


def test_where_a_curb_was_found_or_points_are_enough_nothing_is_told():
    both = {side: np.ones(ROWS, bool) for side in NO_CURBS}
    assert thin_margins(0, road(32.0, 32.0), both) == [] and len(thin_margins(0, road(32.0, 32.0), {**both, "left": NO_CURBS["left"]})) == 1
    assert thin_margins(0, road(120.0, 300.0), NO_CURBS) == []
    assert said_of_thin([]) == "" and said_of_thin([ThinMargin(0, "left", 0.0, 10.0, 30.0)]) == ""


def test_where_curbs_could_be_seen_and_there_is_none_the_end_of_the_pavement_elsewhere_is_none():
    """A motorway: enough points beside the fast lane, few beyond the hard shoulder."""
    paved = {side: np.ones(ROWS, bool) for side in NO_CURBS}
    half = {**NO_CURBS, "right": np.arange(ROWS) < 100}
    assert thin_margins(0, road(200.0, 32.0), NO_CURBS, paved) == []
    # where no edge was drawn, where curbs were seen, and where nothing could be seen, a curb may be
    (part,) = thin_margins(0, road(200.0, 32.0), NO_CURBS, half)
    assert (part.start, part.end, part.pavement) == (70.0, 120.0, False)
    assert len(thin_margins(0, road(200.0, 32.0), {**NO_CURBS, "left": np.arange(ROWS) < 60}, paved)) == 1
    assert len(thin_margins(0, road(32.0, 32.0), NO_CURBS, paved)) == 2


def test_a_row_of_parked_cars_does_not_count_as_few_points():
    assert thin_margins(0, road(200.0, 200.0, hidden=range(40, 120)), NO_CURBS) == []


def test_many_places_are_counted_and_the_longest_named():
    margins = [ThinMargin(0, "right", 50.0 * k, 50.0 * k + 10.0 + k, 40.0) for k in range(8)]
    said = said_of_thin(margins)
    assert said.count("road 0, right") == 4 and "station 350 to 367 m" in said and "; …" in said and "along 108 m" in said
