"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

import numpy as np

from ..common.setting import table


@table
class FRAME:
    """Which parts of a drive run on one road, and its reference line."""

    track_step: float = 2.0   # m between the positions that are compared
    same_carriageway: float = 12.0   # m: parallel tracks closer than this run on the same carriageway
    level_separation: float = 3.0   # m of height: tracks farther apart run on different levels of a ramp or bridge
    parallel_angle: float = np.radians(30.0)   # between tracks that run along each other
    min_loop_length: float = 60.0   # m driven before coming near the own track again counts as a return
    min_pass_length: float = 10.0   # m: shorter pieces do not become a pass
    standstill_radius: float = 0.5   # m: position noise of a standing vehicle
    turn_reach: float = 40.0   # m either side of the apex of a turn on the spot
    time_tick: float = 0.005   # s between the entries of the lookup tables by time
    max_ticks: int = 20_000_000   # entries of a lookup table at most
    line_smoothing: float = 2.0   # m, sigma: removes noise from the heading; offsets are measured from the smoothed line
    frame_extension: float = 10.0   # m beyond the driven part: scanners measure ahead and behind
    sparse_track_spacing: float = 2.0   # m between rows: beyond it, chords would cut the bends, so a spline is used
    junction_gap: float = 15.0   # m between the end of one pass and the start of the next that continues the road
    max_lateral_jump: float = 6.0   # m to the side: another lane of the same carriageway
    lane_blend_length: float = 40.0   # m over which a pass in another lane is blended into the line, and into the height of the road
    least_share: float = 0.01   # m of these that a pass counts for at its very end
    max_lane_distance: float = 15.0   # m between two passes over one carriageway at most
    min_shared_length: float = 20.0   # m of road that two passes over it must share
    sigma_stretch: float = 10.0   # m of road of which the mean is kept, and the least that is distinguished on a line
    sigma_cut_factor: float = 2.0   # times the uncertainty of the stretch beside it, and
    least_sigma_change: float = 0.010   # m more or less, that a stretch of a line is cut off for
    max_node_steps: int = 3   # from node to node, for the few points whose node is not found in one step from the node of the vehicle
    least_leap: float = 10.0   # m of station between neighbouring positions on one road, from which on they are on two parts of it
    max_node_leap: float = 300.0   # nodes per step at most
    closed_form_bend: float = 0.55   # of the radius of a bend, to its inner side: validity of the closed form
    bend_stretch: tuple[float, float] = (0.4, 2.5)   # limits of the ratio of along-track distance to station difference in a bend
    points_per_projection: int = 100_000   # fewer points spend more time on Python's interpreter lock, many more on memory access
    clock_slack: float = 1.0   # s that a cloud may begin before or end after the trajectory
    station_tolerance: float = 1.0   # m: far more than rounding, far less than the shift of another drive
    offset_tolerance: float = 1.0   # m: more than passes are moved by onto each other, less than a trajectory to its scanners (half a vehicle)
    reach_of_roads: float = 200.0   # m from the roads: the widest corridor and an arm of a side street beyond it
    nodes_apart: int = 50   # nodes, 5 m each, between those that features are compared with first
    corridor: float = 25.0   # m either side of the reference line


@table
class REGISTER:
    """Offsets between two passes over one road, and between two scanners."""

    correction_step: float = 10.0   # m of station between nodes
    min_coupled_offset: float = 0.02   # m along or across, less than which shifts the other by less than the noise of an offset
    much_larger: float = 2.0   # times: bars 27° off the road and more, moved across, look moved along by less
    strip_half_width: float = 12.0   # m either side of the reference line
    lag_cell: float = 0.02   # m: cell size along an offset, and across it
    row_cell: float = 0.25   # m: cell size along an offset, and across it
    max_offset: float = 0.30   # m between two passes
    most_drift: float = 0.15   # m that navigation drifts from one drive to the next; more is another datum or another adjustment
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
    rebuilt_heights: tuple[float, float] = 0.05, 0.20   # m by which ground lies higher where a street was rebuilt, as curbs do and cars do not
    rebuilt_share: float = 0.75   # of a window's length, along which it does: two cars in a row are shorter
    least_rebuilt: float = 0.10   # m across of such ground: less is the curb itself, blurred
    sigma_reach: float = 25.0   # m of road either way over which passes are compared: less would be the noise of single offsets


