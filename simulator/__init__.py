"""A simulated survey with known truth, for the demo, the tests and for trying settings.

In: `SampleSettings`. Out: a `SampleSurvey` with points, trajectory and truth, and a UAV image with its control points.
"""

from ..core.lazy import public

__getattr__, __all__ = public(__name__, {
    "orthophoto": ("uav_control_points", "write_uav_image"),
    "survey": ("SampleSettings", "SampleSurvey", "make_sample_survey"),
})
