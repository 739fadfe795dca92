"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

import numpy as np

from ..common.setting import table

Arcs = tuple[tuple[float, ...], ...]   # shifts (m), turns (radians) and bends (1/m)


@table
class CURBS:
    """How steps are told from noise, linked to curbs and chosen along a road, whatever method finds them."""

    # corners of curbs
    road_side_length: float = 0.40   # m of road before the face to which the road's line is fitted
    face_margin: float = 0.05   # m next to the face left out of that line: a blurred face begins there
    behind_length: float = 0.40   # m behind the face in which the ground must stay raised
    slope_per_noise: float = 6.0   # per m: heights that scatter tilt the short line behind a face
    max_low_share: float = 0.15   # share of the points behind that may lie below half the height; a verge has more
    face_search_half_width: float = 0.15   # m on either side of the rising cell within which the face lies
    max_road_slope: float = 0.15   # rise over run of the road side; ditches are steeper
    max_bed_slope: float = 1.5   # rise over run of plants or a wall right behind a curb; what is steeper is a face itself
    min_bed_points: int = 8   # points that give the slope of plants or a wall
    max_face_width: float = 0.10   # m across
    hidden_face_spacings: float = 5.0   # mean spacings of points beside it from which a gap before raised ground hides a face: 1 in 150 is chance
    face_noise_sigmas: float = 4.0   # sigmas by which noise widens a face
    candidate_height_share: float = 0.8   # share of the least height below which a rise is no step in any direction
    min_step_sigmas: float = 4.0   # a step must stand this far above the noise of its road side
    candidate_sigma_share: float = 0.5   # share of that below which a rise is no step in any direction
    min_view_points: int = 5   # points that each of two views needs to be measured separately; else one shows what all points show
    face_lower_share: float = 0.15   # part of the height that counts as face, from
    face_upper_share: float = 0.70   # to: grass hangs over the top
    min_face_share: float = 0.5   # of the height; noise brings points from above and below into a thinner part
    remeasure_skew: float = 0.1   # m outward per m along above which a face is measured again across its own direction
    max_face_skew: float = 1.0   # m outward per m along
    skew_prior: float = 3e-3   # m²: keeps a face seen in one scan line parallel to the road
    face_prior: float = 2e-4   # m²: keeps a face seen in few points upright
    grade_prior: float = 3.6e-3   # m²: (noise / grade)² of 3 mm, the noise of a scanner, and 5 %, a usual grade or crossfall
    # levels in averaged profiles
    road_fit_length: float = 0.35   # m of road to which a level is fitted
    behind_fit_length: float = 0.25   # m of ground behind: a hedge may stand close
    blurred_face_half_width: float = 0.09   # m on either side of a step left out of both levels: the blurred face
    steep_half_width: float = 0.07   # m on either side of a step within which most of the rise must lie
    min_steep_share: float = 0.65   # share of the height; an even rise from level to level has less
    min_filled_share: float = 0.6   # share of the cells of a level that must hold ground
    max_averaged_scatter: float = 0.008   # m, scatter of averaged heights about their level: verges and banks have more
    # how high and how steep
    usual_height: float = 0.05   # m, and
    usual_slope: float = 60.0   # degrees: such a step is a curb wherever it is seen
    texture_sigma: float = 0.0025   # m, of heights averaged along a curb, however many: texture of the surfaces, footprint, registration
    significant_sigmas: float = 4.0   # of what is left of the noise, by which a faint step must rise
    least_height: float = 0.025   # m: lower steps are dropped curbs and seams
    least_slope: float = 25.0   # °: flatter faces are ramps
    max_faint_scatter: float = 0.006   # m, of a faint step about its own running line
    min_faint_length: float = 5.0   # m of faint steps in one line that make a curb
    # road before a curb
    max_road_ratio: float = 2.0   # roughness of the ground before a step over that under the vehicle, above which it is no road: before curbs of
    # simulated and real streets it was 0.2 to 1.7, in grass 2.0 to 7.6
    road_before_curb: tuple[float, ...] = (0.25, 0.5, 0.75)   # m before a step at which that is looked at
    # decimation
    points_per_level_cell: int = 12   # points of a cell that describe level ground in profiles
    points_per_level_cell_in_plan: int = 6   # the same in plan, where a cell of the raster covers four of these cells and more
    points_per_uneven_cell: int = 60   # points of any other cell; more hardly separate its layers better
    level_cell_std: float = 0.008   # m, standard deviation of heights in a level cell, with and without a grade of the road
    mostly_uneven_share: float = 0.7   # share of points in cells that are not level
    stretch_length: float = 5.0   # m of road that are read together
    decimation_block_points: int = 256_000   # points that are decided together
    joined_points: int = 60_000   # points below which those of one stretch and the next are yielded together
    decimation_locks: int = 16   # locks that stretches share while they are decided
    min_level_points: int = 4   # points that a cell needs for a statement whether it is level
    # thin clouds
    thin_width: float = 2.0   # m across in which points are densest: beside the track
    thin_density: float = 480.0   # points per m² of ground there, and at a step, below which several profiles show more than one
    # occlusion
    occlusion_cell: float = 0.25   # m across
    min_occluder_height: float = 0.45   # m above the expected road, from which a thing can hide a curb
    max_bottom_difference: float = 0.30   # m above or below the curb's bottom within which ground counts as seen
    hidden_point_spacing: float = 0.5   # m along the road between two points of hidden curb, and the length that each stands for
    water_cells: int = 4   # before a curb whose foot lies in water, and as many behind its foot: 1 m
    least_water_step: float = 0.05   # m above the foot, from which the ground behind it is raised: dropped curbs of driveways are lower
    shadow_reach: float = 3.0   # m along the road: the scan planes are oblique, so the shadows are, too
    # pseudo scan-lines
    min_ground_layer_share: float = 0.15   # share of the points of its cell below which the lowest layer is multipath and not ground
    top_quantile: float = 0.9   # quantile of the lowest layer that stands for its highest point
    min_scanner_noise: float = 0.002   # m
    default_scanner_noise: float = 0.005   # m, where too few cells hold enough points for an estimate
    max_ground_deviation: float = 0.15   # m from a cell's ground within which points count for the scanner's noise
    profile_noise_points: int = 4   # points of the lowest layer of a cell, and
    profile_noise_cells: int = 20   # such cells of a profile, that an estimate of its noise needs
    min_spread_points: int = 5   # points of a cell, and
    min_spread_cells: int = 10   # such cells of a profile, that an estimate of its spread needs
    spread_profiles: int = 6   # profiles on either side that are estimated together
    ground_depth: float = 2.0   # m below, and
    ground_height: float = 2.0   # m above the expected road within which ground is looked for
    # sections of a side
    block_section_length: float = 20.0   # m of road for which the length of blocks is decided
    work_section_length: float = 20.0   # m of road that are worked on together
    sections_together: int = 4   # of these that a worker process is best given: it reads, and decimates, what two of them share once
    max_curb_offset: float = 20.0   # m from the reference line within which curbs are looked for
    height_node_spacing: float = 0.25   # m between the nodes of the expected height
    max_look_along: float = 4.0   # m along the road from the vehicle to a point that is used, plus as much as it lies across
    min_hidden_gap: float = 2.0   # m between curb points from which one may be hidden: as far apart as points of automatic blocks lie
    max_hidden_gap: float = 30.0   # m between curbs within which lowered curb is looked for, and one from an island's
    # blocks of a side
    pass_merge_across: float = 0.12   # m across, and
    pass_merge_height: float = 0.10   # m of height between the same step seen in two passes
    max_block_length: float = 2.0   # m, automatic blocks on straight road, and
    min_block_length: float = 0.5   # m, in sharp bends
    max_block_turn: float = np.radians(1.0)   # turn of the road within a block
    max_block_bend: float = 0.015   # m off its own straight line above which a block is divided
    chain_end_steps: int = 3   # profiles that give the end point of a chain
    # lowered curb
    lowered_rows: int = 5   # rows of ground cells, 2.5 m along a curb, whose median step counts
    least_lowered_step: float = 0.005   # m of that median: along simulated lowered curbs it was 0.007 to 0.02, across mouths of streets 0.002 at most
    least_climb: float = 0.02   # m from the road to the first ground cell behind, 0.25 to 0.5 m away, and
    ramp_length: float = 1.0   # m behind a lowered curb within which the ground has climbed to the sidewalk by half the height of the full curb
    max_lowered_turn: float = 0.03   # radians that the curb on both sides turns off the line across: the step is measured on that line
    road_beside: float = 1.0   # m from the curb toward the road, where the same rows show what is no step
    # chains
    max_link_length: float = 1.0   # m along the road that a link may span
    link_drift: float = 0.20   # m across per m along that a link may differ from the faces' own direction
    link_tolerance: float = 0.05   # m across that two steps of one line may differ in any case
    height_tolerance: float = 0.03   # m that bottom heights of neighbours may differ
    min_chain_length: float = 0.75   # m of a chain that is used
    weak_scatter_factor: float = 2.0   # times the scatter at which a faint step is still a curb where it continues one
    low_curb_share: float = 0.5   # share of the least curb height from which a lower curb that continues a full one is used
    min_sloped_length: float = 10.0   # m of a sloped curb: the edge of worn cobbles or of a track is straight over a few metres
    faint_gain: float = 0.7   # value of a metre of low or sloped curb, where another may be chosen
    min_curb_length: float = 4.0   # m of chains in one line that make a curb
    max_chain_gap: float = 8.0   # m between chains of one line
    max_steady_gap: float = 15.0   # m between a curb and a piece of it, if their offsets differ by less than
    max_steady_jump: float = 0.5   # m
    max_joined_gap: float = 2.5   # m along a curb between points, chains or lines that are joined without a sign of something in between
    end_direction_steps: int = 5   # steps at the end of a chain that give its direction
    max_extrapolation: float = 3.0   # m that a chain is continued in its own direction
    min_chain_density: float = 0.5   # share of its profiles in which a chain must be seen
    max_chain_scatter: float = 0.02   # m, scatter about its own running line beyond the scanner's noise
    noisy_share: float = 0.125   # share of the least curb height: a scanner with a larger spread does not show a curb in one profile
    max_noise_allowance: float = 0.3   # share of the least curb height by which such a scanner may have seen a curb too low
    max_road_roughness: float = 0.010   # m about the road side's line, if the scanner's noise is less than half of it
    jump_cost: float = 4.0   # m of curb that a lateral jump of 1 m must gain
    level_jump_cost: float = 1.2   # m of curb that it must gain where road is seen all the way: the curb of a wider road behind a side street
    climb_cost: float = 60.0   # m of curb that a difference of 1 m in height must gain: ground behind a curb is higher
    same_curb_distance: float = 0.25   # m across within which chains of two methods are one curb
    method_change_cost: float = 1.0   # m of curb that one method must see beyond the other's chain to be drawn there
    max_jump_cost: float = 10.0   # m of curb that any jump costs at most
    distance_penalty: float = 0.03   # share of its value that a metre of curb loses for each metre farther from the track
    tracking_memory: float = 40.0   # m of road after which the best chain alone may still be continued
    # pieces in line
    line_fit_length: float = 10.0   # m of curb before and after a gap that give the line across it
    weight_length: float = 5.0   # m from the gap at which a place counts half
    min_bend_length: float = 3.0   # m of curb at an end from which its direction is known
    max_line_gap: float = 50.0   # m between two stretches of one line, and between curbs within which hidden curb is reported: a row of parked cars
    in_line_across: float = 0.08   # m from that line
    in_line_at_end: float = 0.03   # m from that line where a gap begins or ends, and
    in_line_drift: float = 0.01   # m more per m from the nearer end
    in_line_grade: float = 0.01   # m per m to the nearer end that the bottom may differ besides height_tolerance
    max_height_ratio: float = 1.6   # of the height of a piece over that of the curb before and after it
    min_piece_length: float = 0.5   # m, and
    min_piece_steps: int = 3   # steps, of a piece


