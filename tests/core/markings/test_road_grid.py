"""Points of a few metres of road keep their cells in the grid of a whole window."""

import numpy as np
from lanewright.core.markings.road_grid import CELL_UNITS, PieceOfRoad, RoadGrid, cell_numbers
from lanewright.core.survey.store.records import ROAD_POINT, Points


def test_a_point_has_the_same_cell_in_a_piece_of_the_road_and_in_a_wider_and_longer_window():
    rng = np.random.default_rng(2)
    records = np.zeros(4000, ROAD_POINT)
    records["s"] = np.sort(rng.integers(-250 * CELL_UNITS, -125 * CELL_UNITS, len(records)))
    records["d"] = rng.integers(-90 * CELL_UNITS, 40 * CELL_UNITS, len(records))
    piece, window = PieceOfRoad.of(Points(records), -250, -125), RoadGrid(-600, 100, -120, 300)
    np.testing.assert_array_equal(piece.numbers_in(window, piece.cell), cell_numbers(records, window))