@table
class ADJUST:
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
    max_height_apart: float = 0.02   # m in height that two drives may differ by without a warning
    least_told_move: float = 0.005   # m; less is not named in the warning


@table
class LATTICE:
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
    stretches_together: int = 8   # of these in a task at most
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
    min_rotation_peak: float = 0.5   # of the spectrum at the rotation: 1 of points that all lie on scan lines, near 0 of shuffled times


@table
class STORE:
    """Points by section: how many are mapped and worked on at a time."""

    section_length: float = 5.0   # m of station; results do not depend on it
    read_beyond: float = 40.0   # m of road on either side of a stretch, beyond which its works read no points
    mapped_bytes: int = 64 * 2**20   # bytes of files mapped into a process before it lets go of their pages: neighbouring windows ask for them again
    strips_per_section: int = 16   # points wait strip by strip until a section is sorted, so that points sorted together lie together in memory
    section_locks: int = 16   # locks that the sections share while they are read
    sort_chunk: int = 1 << 15   # points sorted at a time: they fit the processor's cache
    station_cell_bits: int = 7   # bits of the number of a cell of stations; points are sorted into cells first (fewer than a byte holds)
    open_files: int = 64   # finished files that are held open: a system lets a program open some hundred (macOS 256)


@table
class LAS:
    """Reading LAS and LAZ files."""

    points_looked_at: int = 1000   # points by which it shows whether records are points, and where points lie
    max_chunk_size: int = 50_000_000   # points; LASzip writes 50,000
    max_decoded: int = 400_000   # points of a last chunk that is decoded to count them: larger ones take too much memory
    flushed_bytes: int = 16   # at most that a coder writes behind its last point: points that need fewer bytes are not all there are
    max_blocks_per_chunk: int = 4   # larger chunks are not decoded as a whole: the points are read one block after the other
    most_layouts: int = 1024   # files whose header and chunks are remembered
    sampled_places: int = 5   # places in a file at which points are looked at
    points_per_sample: int = 1000   # points looked at in each of these places
    points_per_block: int = 400_000   # points decoded at a time
    points_per_range: int = 50_000   # points of which it is noted where they lie: those that LASzip compresses together
    remembered_points: int = 6_000_000   # points of the places looked at last, 14 bytes each: of some hundred metres of a road
    remembered_surveys: int = 8   # surveys of which it is remembered where their points lie
    max_header_scale: float = 1e3   # m per stored integer: a coarser scale describes no place on earth
    max_header_offset: float = 1e12   # m: a larger offset describes no place on earth
    farthest_place: float = 1e8   # m or feet from any origin: no place of a map lies farther
    bounds_tolerance: float = 0.01   # m: bounds are often rounded to centimetres
    coarse_coordinates: float = 0.02   # m: coordinates in coarser steps scatter by half a centimetre, which curbs and lines need
    values_for_step: int = 1000   # values of a file from which the step of its coordinates is told, and whether its times change
    gaps_for_step: int = 10   # between different values of a coordinate: fewer may be chance
    share_of_other_gaps: float = 0.01   # of the gaps between different values may be less than the step, as where other points were added
    slot: float = 0.001   # s: some hundred pulses, a part of a mirror's turn
    places_per_metre: float = 1000.0   # places are compared in millimetres: a copy may store them with other scales and offsets
    max_scanners: int = 8   # scanners of a vehicle; a field with four times as many values does not distinguish them
    min_interleaved_share: float = 0.8   # of the points: values of a field tell scanners where so many points have values that overlap in time
    empty_middle: float = 0.001   # share of values in the middle half of 16 bits, at most, where a sign was lost
    least_upper_share: float = 0.01   # share of values in the uppermost quarter, at least, where a sign was lost
    usual_spread: float = 20.0   # dB between dark asphalt and paint or signs, at one range and another
    max_spread: float = 60.0   # dB that no survey exceeds
    brightest: int = 30_000   # intensity that the brightest points get
    brightest_step: float = 5.0   # dB to which the brightest points are rounded, so that samples agree
    least_doubled: float = 0.02   # share of the points that share their time with one other, at least, where files were exported twice
    most_of_pairs: float = 0.5   # of these pairs, that lie apart alike
    sensor_bits: tuple[int, ...] = (8, 10, 11, 12)   # of intensities as sensors give them
    other_scale: float = 6.0   # times the usual intensity of another file: asphalt, grass and trees near the vehicle differ by less
    near_drive: float = 6.0   # m from the drive: up to there ranges and angles differ so little that the intensities of two files can be compared
    least_compared: int = 100   # intensities of a file that are compared with those of another
    same_scale: float = 3.0   # times, that files with one scale may differ by
    farthest_height: float = 2e4   # m above or below the frame's origin: points beyond are outliers, and would overflow the integers of a record


