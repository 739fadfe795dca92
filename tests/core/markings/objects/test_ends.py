"""Where a line ends between two scan lines: half a gap beyond the last that met it, on average."""

import numpy as np
import pytest
from clustered_marks import FRAME, layer_of
from painted_streets import paint, road_points, strip


@pytest.mark.parametrize("pitch", [0.05, 0.2, 0.4])
def test_ends_of_lines_are_unbiased_however_far_apart_scan_lines_lie(pitch):
    off = []
    for k in range(8):
        start, end = 10.0 + 0.137 * k, 25.0 + 0.091 * k
        records = paint(FRAME, [strip(start, end, 1.0, 1.15)], density=5000)
        records = records[(records["s"] * 1e-4) % pitch < 0.01]
        markings, _ = layer_of(road_points(records, FRAME), FRAME)
        x = np.array(markings.geometries[0].exterior.coords)[:, 0] - FRAME.origin[0]
        off += [start - x.min(), x.max() - end]
    assert abs(np.mean(off)) < 0.1 * pitch + 0.01 and np.max(off) < pitch / 2 + 0.03
