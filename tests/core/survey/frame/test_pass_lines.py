"""Where the vehicle drove, as lines."""

import numpy as np
import shapely
from drives import ahead, chain, drive
from lanewright.core.survey.frame.placement import passes_to_features
from lanewright.core.survey.frame.road_frame import build_frame


def test_every_pass_is_a_line_along_the_drive_in_its_direction():
    there = drive(chain(ahead(100.0)))
    frame = build_frame(there)
    layer = passes_to_features(frame, "")
    line, row = next(iter(layer))
    assert len(layer) == len(frame.passes) == 1 and row["direction"] == 1
    first, *_, last = shapely.get_coordinates(line, include_z=True)
    np.testing.assert_allclose(first, [there.x[0], there.y[0], there.z[0]], atol=1e-3)
    np.testing.assert_allclose(last, [there.x[-1], there.y[-1], there.z[-1]], atol=1e-3)
    assert row["length_m"] == line.length and np.isclose(line.length, 100.0, atol=0.5)
    # half a metre apart, however often the position was recorded
    assert len(shapely.get_coordinates(line)) < 205
    assert (row["begin_s"], row["finish_s"]) == (there.time[0], there.time[-1])