@table
class READING:
    """Reading a survey: which points are kept, how much at a time, and when clock and height of the trajectory are doubted."""

    kept_above_road: float = 3.5   # m: vehicles that hide a curb stand above the road
    kept_below_road: float = 4.0   # m: ditches lie below the road
    # m stored beyond these limits: the height of the road is rough while reading and exact when points are returned, so that the points
    # returned do not depend on the order of the files
    height_margin: float = 1.5
    height_cell_bits: int = 12   # of a station in units of 0.1 mm: the height of the road is looked up every 0.41 m
    level_height: float = 1.0   # m above or below the road beside the vehicle, and
    level_distance: float = 50.0   # m from the vehicle within which ground beyond the corridor is kept: that of side streets
    own_track_half_width: float = 1.5   # m either side of the own track: road, not sidewalk
    default_sensor_height: float = 2.6   # m, used where too few points lie on the track
    min_track_points: int = 50   # points on the track, of which an estimate needs more
    height_resolution: float = 0.001   # m: resolution of the histogram
    height_range: float = 20.0   # m either side of the first estimate covered by the histogram
    height_peak_bin: float = 0.1   # m: bin width in which the road makes the peak
    coverage_cell_bits: int = 15   # of a station in units of 0.1 mm: whether a road was measured under the vehicle is asked every 3.3 m
    coverage_step: float = 0.1   # m of depth below the trajectory in which points are counted there,
    coverage_bins: int = 80   # and how many of these: points beyond are counted as one
    least_near_share: float = 0.1   # of the points there that are beyond: under a bridge or in a tunnel the road is as well seen
    other_level: float = 0.3   # m that the road lies higher or lower than elsewhere below the trajectory: twice what a suspension gives way
    least_moved: float = 10.0   # m of such a road: longer than a car that stands behind
    least_hole: float = 5.0   # m without a point under the vehicle: longer than a puddle
    told_stretches: int = 4   # stretches that a warning names
    brightness_cell_bits: int = 16   # of a station in units of 0.1 mm: the brightness of the road is compared over cells of 6.6 m,
    brightness_steps: int = 4   # in steps of an octave, so many
    least_brightness_step: float = 0.68   # octaves, a factor of 1.6, by which two files' asphalt differs: tyres and patches differ by less
    track_cell_bits: int = 8   # of a station in units of 0.1 mm: a track is looked up every 26 mm
    least_road_share: float = 0.2   # of the points on the track lie on the road, though a ceiling is above, and fewer are strays below it
    height_peak_reach: float = 0.5   # m either side of the peak that belong to the road
    max_waiting_points: int = 4_000_000   # points held back at most until the height of the road is known
    height_samples: int = 5_000   # points on the own track from which the rough height is estimated
    max_split_samples: int = 1_500_000   # points sampled, by which two scanners are distinguished
    part_points: int = 1_200_000   # points of a part, about: a second or two of a worker's time, some 20 MB of its file
    road_height_step: float = 0.25   # m between the stations at which points are compared with the height of the road
    read_progress: float = 0.7   # share of the work, where the passes are adjusted afterwards
    section_points: int = 250_000   # points of a section, about
    longer_sections: tuple[float, float] = 10.0, 25.0   # m that a section may be long beside the usual length
    parts_progress: float = 0.85   # share of reading, where the points are put in order afterwards
    much_excluded: float = 0.25   # of the points: noise and what a second drive shows again are less
    highest_sensor: float = 5.0   # m above the road: vehicles are up to 4 m high (Directive 96/53/EC), and a mast on a roof adds some
    clock_track_half_width: float = 2.0   # m either side of the own track where clocks are compared
    max_look_ahead: float = 6.5   # m along the road: every scanner measures road nearer than this in each rotation
    nearest_percentile: int = 10   # percentile of the distances that must be less than max_look_ahead
    clock_sections: int = 20   # sections sampled, evenly over the survey
    clock_points_per_section: int = 5000   # points of each of them
    min_clock_points: int = 500   # sampled points that a judgement needs
    rail_cell: float = 0.05   # m across the own track, of which heights are compared
    least_rail_points: int = 5   # points of such a cell, of which it needs more
    least_rail_height: float = 0.08   # m above what lies between: rails stand 0.13 to 0.17 m high on their sleepers
    widest_rail: float = 0.21   # m, with sleepers' plates: curbs and kerbed tracks are wider
    gauges: tuple[float, float] = 0.95, 1.80   # m from rail to rail
    rail_verge: float = 2.0   # m from the ends of sleepers, 1.3 m from the middle, to the edge of the formation, 3.3 m: anything there may be drawn
    max_correction: float = 10.0   # m: no pass is moved farther when passes are adjusted