@table
class PROFILE:
    """How steps are found on profiles."""

    min_track_distance: float = 0.6   # m from the track: no curb is nearer
    # single profiles
    max_rise_width: float = 0.15   # m across within which the whole rise must lie
    min_raised_cells: int = 3   # cells of raised ground behind a rise that a statement about its height needs
    min_raised_height_share: float = 0.65   # share of the least height that these cells must show
    # wider profiles
    wider_profiles: tuple[int, ...] = 1, 3, 6   # so many more profiles on either side are looked at together
    # averaged profiles
    averaging_length: float = 1.25   # m of road that are averaged
    skew_step: float = 0.125   # m outward per m along between the directions tried: 4 cm at the ends of the average
    skew_steps: int = 8   # such steps on either side of the road's direction
    oblique_factor: float = 1.15   # how much higher a rise must be in a direction farther from the road's own
    min_profile_share: float = 0.5   # share of the averaged profiles that must have ground in a cell
    stays_up_sigmas: float = 2.0   # of the heights behind such a curb: that far below their mean they are still above half of its height
    min_step_spacing: float = 0.12   # m across within which one step is reported
    all_views_sigmas: float = 2.0   # sigmas of single heights that a step must rise in all views together, and
    single_view_sigmas: float = 2.5   # in a single view
    same_step_distance: float = 0.25   # m across within which a step seen from one side only is the one already found
    max_network_rows: int = 9   # profiles that are sorted element by element; for more, numpy's sort is faster


