"""What passes differ by goes with the layers of one step to the next."""

import numpy as np
import pytest
from lanewright.core.common.schemas import CURB_POINTS, MARKING_LINES
from lanewright.core.road.common.curb_points import curb_points_at, curb_points_to_features
from lanewright.core.survey.adjustment.pass_sigma import of_layer
from lined_streets import Street


def curb_layer(sigma):
    street = Street()
    street.frame.pass_sigma.update(sigma)
    s = np.arange(10.0, 60.0)
    points = curb_points_at(street.frame, 0, np.array([s, 3.5 + 0 * s, 0 * s]) + street.frame.origin[:, None], station=s, offset=3.5 + 0 * s,
                            status="measured", part="bottom", side="left", kind="main")
    return curb_points_to_features(points, street.frame)


@pytest.mark.parametrize("sigma", [{}, {0: 0.012}])
def test_curb_points_carry_it_where_it_is_known(sigma):
    assert of_layer(curb_layer(sigma)) == sigma


def test_layers_of_an_earlier_version_know_nothing_of_it():
    layer = curb_layer({0: 0.012})
    for row in layer.rows:
        del row["pass_sig_m"]
    assert of_layer(layer) == {}
    assert all(any(field.name == "pass_sig_m" and not field.needed for field in schema) for schema in (CURB_POINTS, MARKING_LINES))