@table
class TRAJECTORY:
    """Reading a trajectory and cleaning it."""

    most_at_once: float = 50.0   # m driven between positions of one time: a second of a fast drive
    max_header_lines: int = 15   # lines above a table in which the names of its columns are looked for
    longest_name: int = 40   # characters of a name in a message
    most_names: int = 25   # names listed in a message
    highest_road: float = 9000.0   # m: a third coordinate beyond it is no height
    largest_seconds: float = 1e10   # s: larger times are counted in smaller units
    least_even: float = 0.95   # share of the steps of a column that may be time that are near the usual one
    first_gps_seconds: float = 0.6e9   # s since 1980 (1999), the earliest survey
    last_gps_seconds: float = 1.7e9   # s since 1980 (2033), the latest survey
    slowest_drive: float = 0.07   # m/s: a survey whose fastest seconds are slower counts its time in thousandths
    max_roll_radians: float = 0.15   # radians: vehicles roll by more than 3 degrees somewhere, but never by 0.2 radians
    worst_accuracy: float = 100.0   # m: a position that is known worse than this is none, and the file another one
    least_named: int = 2   # roles that the line of names must hold
    checked_rows: int = 200   # rows by which it is told whether a column takes several fields
    head_bytes: int = 20_000   # bytes in which it shows that a file is a log of a receiver
    texts_looked_at: int = 50   # texts of a column by which it is told what they are
    most_of_texts: float = 0.9   # share of these that must agree
    shortest_step: float = 5e-4   # s from row to row; no trajectory has 2000 positions a second, and a vehicle drives a centimetre in it
    time_tolerance: float = 1.0   # s between the ends of the times of cloud and trajectory, which may be rounded
    max_vehicle_speed: float = 70.0   # m/s of a survey vehicle
    min_position_jump: float = 2.0   # m: shorter steps are not outliers, whatever their speed
    longest_step: float = 100_000.0   # m between positions without time: far beyond what is left out of a drive, and within a zone of a projection
    most_outliers: tuple[int, float] = 10, 0.02   # rows, and of all rows: more are no outliers but another drive at the same time
    min_origin_distance: float = 1000.0   # m: a drive whose positions are all farther from the origin of the coordinates does not pass through it
    heading_step: float = 10.0   # m ahead of a position, reprojected with it for the heading
    gap_factor: float = 3.0   # times the usual step of time beyond which the vehicle is not interpolated, if it is longer than
    shortest_pause: float = 1.0   # s
    max_sagitta: float = 0.05   # m; bends are curved that straight lines between vertices miss by more
    noise_time: float = 1.0   # s over which a cubic tells the noise
    smooth_time: float = 2.0   # s over which a cubic removes the noise
    even_steps: float = 0.2   # share by which steps of time may differ
    least_jump: float = 0.05   # m across from one row to the next that no vehicle moves,
    jump_acceleration: float = 50.0   # m/s², if it takes more than that: no vehicle reaches it, wheels in potholes do
    jump_noise: float = 5.0   # times the noise of the positions
    vehicle_jerk: float = 10.0   # m/s³, as of somebody who brakes or steers hard
    max_sample_rows: int = 20_000   # rows from which the columns are recognised
    max_lean: float = 20.0   # degrees: no vehicle on a road rolls or pitches by more
    least_swing: float = 0.05   # of the rows on either side of zero
    min_map_coordinate: float = 9000.0   # m: x and y of map coordinates are larger, heights are smaller
    metres_per_degree: float = 111_000.0   # m per degree of latitude, rounded, for speeds and courses
    heading_tolerance: float = 10.0   # degrees of the median between the heading and the course driven
    min_course_step: float = 1.0   # m of driving between two courses: the positions of a standing vehicle scatter in all directions
    max_course_rows: int = 5000   # courses of a drive that are compared