@table
class SCANLINE:
    """How scan lines are laid and corners of curbs found on them."""

    # candidates
    usual_step_height: float = 0.03   # m, and
    usual_angle: float = 60.0   # degrees, of table 1 of the paper: such a step is a curb wherever it is seen
    min_rise_share: float = 0.7   # of min_height: the planes measure the height of the curb more exactly later
    max_roughness_share: float = 0.4   # of a rise: standard deviation of the road before it
    min_road_cells: int = 6   # cells of road before a rise
    behind_rise: tuple[float, float] = (0.06, 0.40)   # m beyond a rise, where the ground must stay raised
    max_sunk_share: float = 0.25   # of the cells there that may lie below half the rise
    min_cells_behind: int = 4   # cells there that must be occupied
    gap_fill_reach: float = 0.30   # m along the road on either side, from which gaps of a scanline are filled
    match_across: float = 0.08   # m across, and
    match_up: float = 0.04   # m of height between candidates of one curb on neighbouring scanlines
    neighbour_lines: int = 2   # scanlines on either side, and
    min_lines_showing: int = 3   # scanlines that must show a candidate, itself included
    height_weight: float = 2.0   # m across that a metre of height counts as, so that low faces have enough vertices
    place_cell: float = 0.10   # m across, cells in which the surroundings of candidates are marked
    # planes
    ransac_trials: int = 32   # few are enough: most samples of a class belong to its plane
    ransac_seed: int = 20   # any: the same result in every run
    scored_points: int = 48   # samples on which the trials are compared
    inlier_sigmas: float = 1.5   # times the standard deviation, or the RANSAC distance where that is more
    ransac_refits: int = 3   # least-squares fits after the best trial
    sets_per_batch: int = 96   # planes fitted at a time; their samples fit into the cache of the processor
    min_plane_variance: float = 1e-6   # m², ridge: the plane of samples on one line stays level across that line
    max_level_vertices: int = 96   # samples of the planes of road and raised ground, and
    max_face_vertices: int = 64   # of the face
    max_plane_rows: int = 9   # scanlines around a candidate; with narrower intervals some are left out
    min_plane_inliers: int = 15   # inliers of a plane
    min_inlier_share: float = 0.5   # inliers of a plane among its samples
    max_road_share: float = 0.30   # of the rise: road is lower, and
    min_raised_share: float = 0.70   # raised ground is higher
    face_share: tuple[float, float] = (0.12, 0.88)   # of the rise: the face lies between
    face_half_width: float = 0.12   # m across from the middle of the rise: the face is nearer
    face_slope_tolerance: float = 20.0   # degrees by which the slope of a scanline on a face may be below vertical_angle
    face_clearance: float = 0.02   # m across from the middle of the rise: road and raised ground are farther
    gutter_depth: float = 0.12   # m below the line of the road: a gutter, and
    raised_margin: float = 0.10   # m above the rise: a sloping sidewalk
    max_corner_distance: float = 0.10   # m from a corner to the nearest sample of each of its planes
    min_meeting: float = 0.1   # 1 - product of the slopes: flatter intersections give no corner
    # lines
    max_usual_noise: float = 0.005   # m: a higher scatter about the planes is rough ground, such as a verge
    max_measured_gap: float = 1.0   # m between consecutive corners of a measured line; wider gaps are bridged
    same_curb_distance: float = 0.3   # m across within which a sloped face is part of an upright one
    corner_block: float = 0.5   # m of road per corner of the CORNERS output
    # grid
    scanline_resolution: float = 0.02   # m across between cells, and along a scanline between resampled vertices
    max_ground_depth: float = 1.0   # m below the expected road, down to which points are ground
    # mesh
    min_driven: float = 0.01   # m driven between scan lines: of a standing vehicle one line is used
    max_rib: float = 0.30   # m, or max_lines_ahead times the way driven during a turn where that is more
    max_lines_ahead: int = 3   # lines ahead on which the same phase is searched
    max_missing_pulses: int = 3   # pulses that may be missing between neighbours on a line,
    max_neighbour_distance: float = 0.15   # or m between them, however many are missing
    max_edge: float = 1.0   # m between neighbours on a line; wider gaps are ground seen at grazing incidence
    range_jump: float = 0.30   # m, difference of range between neighbours that is checked for an edge of an object
    rib_tolerance: float = 1e-6   # of the way between two points; a place nearer to a point is the point itself
    slant_share: float = 0.5   # of the way driven during a turn: edges longer along the road are intersected too
    grazing_tangent: float = 0.09   # tangent of the angle to the beam; a flatter jump of range is the edge of an object
    max_backward: float = 0.05   # m by which a line may run back across the road, as noise on a face makes it
    max_pieces_between: int = 3   # pieces of other objects between two of one line: a car and the ground beside it at one phase, in different turns
    offset_unit: float = 1e-7   # m, unit of offsets while they are sorted
    # section planes
    min_plane_line_vertices: int = 2   # vertices of a line
    max_speed: float = 60.0   # m/s: faster is an error of the trajectory
    # slices of points
    slice_layer_jump: float = 0.05   # m of height between the ground and the layer above it
    min_steep_rise: float = 0.02   # m of height within one cell, and
    steep_noise_sigmas: float = 6.0   # times the noise: more is a face
    face_vertex_step: float = 0.01   # m of height between the vertices of a face
    max_vertex_gap: float = 0.30   # m between neighbouring vertices of one line
    min_slice_line_vertices: int = 3   # vertices of a line
    slice_margin: float = 0.01   # m read beyond the slices; the slices then select their points exactly
    min_slice_length: float = 0.20   # m along the road: thinner slices may lie between two turns of a scanner


