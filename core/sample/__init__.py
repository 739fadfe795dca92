"""A simulated survey with known truth, for the demo, the tests and for trying settings.

In: `SampleSettings`. Out: a `SampleSurvey` with points, trajectory and truth, and a UAV image with its control points.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "SampleSettings": "survey",
    "SampleSurvey": "survey",
    "make_sample_survey": "survey",
    "uav_control_points": "orthophoto",
    "write_uav_image": "orthophoto",
})