@table
class TRACK:
    """The first track of a trajectory from the cloud alone, and the ridge of density of a cloud without times."""

    max_samples: int = 6_000_000   # points held in memory: 250 MB while they are sorted
    max_gap_in_drive: float = 1.0   # s without points end a drive
    min_drive_samples: int = 2000   # points: a drive with fewer is not estimated
    min_drive_time: float = 1.0   # s: points at one wrong time, however many, are no drive
    min_rounded_share: float = 0.99   # of the times are multiples of what they are rounded to
    rounded_tolerance: float = 0.25   # share of the rounding that the precision of large times may leave
    max_rounding_samples: int = 100_000   # times by which it shows to what they are rounded
    window: float = 0.1   # s: the vehicle gets a few metres, every mirror turns once at least
    min_window_samples: int = 30   # points that a window needs
    max_window_samples: int = 1000   # points used of a window
    min_step: float = 0.02   # m in a window: below, the direction is noise and the vehicle stands
    backing_step: float = 2.0   # m: no vehicle turns about within that
    density_width: float = 2.6   # m: the half width of the density under a scanner at its usual height
    ground_weight_depth: float = 0.4   # m either side of the ground: points there weigh at least a half
    lowest_share: float = 0.25   # share of a window's points that lie below the ground as first guessed
    most_even_share: float = 0.75   # of the density of a track, two half widths beside it: under a mirror it is 0.2, under the heads of many beams
    # of two real surveys 0.5 and 0.6, and of even points 1
    most_second_share: float = 0.45   # the same at the second densest of four places, two and four half widths to either side: where tracks of two
    # drives lie 5 to 7 m apart it is 0.2 to 0.3, of surveys thinned to 30 cm 0.6 to 0.9
    density_rounds: int = 15   # rounds of reweighting
    stiffness: float = 300.0   # (0.5 m of scatter / 0.03 m by which a braking vehicle's place differs from even motion in a window)^2
    cell: float = 0.5   # m, side of a cell of the density
    low_cell: float = 2.0   # m, side of a cell in which the low points are ground
    low_share: float = 0.2   # share of a cell's points below its ground: those that wet roads mirror lie there
    ground_layer: float = 0.3   # m either side of the ground
    blur: float = 1.0   # m of the density
    crest_window: float = 12.0   # m in which the densest cell stands for the crest
    min_crest_share: float = 0.05   # of the crest's density: cells over which a way may lead
    min_density_share: float = 0.15   # of the density that nine cells in ten do not reach: beyond the road there is no crest
    dense_share: float = 0.9   # quantile of the density for min_density_share
    end_crest_share: float = 0.7   # of the crest's density, where a way may begin and end
    crest_cost: int = 3   # power by which leaving the crest costs
    min_ridge: float = 20.0   # m: a shorter ridge is no drive
    usual_height: float = 2.3   # m of scanners above the road, where the points do not tell it
    ridge_spacing: float = 0.5   # m between the places given
    ridge_stiffness: float = 200.0   # of the curve along the ridge, as stiffness at ridge_spacing
    max_cells: int = 4_000_000   # cells of the density: 1 km^2


