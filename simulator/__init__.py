"""A simulated survey with known truth, for the demo, the tests and for trying settings.

In: `SampleSettings`. Out: a `SampleSurvey` with points, trajectory and truth, and a UAV image with its control points.
"""
