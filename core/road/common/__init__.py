"""What both methods of boundary detection use.

In: points of a `Survey` near the driven tracks. Out: decimated points, pseudo scan-lines, bottom corners of curbs, chains of them along
the road, and where the curb is occluded.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "corners": ("CurbSteps", "measure_corners"),
    "curb_points": ("CurbPoints", "curb_points_at"),
    "decimation": ("LevelGround", "LevelStrip", "PointDecimation"),
    "occlusion": ("OcclusionGrid",),
    "pseudo_scanlines": ("PseudoScanLines", "pseudo_scan_lines"),
    "sides": ("OutermostTrack", "SIDE_SIGNS", "expected_height", "side_profiles"),
    "tracking": ("StepChain", "curb_chains", "drop_short_curbs", "link_steps", "select_along_road"),
})