@table
class RETURN:
    """How curbs are found in plan: corners, side streets, islands."""

    # classes
    min_return_length: float = 1.0   # m of a line
    min_return_steps: int = 3   # of a line: any two are in one
    least_behind: float = 0.12   # points of raised ground for each one before a curb and on it: at feet of walls there were 0.05 to 0.1,
    least_behind_apart: float = 0.3   # or up to 0.27, and at curbs 0.46 to 0.9, or 0.18 with a hedge on them
    max_step_spacing: float = 0.6   # m between the steps of a line, on average: scan lines lie apart
    min_road_cosine: float = np.cos(np.radians(45.0))   # of the angle between a line and the road, above which it is the road's own curb
    min_parallel_cosine: float = np.cos(np.radians(20.0))   # of the angle between a line and the road, above which it runs along the road
    max_straight_deviation: float = 0.05   # m off its chord within which a curb that left the road is straight
    min_straight_length: float = 2.0   # m of straight curb that make a side street
    min_island_share: float = 0.6   # share of an island's steps behind which the ground comes down again
    min_island_length: float = 2.0   # m of lines about one island
    max_island_gap: float = 3.0   # m between them
    outline_margin: float = 0.3   # m from either side of an island within which a line is that side
    min_isolated_length: float = 5.0   # m of a line that belongs to a side street although nothing joins it to the main curb
    max_behind_share: float = 0.25   # share of such a line that may lie behind the main curb, which ends beside its corner
    max_side_street_turn: float = np.radians(35.0)   # of its steps from the direction of such a line
    side_street_widths: tuple[float, float] = (2.5, 16.0)   # m between the two curbs of a side street
    max_opposite_shift: float = 4.0   # m along the side street by which its two curbs may miss each other
    # lines apart: on simulated streets true ones were 0.69 to 1.13 times as high as the road's curbs, edges of ramps and private ground 0.36 to 0.67
    full_height: float = 0.75   # quantile of the heights of a road's curbs that is theirs where nothing lowers them
    max_height_step: float = np.log(1.45)   # by which the logarithm of the height of a curb of the same road differs from that of theirs
    # search in plan
    limit_node_spacing: float = 0.05   # m along the road between the stations at which this is decided
    section_margin: float = 2.0   # m of road on either side of a section that its own steps need
    noisy_raster_share: float = 0.12   # share of the least curb height that heights within a cell scatter, above which they are averaged
    view_length: float = 5.0   # m ahead of the vehicle and behind it, that part what is seen near from what is seen far
    main_curb_distance: float = 0.25   # m from a main curb within which a step belongs to it
    led_progress: float = 0.9   # share of the work after which faint curbs are looked for
    max_island_width: float = 8.0   # m within which the ground behind an island's curb comes down again, and that its nose is long at most
    # faint curbs
    led_length: float = 4.5   # m along a curb that are averaged: the least length of a faint curb
    led_step: float = 0.5   # m from one average to the next
    max_led_length: float = 20.0   # m that a curb continues at most
    across_cell: float = 0.025   # m, cells across the curb
    level_road: tuple[float, float] = (-1.5, -0.5)   # m across from the curb of the road beside it, where averages show what is no step
    max_layer_height: float = 0.3   # m above or below the curb's end within which its ground lies
    min_half_share: float = 0.5   # of the least height, that the step must rise along either half
    step_share: float = 0.24   # n1 n2 / (n1 + n2)²: share of a step's squared height in the variance that it explains
    bend_sigma: float = 0.1   # 1/m, of the bend of a faint curb
    first_turns: tuple[float, ...] = tuple(np.radians(np.arange(-6.0, 6.1, 1.5)))   # by which a curb may leave the arc so far, at first, and
    first_bends: tuple[float, ...] = tuple(np.arange(-0.2, 0.201, 0.025))   # 1/m, bends
    first_sigmas: tuple[float, float] = 0.03, 0.04   # m, of its place at the beginning of the next arc and in the middle
    next_turns: tuple[float, ...] = tuple(np.radians(np.arange(-4.0, 4.1, 1.0)))   # the same farther on, where the arc before has shown it
    next_bends: tuple[float, ...] = tuple(np.arange(-0.08, 0.081, 0.02))
    next_sigmas: tuple[float, float] = 0.015, 0.02
    shifts: tuple[int, ...] = -2, -1, 0, 1, 2   # cells across by which it may leave the arc
    alike_along: float = 0.5   # m along, and
    alike_across: float = 0.1   # m across, within which the errors of a many-beam scanner are alike
    largest_bend: float = 0.25   # 1/m
    core_share: float = 0.7   # of the width of an island, whose end is averaged: its corners are round
    end_turns: tuple[float, ...] = tuple(np.radians(np.arange(-18.0, 18.1, 6.0)))   # of that end, from straight across
    meeting_curb_distance: float = 0.25   # m within which a curb that continues has reached another
    leaving_length: float = 1.0   # m from its beginning in which it is near the curb that it continues
    # curbs followed
    following_step: float = 0.4   # m along a curb from one measurement to the next
    followed_length: float = 16.0   # m that a line is followed at most within a section
    followed_half_length: float = 2.0   # m either way along a curb of the points that measure it, where nearer ones do not show it
    min_quarter_points: int = 2   # points on either side of a step, before it and behind it: none is measured beyond what was seen
    max_followed_points: float = 1.0   # points for each cell of the raster: where there are more, a curb that goes on was found already
    followed_steps: int = 4   # steps of following_step over which the direction is taken from then on
    followed_across: float = 0.06   # m from the line within which the curb goes on, and
    followed_skew: float = 0.15   # m across per m along, that its face may turn from it
    followed_height_ratio: float = 1.6   # of its height over that of the line, or the other way
    # raster of the ground
    plan_cell: float = 0.10   # m
    plan_ground_depth: float = 1.0   # m below, and
    plan_ground_height: float = 1.0   # m above the expected road within which ground is looked for
    averaging_cell: float = 0.05   # m, cells whose points are averaged for a noisy scanner
    min_noise_points: int = 4   # points of a cell, and
    min_noise_cells: int = 50   # such cells that an estimate of the scanner's noise needs
    noise_quantile: float = 0.3   # quantile of the cells' spreads that is the estimate
    level_window_cells: int = 5   # cells, side of the square in which ground is tested for being level
    max_level_share: float = 0.7   # share of the least step that level ground may differ within that square
    slope_block_cells: int = 5   # cells, side of a block, and
    slope_window_blocks: int = 5   # blocks, side of the window from which the slope of the ground is estimated
    max_ground_slope: float = 0.12   # rise over run of a road
    blind_cells: int = 30   # cells from a driven track within which the vehicle itself may hide the ground
    max_bridged_cells: int = 3   # cells without points that count as drivable between others: scan lines lie apart
    # islands among main curbs
    min_side_step: float = 1.0   # m across by which the road's curb lies farther out than an island's
    averaged_length: float = 1.0   # m along the road either way whose ground is taken together
    slope_length: float = 3.0   # m before a curb, where the slope of the road is taken
    min_slope_cells: int = 4   # cells with ground that this needs
    min_road_behind: float = 2.0   # m of ground as low as the road that lie behind an island
    # far sides
    edge_reach: float = 0.25   # m either way of the last raised cell within which the edge of the top lies
    edge_half_length: float = 0.15   # m either way along the edge of the points that show it
    min_edge_points: int = 4   # of the top
    max_edge_spacing: float = 0.15   # m across between points of the top: the edge lies up to that much beyond the outermost
    spacing_depth: float = 0.40   # m of the top from its edge inward in which that is looked for
    min_top_share: float = 0.6   # share of the height of the island's near side that its top has
    seen_step_distance: float = 0.4   # m from a step that was seen, within which nothing is hidden
    min_island_width: float = 0.4   # m
    # tops of islands
    ray_spacing: float = 0.2   # m between places along a ray
    ray_reach: float = 0.3   # m from such a place within which a step lies on it: the steps of a line are up to twice that apart
    min_foot_share: float = 0.25   # share of the height of an island's curb by which the foot of a step on its top lies above the road
    # ground behind
    road_before: float = 1.25   # m before a step, where the slope of the road is taken: the step itself is not in it
    island_drop_share: float = 0.4   # share of a step's height that the ground behind an island may lie above its bottom
    min_edge_share: float = 0.7   # share of that height at which its far side begins
    # main curbs
    min_opening_length: float = 6.0   # m without main curb that are an opening and no driveway
    opening_margin: float = 6.0   # m of main curb beside an opening behind which corners are looked for
    search_behind_curb: float = 0.6   # m behind a main curb that are searched elsewhere
    max_run_jump: float = 0.5   # m across between points of one run of main curb
    # beyond the corridor
    max_corridor_distance: float = 15.0   # m straight on from its end within which such a curb leaves the corridor
    max_beyond_length: float = 40.0   # m that it is continued: the ground of the survey reaches no farther
    max_dropped_length: float = 6.0   # m from its end that it may be dropped: a pedestrian crossing
    trail_length: float = 6.0   # m of known curb whose direction it keeps
    min_height_share: float = 0.5   # of the height that the curb is known to have, from
    max_height_share: float = 1.5   # to
    min_level_share: float = 0.75   # of the points on either side that are nearer to their own level than to the other
    growth: float = 1.0   # m by which the fitted length grows
    step_spacing: float = 0.5   # m between the places that are returned
    cell_along: float = 0.5   # m along, and
    cell_across: float = 0.1   # m across, cells in which dense points are averaged: their errors are alike
    spread_step: float = 0.03   # m at three places, between the arcs about the best that are weighed first, then
    spread_step_sigmas: float = 0.8   # sigmas of what they spread, but at least
    least_spread_step: float = 0.002   # m, in
    spread_rounds: int = 3   # rounds
    # levels about an arc
    ground_half_width: float = 0.8   # m on either side of the points that show the levels
    curb_half_width: float = 0.03   # m about the curb in which a point is on neither level, but anywhere between them
    min_side_points: int = 3   # along led_length on either side
    point_height_sigma: float = 0.015   # m, of a point about its level, and
    place_sigma: float = 0.03   # m, of a step of the known curb about its course
    max_residual: float = 3.0   # sigmas beyond which a point counts no more: objects, plants
    bottom_sigma: float = 0.02   # m, of the height of the bottom at the end: what is known beforehand, and
    grade_sigma: float = 0.03   # m per m, of the grade
    rise_sigma: float = 0.03   # m, of the height
    crossfall_sigma: float = 0.04   # m per m, of the crossfall
    arc_bend_sigma: float = 0.005   # 1/m, of the bend
    first_arcs: Arcs = tuple(np.arange(-0.06, 0.061, 0.03)), tuple(np.radians(np.arange(-5.0, 5.01, 0.5))), (0.0,)   # tried first: straight ones,
    finer_arcs: Arcs = tuple(np.arange(-0.02, 0.021, 0.02)), tuple(np.radians(np.arange(-0.4, 0.41, 0.2))), tuple(np.arange(-0.02, 0.0201, 0.004))
    farther_arcs: Arcs = tuple(np.arange(-0.02, 0.021, 0.02)), tuple(np.radians(np.arange(-0.3, 0.31, 0.15))), tuple(np.arange(-0.004, 0.0041, 0.002))
    spread_grid: tuple[float, ...] = tuple(np.arange(-3.0, 4.0))   # steps either way of the arcs that are weighed, at each of three places
    least_steps: int = 8   # of the known curb, which are independent
    # steps in plan
    short_half_length: float = 0.30   # m either way along the curb of the points that measure one step, in dense scans,
    long_half_length: float = 0.90   # m, and in sparse ones
    line_radius: float = 1.0   # m about a step within which others give the direction of their line
    min_line_steps: int = 3   # others that this needs
    max_line_scatter: float = 0.12   # m, scatter across that line
    max_face_offset: float = 0.10   # m that a step may lie from the place where it is looked for
    measuring_rounds: int = 3   # measurements of a step, each across the direction that the one before gave
    remeasure_offset: float = 0.04   # m from where it was looked for above which a step is measured again
    # places of steps
    max_cells_from_road: int = 4   # cells from driven ground within which it may end at a step
    steps_per_batch: int = 512   # steps that are measured together: they fit the processor's cache
    patch_cells: int = 4   # cells about a step whose ground gives its direction and height
    step_half_width: float = 0.11   # m from the middle of a step, beyond which ground is before or after it
    patch_half_length: float = 0.31   # m along a step of the ground that is compared
    max_plan_roughness_share: float = 0.25   # share of a step's height that the road before it may scatter
    min_plan_rise_share: float = 0.6   # share of the least step that the cells of one must show
    # lines in plan
    duplicate_along: float = 0.12   # m along, and
    duplicate_across: float = 0.06   # m across within which the better supported of two steps stands for both
    max_plan_link: float = 1.2   # m along a curb that a link may span
    plan_link_tolerance: float = 0.03   # m across that two steps of one line may differ in any case,
    plan_link_drift: float = 0.06   # m per m along besides, and
    drift_per_turn: float = 0.2   # m per m along and radian of turn
    min_curb_radius: float = 0.4   # m, of the sharpest curb, the nose of an island
    turn_tolerance: float = np.radians(25.0)   # radians by which neighbours may turn in any case
    max_height_grade: float = 0.08   # m per m along that bottoms of neighbours may differ besides height_tolerance
    max_join_turn: float = np.radians(45.0)   # between two chains of one line
    max_nose_gap: float = 1.5   # m between ends that may enclose the nose of an island
    nose_radius: float = 0.5   # m, of that nose
    join_drift: float = 0.25   # m across per m that two such chains may miss each other, and
    join_tolerance: float = 0.05   # m in any case
    end_direction_length: float = 0.6   # m at the end of a chain that give its direction
    max_straight_gap: float = 15.0   # m that a straight curb may be dropped or hidden: a crossing, a drive, parked cars
    line_direction_length: float = 2.0   # m at the end of such a curb, or of one that is followed, that give its direction
    max_straight_turn: float = np.radians(8.0)   # between its two parts
    straight_drift: float = 0.03   # m across per m that they may miss each other, and
    straight_tolerance: float = 0.10   # m in any case
    straight_grade: float = 0.01   # m per m that their bottoms may differ besides height_tolerance
    max_join_overlap: float = 0.3   # m that two such chains may overlap, and