@table
class MIRROR:
    """Scanners with a mirror: places in short windows, first poses, and scanners distinguished by their scan lines."""

    knot_spacing: float = 0.1   # s between the knots of the splines: suspensions swing at 1 to 3 Hz
    rotation_samples_per_drive: int = 8   # windows in which the rate is sought
    min_spectrum_samples: int = 200   # points that a window needs for it
    near_foot: float = 8.0   # m from the track, within which ground points show the direction of the scan lines
    ground_band: float = 0.4   # m either side of the ground
    heights: tuple[float, float] = 0.6, 15.0   # m of a scanner on a vehicle above the ground; of clouds in feet that do not say so, too
    min_share_in_front: float = 0.95   # of the points lie before the scanner, not behind it
    max_worse: float = 4.0   # times the median misfit: windows beyond are not used
    max_window_points: int = 400   # points used of a window
    resection_rounds: int = 3   # rounds of reweighting
    min_fixes: int = 5   # windows with a place that a scanner needs, or it is left out
    fix_stiffness: float = 10.0   # (0.1 m of scatter / 0.03 m, see TRACK.stiffness)^2
    # from a mirror that turns evenly for seconds to one whose rate swings from window to window
    phase_stiffnesses: tuple[float, ...] = 1e8, 1e6, 1e4, 1e2, 0.1
    max_worse_phases: float = 1.5   # times the median deviation of the most flexible curve: a stiffer one deviates no more than this
    followers: int = 8   # points after a point to which its line may lead: those of another scanner may come in between
    nearest_step: float = 0.02   # m between two points of a line: nearer, noise turns the direction
    farthest_step: float = 1.5   # m between two points of a line: farther, it is another line
    directions: int = 90   # directions of half a turn, in which steps are counted
    blurred: int = 2   # directions either side that are counted together
    # (share of the steps of the most frequent direction that another one needs, times what is usual of a direction): as many, or few but clear
    clear_directions: tuple[tuple[float, float], ...] = (0.3, 3.0), (0.05, 10.0)
    min_apart: int = 10   # directions between two: 20 degrees
    max_directions: int = 4   # scanners of a vehicle
    min_steps: int = 2000   # steps that a judgement needs
    direction_tolerance: int = 4   # directions off its own that a step may lead


@table
class RAYS:
    """The adjustment of poses to the rays of mirrors: what is known of vehicles, and when returns are understood."""

    acceleration: float = 3.0   # m/s^2, usual of a vehicle on the road
    angular_acceleration: float = 0.5   # rad/s^2, usual of a vehicle on the road
    phase_acceleration: float = 10.0   # rad/s^2: a rotation rate of 100 Hz that swings by 1 % within seconds
    slip: float = np.radians(3.0)   # radians between nose and way
    pitch_sway: float = np.radians(1.0)   # radians between nose and climb of the way
    roll_sway: float = np.radians(2.0)   # radians between the vehicle and the crossfall under it
    min_speed: float = 1.0   # m/s: slower, the way says little about the attitude
    turn_prior: float = np.radians(30.0)   # radians of mountings about the first guess, turned
    lean_prior: float = np.radians(20.0)   # radians of mountings about the first guess, leaning
    lever_prior: float = 1.0   # m between scanners
    angle_noise: float = 2e-4   # radians of a ray's direction
    first_noise: float = 0.1   # m of places across the ray, to begin with
    least_noise: float = 0.002   # m of places across the ray, at least
    outlier_sigmas: float = 3.0   # sigmas at which a return has half its weight
    rounds: int = 12   # Gauss-Newton steps at most
    converged: float = 2e-4   # m: a smaller change is none
    block_intervals: int = 200   # intervals of which returns are taken at a time
    per_interval: int = 300   # returns of a scanner that are used of each interval
    max_counted_misfit: float = 0.3   # m: a ghost counts no more than this
    noise_of_misfit: float = 1.5   # noise against the mean misfit of an interval
    most_of_mean: float = 1.25   # times the mean of what rounding explains: an interval's returns lie at uneven distances
    settled: float = 1.1   # factor by which the noise still falls
    held: float = 1e8   # weight of what is held, as the levers' mean at 0
    reach: int = 10   # intervals that poses are carried on at a time: for a second a vehicle's motion is foreseen within decimetres
    max_growths: int = 12   # times that poses are carried on
    growth_stride: int = 3   # every n-th return is enough while growing
    max_tries: int = 4   # of an interval: with longer known motion beside it, it may come right after failing
    max_ray_misfit: float = 0.03   # m: an interval of a scanner whose returns lie farther off the rays is not understood
    max_unexplained: float = 0.05   # m: where returns usually lie farther off, the rays are not those of these scanners
    max_times_usual: float = 10.0   # times the usual misfit, where that is larger
    pose_stiffness: float = 10.0   # of the curves by which poses are carried on
    phase_stiffness: float = 1e3   # of the curves by which mirror phases are carried on
    min_range: float = 0.3   # m: nearer than this no scanner measures
    tiny: float = 1e-6   # added to the diagonal: keeps a control value that nothing determines where it is
    under_vehicle: float = 1.5   # m either side of the track: what the vehicle stands on
    ahead_reach: float = 5.0   # m along: nearer than this a road's grade changes little
    height_band: float = 0.15   # m about the usual height below the track: road, not what stands on it
    beside_intervals: int = 10   # either side that are taken together: a second of driving
    min_returns: int = 50   # returns that a crossfall needs, and
    min_spread: float = 0.3   # m across that they must be spread by (standard deviation)
    max_crossfall: float = 0.1   # slope: roads are no steeper across


