"""What both methods of boundary detection use.

In: points of a `Survey` near the driven tracks. Out: decimated points, pseudo scan-lines, bottom corners of curbs, chains of them along
the road, and where the curb is occluded.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "CurbSteps": "corners",
    "LevelStrip": "level_strip",
    "OcclusionGrid": "occlusion",
    "OutermostTrack": "sides",
    "PointDecimation": "decimation",
    "PseudoScanLines": "pseudo_scanlines",
    "SIDE_SIGNS": "sides",
    "StepChain": "tracking",
    "assign_nearest_pass": "nearest_pass",
    "curb_chains": "tracking",
    "drop_short_curbs": "tracking",
    "expected_height": "sides",
    "link_steps": "tracking",
    "measure_corners": "corners",
    "pseudo_scan_lines": "pseudo_scanlines",
    "select_along_road": "tracking",
    "side_profiles": "sides",
})
