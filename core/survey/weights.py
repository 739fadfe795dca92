"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class _FrameWeights:
    """Which parts of a drive run on one road, and its reference line."""

    track_step: float = 2.0   # m between the positions that are compared
    same_carriageway: float = 12.0   # m: parallel tracks closer than this run on the same carriageway
    level_separation: float = 3.0   # m of height: tracks farther apart run on different levels of a ramp or bridge
    parallel_angle: float = np.radians(30.0)   # between tracks that run along each other
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


@dataclass(frozen=True)
class _RegisterWeights:
    """Offsets between two passes over one road, and between two scanners."""

    correction_step: float = 10.0   # m of station between nodes
    min_coupled_offset: float = 0.02   # m along or across, less than which shifts the other by less than the noise of an offset
    much_larger: float = 2.0   # times: bars 27° off the road and more, moved across, look moved along by less
    strip_half_width: float = 12.0   # m either side of the reference line
    lag_cell: float = 0.02   # m: cell size along an offset, and across it
    row_cell: float = 0.25   # m: cell size along an offset, and across it
    max_offset: float = 0.30   # m between two passes
    max_rough_offset: float = 1.5   # m between two drives of different years or datums
    min_compared: float = 0.3   # of the windows that show an offset across, or the passes seem to lie farther apart
    rough_groups: int = 5   # groups along a road, and windows of each, that are searched then
    rough_group: int = 3   # groups along a road, and windows of each, that are searched then
    min_cell_height: float = -0.3   # m about the road's expected height: ground and curbs
    max_cell_height: float = 0.4   # m about the road's expected height: ground and curbs
    height_blur_cells: int = 3   # cells over which heights are averaged
    detrend_cells: int = 51   # cells: variations over more than a metre are neither curbs nor paint
    max_step: float = 0.05   # m of height, and standard deviations of intensity, at which cells are clipped
    max_contrast: float = 4.0   # m of height, and standard deviations of intensity, at which cells are clipped
    max_correlation: float = 0.999   # at which the correlation is clipped
    face_cells: int = 9   # cells along a row, and m between the highest and the lowest of them, that show a face such as a curb's
    face_height: float = 0.03   # cells along a row, and m between the highest and the lowest of them, that show a face such as a curb's
    flat_step: float = 0.01   # m: the height offset is measured on cells flatter than this
    min_shared_cells: int = 300   # cells that two passes must share in a window
    correlated_cells: float = 6.0   # neighbouring cells whose errors are correlated
    pooling_sigma: float = 15.0   # m of road, over which drift changes little
    max_offset_sigma: float = 0.006   # m: standard deviation of an accepted offset at most
    prior_offset_sigma: float = 0.10   # m: prior standard deviation of offsets; of two equally good ones the smaller is chosen
    min_likelihood_ratio: float = 25.0   # twice the log likelihood ratio of the best offset against none
    max_runner_up: float = 0.7   # of that ratio, for the second best offset
    parabola_cells: int = 2   # cells either side of the best, for the parabola
    peak_cells: int = 2   # cells beside the best that belong to its peak
    sigma_reach: float = 25.0   # m of road either way over which passes are compared: less would be the noise of single offsets


REGISTER = _RegisterWeights()


@dataclass(frozen=True)
class _AdjustWeights:
    """Corrections of passes from their offsets, and which of them are told."""

    agreement_plan: float = 0.020   # m: a road stays as measured if nine tenths of its offsets are less
    agreement_height: float = 0.007   # m: a road stays as measured if nine tenths of its offsets are less
    offset_sigma: float = 0.003   # m, sigma of a measured offset
    outlier_scale: float = 0.010   # m of residual at which the weight of an offset is one half (Cauchy weights)
    reweighting_rounds: int = 5   # iterations of robust weights
    drift_change_sigma: float = 0.010   # m, sigma of the drift from window to window
    drift_sigma: float = 0.20   # m, sigma of the drift itself
    max_seam: float = 1.0   # s between the end of a pass and the start of the next one of the same drive
    max_remaining: float = 0.02   # m in plan that two passes may still differ by: less than a marking's edge is blurred by
    max_change: float = 0.04   # m to the next window that a correction changes by: navigation drifts more slowly, so a pass jumped somewhere between
    most_named: int = 12   # places that a message names
    farthest_beside: float = 30.0   # m between the tracks of two carriageways
    least_parallel: float = np.cos(np.radians(15))   # cosine of the angle between them, at least
    shortest_beside: float = 50.0   # m beside each other, shorter than which it is a junction
    share_along: float = 0.8   # of the shorter of two roads, that they run along each other
    even_rise: float = 0.15   # m by which one may vary in height above the other: navigation drifts by less, ramps climb by more
    share_between: tuple[float, float] = 0.25, 0.75   # of the way from one track to the other: what both drives see well
    height_cell: float = 0.25   # m, of the cells that heights are compared in
    flat_cell_range: float = 0.03   # m between the highest and the lowest point of a flat cell
    min_flat_cells: int = 40   # flat cells that both drives see, for a difference
    max_height_apart: float = 0.02   # m in height that two drives may differ by without a warning
    least_told_move: float = 0.005   # m; less is not named in the warning