@table
class ESTIMATE:
    """The estimated trajectory: what of it is written, and which clouds no vehicle on a road has measured."""

    row_spacing: float = 0.02   # s between the positions written: a third of a metre on a motorway
    max_sigma: float = 0.15   # m: a position that is known less well is not written; errors of twice that happen
    least_sigma: float = 0.002   # m: what calibration leaves, however many returns agree
    density_sigma: float = 0.5   # m of the place of a track by density alone: rms of twelve simulated surveys 0.56
    density_height_sigma: float = 0.3   # m of its height: rms of twelve simulated surveys 0.28
    read_progress: float = 0.4   # share of the work after which the points are read
    tracked_progress: float = 0.55   # share of the work after which the first tracks are known
    min_taking_part: float = 0.95   # share of the points that are of scanners that turn, where a field distinguishes them
    share_of_unexplained: float = 0.4   # share of what returns lie off the rays that the place is uncertain by
    farthest_median: float = 15.0   # m: half of what a vehicle on a road sees at a time is nearer; an aircraft's swath is wider
    min_share_elsewhere: float = 0.1   # of the points of a moment that lie in another place, where two drives have the same times
    min_far_apart: float = 50.0   # m between two such places
    place_radius: float = 15.0   # m: half of what lies in either is nearer to its middle
    split_rounds: int = 5   # rounds of parting the points of a window in two places
    max_road_reach: float = 8.0   # m: half of the points are nearer where the road under the vehicle is among them
    max_acceleration: float = 8.0   # m/s^2, which road vehicles reach in an emergency stop
    drivable_share: float = 0.9   # share of a track that keeps below max_acceleration, if a vehicle drove it
    min_path: float = 5.0   # m between the outermost places: less is no drive
    walking_pace: float = 2.0   # m/s: nobody surveys a road by car at that pace all the time
    pace_time: float = 3.0   # s over which a pace is told
    steady_places: int = 7   # places of some tenths of a second together, of which fewer than half may be wrong
    min_standing_time: float = 2.0   # s of measuring before standing still means anything