@table
class EDGE:
    """How lines are led through curb points."""

    # curb returns
    return_vertex_spacing: float = 0.25   # m between vertices: the nose of an island has a radius below a metre
    smoothing_half_length: float = 0.5   # m along a curb within which its points give its course
    same_place_distance: float = 0.02   # m within which two places are one
    # dropped corners
    max_dropped_gap: float = 8.0   # m of dropped curb around a corner
    lowered_share: float = 0.5   # of the height of a curb around, to which it is lowered at a drive: it was 0.2 to 0.5
    min_dropped_gap: float = 0.3   # m
    min_arc_turn: float = np.radians(12.0)   # radians from end to end, least, and
    max_arc_turn: float = np.radians(100.0)   # most
    bend_length: float = 3.0   # m at the end of an edge that tell how it bends
    min_bend_turn: float = np.radians(8.0)   # within this length: the end belongs to a corner
    max_radius_ratio: float = 2.5   # of the arc in the gap over the bend at its end, and the other way
    direction_length: float = 1.0   # m at the end of an edge that give its direction
    max_end_step: float = 0.03   # m, and
    max_end_grade: float = 0.08   # m per m that both ends may differ in height
    meeting_distance: float = 0.05   # m within which two ends meet
    arc_vertex_spacing: float = 0.25   # m
    arc_sigma: float = 0.005   # m per m of an arc: seven of a simulated crossing, 3 to 7 m long, lay 0.1 to 4.9 cm beside the curb
    # main edges
    median_window: float = 5.0   # m of running median
    outlier_mads: float = 3.0   # median absolute deviations, as sigmas, and
    outlier_floor: float = 0.05   # m, the least distance from it at which a point is an outlier
    min_hidden_share: float = 0.5   # share of a gap that must be hidden for a bridge of a pavement edge or of a boundary line
    hidden_curb_share: float = 0.33   # the same of a curb: where one goes on unseen, two fifths and more are hidden, at an opening next to nothing
    gap_end_allowance: float = 1.0   # m of a gap, half at each end, that need not be hidden
    in_line_gap_factor: float = 3.0   # times the longest bridged gap that an edge may be hidden whose two parts lie in one line,
    max_open_part: float = 5.0   # m of such a gap in which nothing hides the curb: along rows of parked cars it was 3 m at most
    max_edge_skew: float = 1.0   # m across per m along of a joined edge
    max_edge_jump: float = 0.25   # m across that two joined points may differ in any case
    bridge_spacing: float = 3.0   # m, about, between places on a line across a gap
    edge_vertex_spacing: float = 0.5   # m between vertices
    min_edge_length: float = 1.5   # m of a piece with curb points; the first and the last are means over a quarter of a metre inside its ends
    gap_sigma: float = 0.0005   # m per m of the longest bridged gap, least noise of the points of a curve across it
    min_point_sigma: float = 0.001   # m, least noise of a curb point
    max_stretch: float = 1.2   # length of a curve between two points over that of their chord, and
    max_swing: float = 0.3   # m more, above which it swings: the noise of points centimetres apart is none; looked at in
    swing_places: int = 8   # places; and
    max_refits: int = 8   # fits of such a curve, each with four times the smoothing
    # uncertainty
    scatter_reach: float = 10.0   # m along the line, either way, over which the scatter of curb points is taken
    end_length: float = 5.0   # m from its end at which what a line's end is held by one side only has fallen to 1/e in square
    point_sigma: float = 0.04   # m, of the foot by a single laser point: chosen on 21 simulated streets, for two sigma as well as one
    # m, of the foot of a curb return (found in plan, from fewer points) or a dropped curb, and m per m³ of its length in the middle of a bridge:
    # fitted on half of those streets, judged on the others
    faint_foot: float = 0.005
    bridge_bend: float = 1e-5