ADJUST = _AdjustWeights()


@dataclass(frozen=True)
class _LatticeWeights:
    """The scan lines of a scanner, and the turns of its mirror."""

    rotation_samples: int = 6   # places along a pass at which the frequency is sought
    rotation_sample_pieces: int = 6   # in which these are read
    rotation_sample_length: float = 30.0   # m of road about each: scan lines are oblique, and cover little of a short piece of road
    min_window_points: int = 200   # points of a scanner in a window
    min_distinct_times: float = 0.7   # share of the points; if more share their times, the times do not give the order on the line
    max_point_step: float = 0.5   # m across, median between successive points of a line
    same_place_step: float = 0.1   # m across, median of successive points that lie on one line, in whatever order
    min_one_way_share: float = 0.75   # of the steps from point to point that go the same way across
    median_time_stride: int = 15   # every n-th point is enough for the median time of a sample
    turns_per_bin: int = 10   # turns whose points give one phase
    phase_stretch: float = 20.0   # m of road processed at a time
    max_points_per_turn: int = 40   # that are used for the phase; more do not improve it
    min_axis_height: float = 1.5   # m above the road: seen from lower, the angles of road points hardly change
    line_sectors: int = 36   # of a turn, in each of which lines are counted
    max_mounting_points: int = 10_000   # points of a window that are used for the mounting of a scanner
    mounting_directions: int = 360   # about the trajectory, for which the mounting of a scanner is estimated
    min_phase_bin_points: int = 8   # points of a bin, or it gives no phase
    min_phase_bin_share: float = 0.3   # of the median number of points: bins that are cut off have a biased phase
    min_phase_coherence: float = 0.3   # length of the mean phasor of a bin
    nodes_per_bin: int = 5   # of the smooth curve through the phases of the bins
    max_phase_bin_gap: float = 1.5   # bins between two phases; farther apart, the phase in between is extrapolated from the rate before
    min_rotation: float = 5.0   # Hz
    max_rotation: float = 400.0   # Hz
    rotation_window: float = 0.5   # s of scanning whose points are compared
    rotation_tolerance: float = 0.02   # share of a frequency within which it may vary
    min_direction_ratio: float = 1.5   # of the peak against that of the opposite rotation
    min_rotation_peak: float = 0.5


LATTICE = _LatticeWeights()


@dataclass(frozen=True)
class _StoreWeights:
    """Points by section: how many are kept in memory, and worked on at a time."""

    rows_overhead: int = 8   # reading some rows of a column costs as much as the inverse of this share of the whole column, plus the rows
    section_length: float = 5.0   # m of station; results do not depend on it
    memory_limit: int = 64 * 2**20   # bytes of records in memory before they are spilled
    cache_limit: int = 64 * 2**20   # bytes of spilled sections cached as last read: neighbouring windows ask for them again
    strips_per_section: int = 16   # points wait strip by strip until a section is sorted, so that points sorted together lie together in memory
    section_locks: int = 16   # locks that the sections share while they are read
    sort_chunk: int = 1 << 15   # points sorted at a time: they fit the processor's cache
    station_cell_bits: int = 7   # bits of the number of a cell of stations; points are sorted into cells first (fewer than a byte holds)
    packing_chunk: int = 1 << 15   # values packed at a time: they fit the processor's cache
    open_parts: int = 64   # files of parts that are held open: a system lets a program open some hundred (macOS 256)
    max_free_ranges: int = 64   # free ranges of the file that are remembered; of more, the smallest is forgotten
    subset_memory_limit: int = 16 * 2**20   # bytes of masks, and as many of additional columns, in memory


STORE = _StoreWeights()