@table
class HEAD:
    """The track and the height of a many-beam head that turns about an upright axis."""

    turning_rates: tuple[float, float] = 4.0, 25.0   # turns per second that heads make
    rate_step: float = 0.05   # 1/s between rates that are tried
    rate_seconds: float = 2.0   # s from which the rate is found: the vehicle hardly turns meanwhile
    max_rate_samples: int = 20_000   # points by which rates are tried
    min_coherence: float = 0.8   # of bearings about the first track with a steady turning
    max_bearing_noise: float = np.radians(0.5)   # radians of bearings about the head: those of a mirror that turns about another axis are degrees off
    far_from_track: float = 4.0   # m from the first track, at which its error of a metre does not spoil a bearing
    max_turn_samples: int = 4000   # points used of a turn
    min_turn_samples: int = 200   # points that a turn needs
    min_gap_of_turn: float = 0.2   # of a turn without points, after which the next turn begins
    min_seen_share_of_turn: float = 0.5   # of a turn that must have been seen
    nearest_at_first: float = 3.0   # m: nearer returns do not count in the first rounds
    nearest_return: float = 2.0   # m: nearer returns do not count later
    first_rounds: int = 5   # rounds of reweighting that are the first
    rounds: int = 15   # rounds of reweighting
    max_step: float = 0.7   # m a round
    least_bearing_noise: float = np.radians(0.1)   # radians of a bearing, at least
    max_turn_misfit: float = 2.5   # times the usual noise: a turn of more is no turn of one head
    usual_height: float = 2.0   # m above the road, where the beams do not tell it: on the roofs of cars and of vans
    usual_height_sigma: float = 0.5   # m by which these differ
    least_sigma: float = 0.02   # m: what the beams' own directions leave, which no field tells
    rate_scale: float = 50.0   # 1/s: rates and speeds in units that make the equations even
    max_height_points: int = 200_000   # of a survey that are looked at
    turns_of_group: int = 10   # consecutive turns over which the vehicle tilts alike
    plane_reach: float = 12.0   # m from the head, of points on the road
    object_reach: float = 40.0   # m from the head, of points on what stands about
    own_vehicle_reach: float = 3.0   # m from the head: nearer lies the vehicle itself
    least_ground_points: int = 30   # points on the ground that a turn needs
    ground_rounds: int = 15   # rounds of fitting the ground
    first_ground_scale: float = 0.3   # m from the ground at which a point's weight is one half, in the first rounds
    ground_scale: float = 0.05   # the same in later rounds
    above_ground: float = 0.3   # m: higher points are on something; those on a level road would be rings seen from any height
    min_objects: float = 0.1   # share of the points that must be on something
    first_height: float = 1.9   # m above the road from which the height is looked for
    # fineness of elevations (radians), and steps of height (m) and of tilt (radians) in which the sharpest is looked for, from coarse to fine
    search: tuple[tuple[float, float, float], ...] = (
        (np.radians(0.3), 0.1, np.radians(0.3)), (np.radians(0.15), 0.05, np.radians(0.15)),
        (np.radians(0.08), 0.03, np.radians(0.08)), (np.radians(0.05), 0.02, np.radians(0.04)))
    search_steps: int = 5   # steps to either side that are tried
    search_rounds: int = 3   # rounds of each fineness
    coarse: float = np.radians(1.5)   # radians of elevation: what lies within it is spread as walls and trees are, whatever the beams
    min_sharing: float = 1.15   # times as many points share a fine interval as would by chance
    least_height_sigma: float = 0.15   # m: the beams of a head leave it up to two decimetres above the place that its maker calls its own
    max_height_sigma: float = 0.30   # m: what is known less well is not known
    heights: tuple[float, float] = 1.0, 4.5   # m above the road at which heads are mounted


@table
class VEHICLE:
    """The vehicle, and what one move of its trajectory may leave."""

    lowest_sensor: float = 0.5   # m above the road; no scanner rides lower, but lines and places drawn on the road lie within
    usual_ahead: float = 3.0   # m ahead of a trajectory on the same vehicle that scanners ride, one sigma
    turns_window: float = 0.05   # s; every mirror turns a few times, and a vehicle on the road hardly sways
    min_windows: int = 8   # good ones that the place of a scanner needs
    max_one_way: float = 0.95   # length of the mean unit vector to the points of a window: they lie within 60 degrees
    attitude_noise: float = 0.01   # radians that roll, pitch and heading may be off, or differ from those of the way driven
    max_upright: float = 0.8   # of the plane's normal; what lies flatter is the ground
    one_move: float = 0.20   # m that one move may leave, as navigation drifts; more is the error of a drive by itself
    course_noise: float = 0.15   # radians that the way driven may be off in tight bends, where it alone tells the attitude
    least_jump: float = 0.06   # m from one place of a drive to the next that scanners cannot have moved on their vehicle
    largest_lag: float = 0.5   # s by which a clock may lag: more is told of by itself
    moved_share: float = 0.9   # of the windows, in which no more may be left
    clearly_better: float = 0.5   # of what one move leaves, below which another is taken