@table
class SURFACE:
    """Where the road ends and what belongs to its surface."""

    # surface
    tolerance_floor: float = 0.03   # m, height tolerance of a scanner without noise
    tolerance_sigmas: float = 4.0   # times the noise of the heights, added to it
    track_reach: float = 1.5   # m either side of the reference line where ground must be measured
    places_between: int = 25   # of a way across the ground that are looked at,
    min_seen_between: float = 0.7   # least share of them that must be seen, and
    min_level_between: float = 0.9   # of these, as high as the road, for it to be level
    rows_of_look: int = 10   # rows of cells either way, 5 m, whose roughness under the vehicle is the road's
    grown_inset: float = 0.05   # m off a limit that is no edge: on a road that is too wide, verge is extracted as paint
    min_surface_width: float = 0.5   # m between the limits of a row with road
    measured_progress: float = 0.9   # share of the work on a carriageway at which its ground is measured
    # mouths of side streets
    min_mouth_width: float = 7.0   # m along the road: a lane of 3 m with corners of 2 m radius; driveways and dropped curbs are narrower
    min_street_width: float = 2.5   # m: a lane
    min_mouth_depth: float = 5.0   # m beyond the line that closes the opening in which the street is still as wide: one car's length
    flank_depth: float = 2.0   # m beyond that line from which the sides of the street are looked at: nearer, its corners are dropped
    flank_rows: int = 2   # 1 m along the road from the outermost cell of the street to the ground beside it
    min_flank_step: float = 0.03   # m between them: the lowest curbs
    max_level_flanks: float = 2 / 3   # m along its two sides, per m of its width, that may lie level with the street: driveways, dropped corners
    max_unseen_columns: int = 5   # 1.25 m across the road between two tracks of the scan, far from the vehicle
    step_columns: int = 2   # 0.5 m of other ground end the street; one cell alone is a thing on it
    smoothed_rows: int = 5   # 2.5 m along the road: the far end of the scan frays
    # margins too thin for curbs
    min_curb_density: float = 40.0   # points per m² of ground: a face of 10 cm then has some five per metre; where they are fewer curbs may be lost
    margin: float = 1.0   # m inside the limits of the carriageway in which points are counted
    stretch_rows: int = 20   # rows of ground cells that are looked at together
    seen_share: float = 0.3   # of the cells of a stretch that must hold ground: where something hides it, nothing is said
    shortest_told: float = 20.0   # m of all thin margins together from which they are told
    told_stretches: int = 4   # that are named, the longest first
    # change of the ground
    certain_road: float = 1.2   # m beside the track that belong to the road: the vehicle drove there
    min_change_cells: int = 4   # cells over which a change must last
    max_height_change: float = 0.025   # m from the median height of the cells before
    unevenness_factor: float = 2.0   # times the unevenness of the road, added to either height limit
    cells_of_unevenness: int = 8   # cells at least whose steps tell how uneven the road is
    roughness_factor: float = 1.6   # times the roughness of the road, and
    roughness_floor: float = 0.0025   # m added to it, above which ground is rougher
    cells_of_roughness: int = 15   # cells before a place whose roughness is the road's
    min_tilt_change: float = 0.10   # m per m: change of tilt at which a bank or a ditch begins,
    cells_of_tilt: tuple[int, int] = 10, 6   # between so many cells before a place and from it on,
    min_cells_of_tilt: tuple[int, int] = 5, 4   # of which so many were measured
    max_empty_ground_cells: int = 5   # consecutive cells without points at which the road ends,
    max_blind_cells: int = 12   # unless at most so many are empty and road follows: the blind zone beside the vehicle
    cells_before_blind: int = 10   # cells before a blind zone whose roughness the road behind must have
    min_measured_behind: float = 0.75   # of the cells behind a blind zone, for road to follow
    obstacle_height: float = 0.25   # m above the road of a cell that hides the road behind it, such as the side of a car,
    obstacle_cells: int = 5   # where road follows within so many cells
    min_agreeing_share: float = 0.7   # of the cells ahead that must show the change
    profiles_per_batch: int = 64   # profiles compared at a time; their windows take some megabytes
    compared_cells: int = 10   # either side of a step of brightness: 1 m, of which paint covers less than half
    brighter: float = np.log(1.5)   # step of the logarithm of brightness; asphalt of another age differs by less
    lasting_share: float = 1.0 / 3.0   # of the median step by which the ground right before the limit is still brighter: it falls off with range
    lasting_profiles: int = 31   # 2 m apart, of which most must show it: patches of asphalt are shorter
    agreeing_profiles: int = 5   # whose median place of the step counts,
    max_strip_shift: int = 5   # cells from it to the step of a profile of the same strip: half of what is compared
    # following the height
    max_height_deviation: float = 0.035   # m from the predicted height: more is a curb, a car or an island
    noise_factor: float = 2.0   # times the standard error of the height of a cell, added to it
    tolerance_gain: float = 0.02   # m per m without ground, and
    max_tolerance_gain: float = 0.05   # m at most: behind an island the prediction is uncertain
    track_half_width: float = 0.6   # m either side of the reference line, where the road is known to be
    height_gain: float = 0.5   # share of a deviation by which predicted height, and
    tilt_gain: float = 0.15   # tilt are corrected
    max_cross_slope: float = 0.12   # m per m across the road
    row_smoothing_sigma: float = 1.0   # m along the road
    smoothed_columns: int = 16   # columns smoothed along the road at a time
    cells_between_questions: int = 100_000   # followed until Cancel is asked for: some 50 ms
    # cells
    cells_of_step: int = 3   # on either side of a step, to which its lines are fitted: 0.75 m
    row_length: float = 0.5   # m along, and
    column_width: float = 0.25   # m across the road, size of a ground cell
    ground_layer_jump: float = 0.06   # m of height between two layers: the ground and the sill of a car
    ground_layer_depth: float = 0.12   # m of the lowest layer that count as ground: a wall is one layer up to its top
    min_layer_share: float = 0.08   # of the points of a cell: a smaller lowest layer is multipath below the road
    max_points_per_cell: int = 100   # denser cells are subsampled: more points do not change the result
    ground_points_per_batch: int = 1 << 15   # points processed at a time; they fit into the cache of the processor
    min_layer_points: int = 3   # points of a layer
    min_freedom: int = 3   # points of a plane beyond three; with fewer a cell has a mean height, and is rough only with its neighbours along the road
    profile_row: float = 1.0   # m along, and
    profile_column: float = 0.1   # m across the road, size of a cell of a profile
    farthest_ahead: float = 25.0   # m from the vehicle of points whose brightness counts: across a bend a place is seen from far away, too
    ground_reach: float = 0.7   # m above or below the road under the vehicle, and
    ground_reach_per_metre: float = 0.12   # more per m of offset, within which ground is looked for
    thin_density: float = 320.0   # points per m² beside the track, below which rows are looked at together: whole surveys had 348 and more
    rows_about_thin: int = 10   # rows of profiles before a window, and behind it, that must be thin as well for its own to be looked at together
    # levels of scanners
    level_width: float = 1.0   # m across the road in which the levels of views differ by one factor
    point_sigma: float = 0.2   # of the logarithm of the intensity of a point about that of its cell: texture, speckle, paint
    change_sigma: float = 0.1   # of the logarithm of a factor from one level_width to the next: range and angle change evenly
    level_sigma: float = 2.0   # of the logarithm of a factor itself: it is unknown
    # windows
    window_rows: int = 10   # rows of cells in memory at a time: 5 m
    measured_windows: int = 8   # that a worker process is given together: at everyday density a twentieth of a second of its time
    # edge of the pavement
    pooled_rows: int = 5   # rows of cells that make one profile: 5 m, and
    rows_per_step: int = 2   # from one profile to the next: 2 m
    max_miss: float = 1.5   # m by which a profile may miss the edge and say so, farther is no worse
    blind_share: float = 0.3   # of the miss of a limit farther out than a profile that ends where nothing was measured
    widening_cost: float = 1.5   # m of misses that a change of the edge by 1 m must save: three profiles (6 m) in a row
    largest_widening_cost: float = 3.0   # m of misses that any change must save: a street joins over at least five profiles (10 m)
    # openings of edges
    max_opening: float = 30.0   # m of missing edge that is closed by a straight line
    edge_continuation: float = 5.0   # m by which the offset of an edge holds before its first and after its last vertex
    max_bridged_skew: float = 0.15   # m across per m along of a gap, beside max_edge_jump: tapers widen by 1 in 10 and less
    # limit of the pavement
    road_cells: int = 20   # cells of road from which its look is continued: 2 m
    inner_cells: int = 12   # cells inside, and
    outer_cells: int = 10   # outside the place where the ground changes in which the limit is searched
    averaged_rows: int = 3   # rows either side that are averaged: 7 m of road
    min_sigma_share: float = 0.25   # of the scatter of the brightness of single points that averages differ anyway: texture of asphalt
    rough_sigma: float = 0.25   # of the logarithm of roughness, that averages differ anyway within 2 m of road,
    near_rough_sigma: float = 0.12   # and from one cell to the next
    height_sigma: float = 0.008   # m that averages lie off the height of the road anyway
    level_drift: float = 0.16   # sigmas by which the level of the road changes per cell: half a patch of 1.7 m; a filter of six cells
    road_drift: float = 0.4   # more where there is road for certain: a patch of other asphalt is followed within three cells
    view_drift: float = 1.0   # and more per unit of the logarithm of the density: where that changes, the ground is seen from elsewhere
    density_cells: int = 5   # cells over which the density is averaged, where
    min_seen_share: float = 0.7   # fewer than this share of the road's hold points: scan lines lie 0.3 m apart
    min_known_rows: int = 3   # rows with a cell, of which it counts in full
    max_sigmas: float = 2.8   # sigmas by which any of the three may be off: a cell of other ground weighs as much as one of road
    other_sigmas: float = 2.0   # sigmas from which a cell is rather not road
    patch_edge_cells: int = 3   # cells on either side of the edge of a patch that show it, and
    patch_edge_sigmas: float = 5.0   # sigmas by which they differ
    min_patch_rows: int = 5   # rows about each row of a patch, and
    patch_rows: int = 30   # rows either side with which it is compared: patches are shorter
    mixed_cells: int = 1   # cells before a limit that may hold other ground in part: rows are averaged
    line_sigmas: float = 2.0   # by which paint is brighter than the cells on both sides
    paint_share: float = 0.5   # of what it is brighter than the darker of them, at least, than the other: what rises once is other ground
    line_cells: tuple[int, int, int] = 2, 3, 4   # cells from a cell of a line to road on both of its sides: lines are up to 0.3 m wide
    cells_inside: int = 8   # cells beside a limit that show it, inside: an edge line covers four of them at most, and
    cells_outside: int = 6   # outside
    max_ground_height: float = 0.25   # m above or below the road, of ground beside it
    min_ground_share: float = 0.66   # of the measured cells beyond a limit that are ground: those of a wall or a parked car stand higher,
    min_ground_seen: float = 0.34   # and nothing is measured behind them: least share of measured cells, of that of road: over two of six
    own_rows: int = 1   # rows either side in which that ground is measured too, and
    min_measured_share: float = 0.3   # least share of cells, of that of road
    shown_cost: float = 2.0   # by costs of this sum outside and its negative inside: as much as two sure cells
    limit_shift_cost: float = 5.0   # that a change of the limit by a cell, and
    largest_limit_shift_cost: float = 60.0   # any change must save
    # lines of the pavement
    agreeing_length: float = 7.0   # m of road of which most must show the edge
    min_pavement_length: float = 10.0   # m of a line and of the curb beside it: rows are averages of 7 m, so what is shorter is a single observation
    smoothing_length: float = 2.0   # m along the road over which a line through the rows is smoothed: they are averages of 7 m already
    row_share: float = 0.5   # of one sigma of a single row, that a line through rows is off by: neighbours are off together
    max_row_jump: float = 0.5   # m across from one row to the next at which a line ends: a street joins
    max_line_miss: float = 0.2   # m, of single rows from one even bend through both sides of a gap that is longer than `max_gap`
    min_likely_share: float = 0.5   # of a gap in which the edge is rather there than not, for the line to go on as measured
    # points and obstacles
    min_obstacle_height: float = 0.25   # m above the road, from: curbs and stray points are lower, and
    max_obstacle_height: float = 2.0   # m, to: signs and branches are higher
    obstacle_square: float = 0.20   # m, side of the squares in which obstacles are counted
    rows_beside: int = 4   # rows of cells beyond a stretch that tell of its points, and of what stands within two squares beside it
    min_obstacle_share: float = 1 / 3   # of the points in a square and the eight around it
    # outline
    min_surface_status_length: float = 5.0   # m: shorter changes of status are not drawn


@table
class BOUNDARY:
    """How two methods are compared."""

    # shares of the work
    lattice_progress: float = 0.1   # share of the work at which the scan lattice is known, and
    returns_progress: float = 0.85   # share at which the search for curb returns begins
    curb_edges_progress: float = 0.1   # share of the edges that those at curbs are; the others need the ground beside the road
    # comparison
    comparison_step: float = 0.5   # m along the road between places that are compared
    min_reported_difference: float = 0.05   # m across above which a stretch is reported
    agreement_quantile: float = 0.95   # quantile of the distances that stands for a piece
    min_reported_length: float = 1.0   # m of a stretch that is reported
