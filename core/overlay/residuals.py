"""The residuals of control and check points as vectors on the map."""

import numpy as np

from ..features import Features
from ..schemas import RESIDUALS
from .control_points import CONTROL


def residual_vectors(found):
    """A vector for each point, in its true length: from where the polynomial puts it to where it was measured.

    Parameters
    ----------
    found : Georeferencing
    """
    from shapely import LineString

    points, errors = found.points, found.errors
    leverage = np.full(len(points), np.nan)
    leverage[points.having(CONTROL)] = found.fit.leverage
    layer = Features("LineStringZ", RESIDUALS, crs=points.crs)
    heights = np.nan_to_num(points.height)
    for k in range(len(points)):
        end = np.array([points.easting[k], points.northing[k]])
        start = end - errors[k]
        layer.add(LineString([(*start, heights[k]), (*end, heights[k])]), point=points.names[k], role=str(points.roles[k]),
                  pixel=float(points.pixel[k]), line=float(points.line[k]), dx_m=float(errors[k, 0]), dy_m=float(errors[k, 1]),
                  resid_m=float(np.hypot(*errors[k])), loo_m=float(np.hypot(*found.left_out[k])), leverage=float(leverage[k]))
    return layer
