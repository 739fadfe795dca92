"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class _FrameWeights:
    """Which parts of a drive run on one road, and its reference line."""

    track_step: float = 2.0   # m between the positions that are compared
    same_carriageway: float = 12.0   # m: parallel tracks closer than this run on the same carriageway
    level_separation: float = 3.0   # m of height: tracks farther apart run on different levels of a ramp or bridge
    parallel_angle: float = np.radians(30.0)
    min_loop_length: float = 60.0   # m driven before coming near the own track again counts as a return
    min_pass_length: float = 10.0   # m: shorter pieces do not become a pass
    standstill_radius: float = 0.5   # m: position noise of a standing vehicle
    turn_angle: float = np.radians(75.0)   # from the heading at the apex: where a turn on the spot begins and ends
    turn_reach: float = 40.0   # m either side of the apex of a turn on the spot
    time_tick: float = 0.005   # s between the entries of the lookup tables by time
    max_ticks: int = 20_000_000   # entries of a lookup table at most
    line_smoothing: float = 2.0   # m, sigma: removes noise from the heading; offsets are measured from the smoothed line
    frame_extension: float = 10.0   # m beyond the driven part: scanners measure ahead and behind
    sparse_track_spacing: float = 2.0   # m between rows: beyond it, chords would cut the bends, so a spline is used
    junction_gap: float = 15.0   # m between the end of one pass and the start of the next that continues the road
    max_lateral_jump: float = 6.0   # m to the side: another lane of the same carriageway
    lane_blend_length: float = 40.0   # m over which a continuing pass in another lane is blended into the line
    max_lane_distance: float = 15.0   # m between two passes over one carriageway at most
    min_shared_length: float = 20.0   # m of road that two passes over it must share
    sigma_stretch: float = 10.0   # m of road of which the mean is kept, and the least that is told apart on a line
    sigma_cut_factor: float = 2.0   # times the uncertainty of the stretch beside it, and
    least_sigma_change: float = 0.010   # m more or less, that a stretch of a line is cut off for
    max_node_steps: int = 3   # from node to node, for the few points whose node is not found in one step from the node of the vehicle
    max_node_leap: float = 300.0   # nodes per step at most
    closed_form_bend: float = 0.55   # of the radius of a bend, to its inner side: validity of the closed form
    bend_stretch: tuple[float, float] = (0.4, 2.5)   # limits of the ratio of along-track distance to station difference in a bend
    points_per_projection: int = 100_000   # fewer points spend more time on Python's interpreter lock, many more on memory access
    clock_slack: float = 1.0   # s that a cloud may begin before or end after the trajectory


FRAME = _FrameWeights()
