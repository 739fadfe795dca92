"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.setting import table


@dataclass(frozen=True)
class _TrackWeights:
    """Tracks of the scan: how far apart points of one marking may lie."""

    track_width: float = 0.03   # m that points may lie farther apart than the middles of their tracks
    min_track_gap: float = 0.10   # m: points so near across the road are of one marking in any case
    max_gap_on_track: float = 0.40   # m along the road between points on one track
    along_reach: int = 6   # cells of 4 cm along the road, either way: points so near are on the same track
    across_reach: int = 2   # cells across it, either way: a track wavers by so much
    max_track_gap: float = 0.50   # m across the road: more between points is no spacing but a shadow


TRACKS = _TrackWeights()


@dataclass(frozen=True)
class _AsphaltWeights:
    """The level of asphalt, bright patches and dark ground in it."""

    background_limit: float = 2.5   # spreads: brighter cells, and those darker by twice as much, are no background
    background_squares: int = 11   # squares of 20 cm: the background is the mean of 2.2 m around each
    patch_side: int = 25   # cells of 4 cm: 1 m, the smallest patch
    patch_neighbourhood: int = 7   # cells: a spot is bright where most of the 28 cm around it are
    patch_rim: int = 3   # cells: the irregular rim of a patch
    dark_share: float = 0.5   # of the usual brightness: what is darker is water or tar, and no asphalt to compare paint with
    dark_rim: int = 2   # cells about it whose brightness is interpolated between both
    letters_separation: float = 0.8   # of the variance, between paint and asphalt among letters; of even ground it is two thirds to three quarters
    most_of_letters: float = 0.65   # of a piece that strokes cover at most: a bright slab has a dark rim, too
    letters_asphalt: float = 1 / 3   # of the darker cells among letters that are no brighter than the asphalt of the road
    patch_tail: float = 3.0   # of its own spreads: how far the brightest cells of a patch lie above its median
    # limits of the threshold in spreads above the median of asphalt; the lowest where no bin shows paint, and on averages of noisy points
    lowest: float = 3.0
    highest: float = 8.0
    evidence: float = 120.0   # spreads, summed over the cells of a piece: noise of asphalt reaches it once or twice on 1,000 m2
    close: float = 0.20   # m, gaps along the road that are closed
    min_bin_width: float = 0.75   # m
    max_bin_width: float = 3.0   # m
    min_bin_cells: int = 500   # below which a bin joins its neighbour
    min_asphalt_share: float = 0.25   # of a bin that asphalt covers at least, among letters too: with less it is brighter ground that fills it
    paint_level: float = 2.0   # times the usual brightness of asphalt: a bin whose median is beyond that is one of paint
    histogram_limits: tuple[float, float] = -6.0, 60.0   # z: the range of Otsu's histogram; a few specular reflections must not stretch it
    rim_width: float = 0.60   # m from the rim of the road: gutters; asphalt is taken from the cells inside
    local_square: int = 25   # cells: the scatter about a spot is taken in squares of 1 m
    local_squares: int = 5   # squares in each direction: their median is the scatter of the one in the middle
    min_local_cells: int = 200   # of a square whose scatter is known


ASPHALT = _AsphaltWeights()


@table
class GROUPS:
    """Which points belong together."""

    road_edge_clearance: float = 0.10   # m: strips so near to the road edge are taken for verge
    reach_along_factor: float = 2.5   # neighbours may be this times the distance apart along the road,
    reach_across_divisor: float = 2.0   # and across it the distance over this, or the reach between tracks of the scan


@table
class COMPOUNDS:
    """Markings that touch: strips along the road, and bars with the lines that end at them."""

    strip_windows: tuple[tuple[float, float], tuple[float, float]] = (8.0, 8.0), (4.0, 5.0)   # m that a line is looked for in, and its least length
    line_share: float = 0.85   # of the window that is painted, gaps between scan lines closed
    max_border_slope: float = 0.20   # to the road: the borders of hatched areas lie oblique by one in five at most
    max_border_drift: float = 0.16   # m that a line may leave the nearest slope that is tried, over the window
    compound_length: float = 9.0   # m: no arrow or letter is so long; a line that is broader somewhere,
    compound_breadth: float = 0.5   # m, has something beside it
    min_run_across: float = 2.0   # m across the road that a bar does not break off; no arrow or letter is as broad
    min_leftover_area: float = 0.05   # m2: smaller left-overs are the ragged rim of the strip
    width_step: int = 12   # cells along a line whose width is taken together
    width_tolerance: int = 2   # cells across by which it may be uneven
    max_width_alone: float = 0.34   # m of an even strip with nothing beside it; a double line is broader
    min_length_beside_bar: float = 1.0   # m along the road: what is shorter is nothing but a bar
    ragged_rim: float = 0.12   # m that a bar may reach farther along the road at a place; the tip of an arrow is longer
    max_paint_gap: float = 0.24   # m across the road, closed; the stripes of a zebra crossing leave more
    max_scan_gap: float = 0.40   # m between scan lines, closed
    min_stop_line_piece: float = 0.8   # m across: a row of shorter blocks is a give-way line
    # Pieces of one marking that wear has parted.
    max_worn_gap: float = 0.9   # m along the road
    max_fragment_overlap: float = 0.2   # m along it
    max_fragment_offset: float = 0.08   # m across it
    tracks_per_gap: float = 10.0   # times the distance between the tracks of the scan, along,
    max_gap_between_tracks: float = 2.0   # and m at most: gaps of dashes are longer
    min_oblique: float = 0.05   # m across per m along: a track that crosses a line so leaves it sideways
    max_unseen_gap: float = 3.5   # m along: gaps of dashes that are seen so far off are longer
    max_unseen_offset: float = 0.08   # m between the middles of two pieces with such a gap between them
    max_stop_line_gap: float = 0.30   # m across: the gaps of give-way lines are painted
    max_side_shift: float = 0.10   # m by which wear has moved an edge that two pieces share


@table
class SHAPES:
    """What a cluster looks like."""

    middle_line_step_units: int = 5000   # units: 0.5 m of station that the run of a line is followed in
    tracks_per_step: float = 10.0   # times the distance between the tracks of the scan that the step is at least
    width_percent: float = 95.0   # % of the points that the width spans; divided out again
    max_angle_along: float = np.radians(20.0)   # closer to the road's direction than this is "along" it
    min_angle_across: float = np.radians(60.0)   # farther from it is "across"
    end_units: int = 10000   # units: 1 m at either end that shows how a track runs there,
    min_end_units: int = 2000   # of which 0.2 m at least
    min_end_points: int = 4   # and so many points are needed
    stem_breadth_cells: int = 9   # cells: a stroke along the road is no broader (0.36 m)
    stem_step_cells: int = 5   # cells: it is looked at every 20 cm
    scan_gaps_of_bars: tuple[int, int] = 10, 6   # cells along the road and across it: gaps between the scan lines on a bar
    small_marking_size: float = 1.2   # m: of what is no longer the strokes lie farther apart, as of a sign
    scan_gaps_of_small: tuple[int, int] = (3, 1)   # cells likewise of these
    # Outlines of markings.
    close_along: float = 0.40   # m of station over which a gap is closed
    close_across: float = 0.04   # m of offset likewise
    min_hole_area: float = 0.02   # m2: smaller holes are wear, not shape
    end_stretch: int = 20000   # 0.1 mm: 2 m at an end, whose gaps tell how far it goes on
    max_end_gap: int = 5000   # 0.1 mm: longer gaps are worn
    strip_tolerance: float = 0.004   # m by which the outline of a strip may leave its middle line's curve
    min_part_area: float = 0.005   # m2: three cells
    outline_tolerance: float = 0.025   # m by which a simplified outline may leave the cells
    outline_vertex_spacing: float = 1.0   # m of station between vertices: 2 mm of sagitta at R = 60 m
    outline_height_neighbours: int = 8   # points that tell the height of a vertex


@table
class ZIGZAG:
    """Zigzag lines (see the standards in `objects/shape.py`)."""

    step_cells: int = 3   # cells along the road whose middle is one place: 12 cm
    zigzag_length: tuple[float, float] = 2.0, 45.0   # m along the road: three legs of the shortest, and "school keep clear"
    zigzag_breadth: tuple[float, float] = 0.25, 2.6   # m across it
    max_stroke: float = 0.50   # m across the road of a leg within a step: a line of 0.12 m at 45 degrees takes up 0.29 m
    min_steps_seen: float = 0.7   # of the steps, for the run to be known: gaps between marks are 150 mm
    min_thin: float = 0.85   # of the steps that were seen, where there is one stroke alone; a bar may end the line
    least_turn: float = 0.15   # m that a line goes back for its turn to count: half the depth of the flattest zigzag
    min_legs: int = 3   # of a zigzag line
    leg_along: tuple[float, float] = 0.7, 2.6   # m along the road of a whole leg
    leg_slope: tuple[float, float] = 0.10, 1.4   # m across per m along
    max_slope_ratio: float = 1.6   # times: one leg to another
    max_length_ratio: float = 1.5   # times, of those between turns
    max_off_straight: float = 0.12   # of a leg's depth that its places lie off it at most, root mean square, or
    least_off_straight: float = 0.05   # m


@table
class STRIPES:
    """Stripes of zebra crossings."""

    stripe_width: tuple[float, float] = (0.25, 0.80)   # m
    stripe_length: tuple[float, float] = (1.5, 10.0)   # m
    min_stripes: int = 3   # of a crossing
    comb_window: float = 5.0   # m either way that a pitch is looked for in; windows overlap by half
    least_spots: int = 30   # cells of paint in a window
    most_spots: int = 200   # looked at in a window; of more an even share
    least_spread: float = 0.4   # m, their standard deviation in the direction where it is least: three stripes spread by more
    comb_pitch: tuple[float, float] = 0.5, 1.6   # m from stripe to stripe
    comb_pitch_step: float = 0.05   # of the pitch, that is tried; then a tenth of it
    comb_heading_step: float = np.radians(5.0)   # of the direction likewise
    min_comb_coherence: float = 0.45   # length of the mean phase: 0.64 for stripes as broad as their gaps, 0 for spots anywhere
    min_share_of_stripe: float = 0.05   # of the spots of a crossing that a stripe has at least
    min_stripe_span: float = 1.2   # m: letters and blocks are shorter
    min_shared_of_stripes: float = 0.6   # of the longer of two stripes side by side that lies beside the other
    comb_step_along: float = 0.4   # m along the stripes that is taken together
    least_phase: float = 0.3   # mean cosine of the phase where there are stripes: a stop line beside them has 0
    min_width_of_pitch: float = 0.3   # of the pitch that a stripe is broad, least: lines with an arrow between them are narrower
    min_of_mean_phase: float = 0.75   # of the mean phase that even stripes of their width have: crossings have 0.86 and more, words about 0.6
    max_width_of_pitch: float = 0.7   # most
    min_of_width: float = 0.5   # of the width of all stripes that one of them has at least
    min_of_usual: float = 0.2   # of the spots that a stripe usually has, and a step along all of them
    min_of_neighbour: float = 0.4   # of the spots of the next stripe that the last one has at least: it may be a curb
    same_heading: float = np.radians(8.0)   # between neighbouring windows on one crossing
    same_pitch: float = 0.08   # of the pitch likewise
    reach_of_crossing: float = 2.5   # m about these windows that the crossing may go on: their other halves show fewer than three stripes
    along_road: float = np.radians(35.0)   # of stripes to the road: those of its own crossings
    max_row_skew: float = np.radians(15.0)   # of stripes in any direction to the square of their row
    max_row_skew_along: float = np.radians(45.0)   # of those along the road
    max_aside: float = 0.2   # of its width that the spots of a stripe lie on one side of its middle
    end_percent: float = 2.0   # % of a stripe's spots beyond either end
    ragged: float = 0.12   # m beside a stripe, whose width and place are estimates, that spots are of it
    max_stray_end: float = 0.6   # m that spots may lie beyond the line of ends to be of a stripe, and that one which ends earlier is shorter
    ends_seen: float = 80.0   # % of the stripes that end on that line or before it: many end where a track of the scan last met their paint
    steps_of_crossing: tuple[float, float, float, float] = 1.0, 1.0, 0.5, 0.1   # of direction and pitch, one after the other, of all stripes
    comb_bin: float = 0.10   # m across the stripes
    most_peaks: int = 2   # of them, the clearest, that are looked at closely: a line beside a crossing may repeat more clearly than its stripes


@table
class FIGURES:
    """Bicycles and words, compared with drawn figures."""

    figure_size: tuple[float, float] = 0.6, 5.0   # m along and across of a figure
    scan_gap: int = 4   # cells along the road between scan lines that are closed; the strokes of a figure lie farther apart
    letter_gap: float = 0.45   # m between parts of one figure at most
    most_parts: int = 12   # of a figure
    thick_cells: int = 9   # cells: strokes of figures are thinner than this, 0.36 m, in one direction at least
    most_thick: float = 0.4   # of the paint may be thicker: bars of words that are 4 m long
    least_of_bicycle: tuple[float, float] = 0.68, 0.64   # agreement of the whole figure, and of the third that agrees least
    least_of_bus: tuple[float, float] = 0.72, 0.66   # the same of the word
    paint_blur: float = 0.8   # cells
    rim: int = 4   # cells about the paint
    figure_height: int = 48   # px of a figure
    figure_margin: int = 8   # px of bare road about it that is compared, too
    figure_blur: float = 2.0   # px, so that strokes need not lie exactly on each other
    closest: int = 3   # of them are looked at closely
    least_at_first: float = 0.20   # correlation of a first pose that is worth a closer look: a figure with a part missing may begin so low
    steps: tuple[float, float, float] = 0.10, 0.05, 0.025   # of its size that a figure is moved and stretched by, and radians that it is turned by


@table
class STRANDS:
    """Stretches of one painted line without a gap, and the edges of the road beside them."""

    run_bin_units: int = 5000   # units of 0.1 mm: 0.5 m of station in which runs of paint are separated
    place_step_units: int = 2500   # 0.25 m: one place of the line each, so that neighbouring places are nearly independent
    run_gap_units: int = 600   # 6 cm across without paint separate two runs ...
    max_worn_line_width_units: int = 3300   # ... unless together they are no wider than one worn line
    gap_bins: int = 6   # bins before and after a gap: where it is seen in more than half of all these, two lines run side by side
    gap_drift_units: int = 100   # units across that it may move per bin: as lines drift against the road
    max_line_width_units: int = 3600   # 36 cm: wider is no line
    max_mixed_width_units: int = 6000   # 60 cm: where a mixed marking reaches farther across, it is hatching or a stop line there
    min_mixed_strand: float = 2.0   # m of paint in a strand of a mixed marking
    min_mixed_marking: float = 9.0   # m: no arrow or letter is this long; a longer mixed marking has a line in it
    min_points_per_run: int = 3   # points in a run
    min_strand_length: float = 0.8   # m of paint in a strand
    max_bin_step: int = 3   # bins that a strand may leap: 1.5 m of wear
    lateral_step_units: int = 600   # units: 6 cm that a strand may move across,
    lateral_step_per_bin_units: int = 400   # and 4 cm more per bin
    level_reach: float = 3.0   # m of a line at either side of a gap that say how far it lies from the edge
    few_tracks: float = 0.20   # m across the road between tracks of the scan: of a line, which is 0.10 to 0.30 m broad, one or two meet it
    # Courses of lines, and markings named by them.
    min_points_per_place: int = 3   # points that a place must have to count, where there are enough such places
    min_guided_gap: float = 4.0   # m: in a longer gap the curve is guided parallel to the other lines
    guide_spacing: float = 2.0   # m between guiding places
    kept_distance: float = 0.1   # m within which a line keeps its distance from what it runs along
    line_height_smoothing: float = 3.0   # m
    fitted_together: int = 8   # lines of a task at most: one takes some 20 ms
    max_distance_to_line: float = 0.15   # m between a marking and the line along it
    paint_beside_piece: float = 2.0   # m of station before and after a piece whose paint counts for its offset
    # Roughness of paint about fitted lines.


@table
class LINKS:
    """Strands linked along the road."""

    end_window: float = 6.0   # m of a strand's end that say where it goes
    min_paint_beside_gap: float = 3.0   # m that either side of a long gap must have
    max_strand_overlap: float = 0.6   # m that two strands of one line may overlap
    max_miss: float = 0.30   # m across that two lines may miss each other by over the longest gap; half of it where they touch,
    max_long_miss: float = 0.25   # m, and by which over any longer one
    double_line_spacing: tuple[float, float] = (0.19, 0.50)   # m between the middles of the two lines of a double line
    twin_reach: float = 2.0   # m before and after a place at which the other line of a double line is looked for
    middle_share: tuple[float, float] = (0.25, 0.75)   # of the way from one line of a double to the other: its middle
    cost_without_link: float = 2.01   # the worst possible link costs 1 for its mismatch and 1 for its gap


@table
class TREND:
    """How all painted lines of a road change their offset together."""

    trend_step: float = 0.5   # m, nodes of the drift
    slope_window: float = 5.0   # m that slopes are averaged over
    gentle_taper: float = 0.05   # m across for each m along: a line as oblique as that to the others counts half (tapers are 1 in 20 and steeper)
    max_line_slope: float = np.tan(np.radians(10.0))   # across per along by which two strands may differ
    # Paint between two tracks of the scan.
    step: float = 0.25   # m along a line, over which it is asked what lies on its course and beside it
    step_reach: float = 0.12   # m before and after a step whose points count for it: those of a track lie so near
    beside_gap: float = 10.0   # m before and after a gap, whose paint tells how bright the line is, and on what tracks it was seen
    on_line: float = 0.15   # m across between a marking and the course of the line that it is of
    min_seen_length: float = 4.0   # m of a marking: over so much a track that crosses the line obliquely shows most of its width
    min_free_share: float = 0.6   # of the width of a line: it has no room where tracks on asphalt lie nearer to each other
    core_share: float = 0.25   # of the width of a line, from its middle: where asphalt lies so near, the course is not just off by a little
    max_bare_share: float = 0.35   # of a gap in which the course is asphalt: wear leaves so much, and with more the line is not there
    shortest_unseen: float = 0.5   # m: less is nothing to draw


@table
class SELECTION:
    """Which linked paint is a line."""

    min_shared_paint: float = 0.6   # of a line's paint that must have its twin beside it in a double line
    min_twin_paint: float = 4.0   # m of paint: a shorter line beside another is its ragged edge, however short the other is there
    max_ragged_share: float = 0.35   # of a line's length: less paint beside a line than this is no second line but its ragged edge
    max_neighbour_offset: float = 8.0   # m across: a line this near starts and ends where this one does
    max_bar_end_offset: float = 0.35   # m between the end of a bar and the outline
    # Solid or dashed.
    max_worn_hole: float = 0.8   # m: a shorter hole is wear within a dash
    min_gap_per_dash: float = 0.4   # of the dash length: road markings leave gaps of half a dash (6 m and 3 m) or more
    dash_pair_length: tuple[float, float] = (1.5, 8.0)   # m: dashes of which two alone are taken for a dashed line
    period_tolerance: float = 0.16   # of the period: how evenly dashes must follow each other
    equal_dashes: float = 0.2   # m by which all dashes of a line differ at most, where they do not follow each other evenly
    step_tolerance: float = 0.2   # m by which the two steps between three pieces of unequal lengths may differ
    min_short_dashes: int = 4   # dashes of about a metre with gaps as long must be so many
    short_dash_tolerance: float = 0.25   # m: of such dashes, deviation of the length from the median
    max_uneven_share: float = 0.25   # of such dashes: those that deviate more
    max_solid_gap: float = 2.5   # m: a longer hole in a solid line is bridged, not measured


@table
class SECTIONS:
    """Lines as offsets at common stations."""

    max_line_obliquity: float = np.tan(np.radians(25.0))   # a line that runs more across the road than this bounds no lane
    closed_island: float = 1.0   # m between the ends of a line round an island that closes
    min_boundary_spacing: float = 0.8   # m: lines nearer than this are one boundary, a lane ends at the nearer one
    max_line_jump: float = 0.3   # m across by which a line may jump where it goes on as another
    max_dash_gap: float = 9.5   # m that a dashed line may be silent at its ends before it is known to end


@table
class EVIDENCE:
    """The drive, other carriageways and stop lines as evidence of lanes."""

    carriageway_distance: float = 40.0   # m between the tracks on two carriageways of one road at most
    along: float = 0.3   # m across per m along, up to which a pass of another road was driven along this one
    own_road: float = 6.0   # m: what runs nearer is on this road
    median: float = 1.2   # m without asphalt that part two carriageways: 4 feet, the least width of a median (AASHTO Green Book 4.11)
    pass_spacing: int = 20   # stations, between the places of a pass at most
    sections_alike: int = 3   # sections of points whose median spacing is taken: one in which the road begins or ends holds fewer points
    stop_reach: float = 5.0   # m before and after a stop line where its lanes are still its lanes
    approach: float = 40.0   # m before a stop line, over which lines between its lanes may be solid although they are dashes elsewhere
    # Hatched areas and their borders.
    bar_reach: float = 1.6   # m: bars of one hatched area are at most twice as far apart
    outline_spacing: float = 0.25   # m between places of an outline
    half_border: float = 0.06   # m from the outside of its border line to the middle: half of a narrow line
    shortest_area: float = 5.0   # m
    border_line_reach: float = 0.5   # m between the ends of bars and the middle of the border line that they lead to: gap, and half of a broad line


@table
class ROADS:
    """What all roads of a survey have in common."""

    shortest_bare: float = 20.0   # m driven between two borders beyond all paint: less is where paint or survey just ends
    length_of_usual: float = 50.0   # m of lanes that weigh as much as what is usual in the country
    sure_side: float = 1.4   # nats by which one side of traffic must be more probable than the other to be sure: else it is wrong one time in five
    # Arrows on the road.
    worn_ends: float = 0.1   # m that an arrow may look shorter than it was painted
    shaft_breadth: float = 0.36   # m, of a single stroke at most: shafts have 0.10 to 0.20 m, and a cell more on either side; heads begin at 0.5 m
    pointed: float = 0.03   # of the length: the tip gets broad in a longer way than the end of a letter, which is as broad as the letter
    sure_lean: float = 0.15   # of the length by which the shaft is longer than the tip where it is sure which is which; painted arrows: 0.15 to 0.5


@table
class NOISY:
    """Paint where single points are noisy: first their averages.

    The nats are rounded from a logistic regression of what bright pieces measure on a real street with paint and one without, judged by eye, and
    were adjusted on the same two streets; no street was kept aside.
    """

    spot_sigma: float = 1.25   # cells, of the average in which pieces are searched
    ground_sigma: float = 10.0   # cells, of the average it is compared with: wheel tracks, patches and shadows are wider than paint
    min_density: float = 0.05   # points per cell, averaged so, below which nothing is known
    ground_contrast: float = 2.0   # spreads: darker cells are no ground, and none beyond the threshold, which may be paint
    slope_sigma: float = 3.0   # cells, of the averaged heights whose slopes are compared
    ground_slope_sigma: float = 12.0   # with those of heights averaged so
    # Bright pieces in these averages.
    bright: float = 0.6   # of the threshold, that a cell of a stroke has at least
    faint: float = 0.3   # likewise of a dash or a faint line
    half_maximum: float = 0.5   # of the maximum contrast nearby: the rim of paint in a blurred image
    half_maximum_reach: int = 7   # cells: where the maximum is taken
    least_area: float = 0.03   # m2
    usual_percentile: int = 75   # % of a piece's cells: its contrast
    top_percentile: int = 90   # % of them: its brightness
    dashes: float = 1 / 3   # of the cells of a stroke: where dashes of a row are more, it is no stroke but these
    fading_ring: tuple[float, int] = 1.5, 3   # cells from a piece: where its fading is measured
    view_ring: tuple[int, int] = 3, 8   # cells from a piece: asphalt that it is compared with in each view
    view_length: float = 0.5   # m of the vehicle's way: points measured from farther apart are different views
    # Nats by which such a piece is more likely paint than noise, which is dim, short and seldom seen so often.
    noise: float = 2.5   # of any piece, against paint
    brightness: float = 4.2   # per threshold that it is brighter than that; twice the threshold counts at most
    seen_often: float = 0.45   # per standard error by which all views together saw it brighter than its surroundings,
    usual_sigmas: float = 8.0   # beyond so many; twice as many count at most
    per_length: float = 2.0   # per m of length,
    usual_length: float = 0.6   # beyond so many m,
    most_length: float = 3.0   # of which so many count at most
    # Than a spot, such as a cover, which is round and short.
    per_elongation: float = 1.5   # per length over width,
    elongation_of_spots: float = 3.5   # beyond so much; length counts as above
    round: float = -1.5   # at least: blocks are round, too
    next_spot: float = 3.5   # for each dash of a row after the second: one in 30 such places has a bright spot
    # Than the face of a curb, which is steep and lies at the rim.
    flat: float = 3.0   # of flat pieces away from the rim
    per_slope: float = 100.0   # per m per m against the ground around
    at_rim: float = 5.0   # at the very rim of the road,
    rim_reach: float = 0.15   # m from it in which that falls to a third
    # Than a patch, which is dim and broad and fades out; brightness counts as above.
    sharp: float = 4.0   # of narrow pieces with a sharp rim
    per_fading: float = 10.0   # times the share of the contrast that is left just beside it
    per_width: float = 20.0   # per m where it is thickest,
    usual_width: float = 0.40   # beyond so many m; stop lines have 0.50 m, of which the rim is dim
    # Than glare, which is bright from one place only: a nat for each standard error,
    sigmas_of_glare: float = 3.0   # beyond so many.
    # Than what shines beneath a parked car.
    uncovered: float = 3.0   # of pieces that nothing covers
    per_cover: float = 9.0   # times the share of points beneath an object


@table
class PHOTOGRAPHS:
    """Paint where brightness comes from photographs: the level of the ground, its scatter, and which bright pieces are other ground.

    The nats lie near logistic regressions over pieces, by what is found and invented on four simulated streets in the brightness of photographs with
    shadows of trees, houses and cars, seams, crossfall of light, displaced images and the colour of cars beside them; others were kept aside.
    """

    median_cells: int = 3   # of the median that evens single cells out before the level is taken
    joint_cells: int = 5   # 20 cm, the diameter of the disc that joints and bands of tar have no room for
    level_cells: int = 23   # 0.92 m, the diameter of the disc that bright ground has room for and paint has not
    line_cells: int = 9   # 36 cm, the diameter of the disc that no line has room for (at most 30.5 cm, countries.json), and stripes of 50 cm have
    half_maximum_cells: int = 7   # 28 cm in which the brightest cell is looked for
    # two pairs of quantiles of a normal distribution, each with its standard deviations below the median: the first stays asphalt where paint covers
    # two thirds of a square, the second where dark joints and rails cover a fourth
    quantiles: tuple[tuple[float, float], ...] = (0.10, 1.2816), (0.30, 0.5244), (0.25, 0.6745), (0.45, 0.1257)
    painted_square: float = 1.5   # times the scatter of its darker half that its middle scatters: a square with much paint
    least_scatter: float = 0.01   # of the brightness of asphalt, where values are coarse
    beside: tuple[int, int] = 3, 1   # cells from a piece: what lies beside it, less what the image blurs
    most_fading: float = 0.6   # of the brightness of a piece that counts as left beside it
    rim_cells: float = 2.0   # standard deviation over which the rim of a piece is evened out, as single cells of it are bright by chance
    most_elongated: float = 3.0   # of the logarithm of length over breadth that counts: curbs along the rim are as long as lines
    sun_squares: float = 8.0   # squares of 20 cm: standard deviation of the mean that tells how bright asphalt in the sun is nearby
    two_levels: float = 0.72   # of the variance, between shade and sun: of one level that scatters it is two thirds
    paint_step: float = 0.5   # of logarithms of brightness from asphalt to paint, to which that of the survey is drawn
    usual_cells: int = 600   # by so many cells: 1 m2
    rim_reach: float = 0.15   # m from the rim of the road in which its effect falls to a third
    # of the share of its brightness left beside a piece, and of its contrast with its darker side left on the other; of the logarithm of length over
    # breadth, by its rim; of nearness of the rim of the road; of how much brighter the sun nearby is, as most flecks of it in the shade are dimmer;
    # of nearness to paint and not to asphalt. Without any of them a piece may be either
    nats: tuple[float, ...] = -3.0, -2.0, 1.0, -7.0, -4.5, 4.4


@table
class RIMS:
    """What is bright at the rims of roads and no paint: first concrete gutters, and what is left of worn lines."""

    worn_gap: float = 0.80   # m along the road: no painted gap is shorter, so bright specks in it belong to one worn line
    band_cells: int = 2   # bands of 8 cm inwards from the rim
    gutter_bands: int = 9   # 0.72 m: no gutter is wider
    coarse_cells: int = 5   # shares and levels are taken in squares of 20 cm
    rim_reach: float = 2.5   # m of rim either way along which a gutter must be bright
    min_bright_share: float = 0.65   # of the cells of a band
    min_cells_seen: int = 20   # of a band along `rim_reach` either way
    gutter_brightness: float = 1.5   # spreads above asphalt
    # Nats by which a strip along the rim is more likely a gutter than a line.
    per_gutter_width: float = 25.0   # for each metre that it is broader than a line there: widths are known to 4 cm,
    line_at_rim: float = 0.18   # m, a broad one
    per_paleness: float = 4.0   # for paint that is all of the brightness above asphalt brighter; worn lines lack a quarter of it
    gutter: float = 1.0   # against one: what is as broad as a line and as bright is a line
    road_gap_along: int = 15   # cells: smaller gaps between points belong to the road
    # Rims of what is bright and broad.
    beside: tuple[int, int] = 5, 2   # cells from a piece: what lies beside it, less what the image blurs
    sides: tuple[float, float] = 0.25, 0.75   # shares of these cells that are no brighter than its dark side and its bright side
    # of the brightness of a piece above asphalt, that of its bright side: with less all of its evidence counts, with more none. On simulated streets
    # worn edge lines had 0.45 at most, rims of repairs 0.54 and more
    brighter_side: tuple[float, float] = 0.4, 0.5
    # Bright things that stand above the asphalt.
    plane_squares: int = 9   # squares, either way, that a plane is fitted to: 1.8 m
    min_plane_squares: int = 12   # of them with asphalt, for the plane to be known
    least_rise: float = 0.02   # m above it: dropped curbs stand 3 cm high, thick paint lies 6 mm above the road
    rise_sigmas: float = 5.0   # standard deviations of the squares of asphalt off their planes that a rise is at least
    min_squares_of_spread: int = 30   # squares of asphalt in a window that tell how far they lie off their planes


@table
class CLASSES:
    """What kind of marking a cluster is. First its contrast: seams, joints of bridges and gutters of islands are far paler than paint beside them."""

    contrast_stretch: float = 100.0   # m of road, with as much before and after it, whose paint is compared
    faint_percentile: int = 2   # % of the bright points there: the faintest,
    bright_percentile: int = 90   # and paint
    contrast_percentile: int = 75   # % of a marking's points, whose brightness stands for it
    min_contrast: float = 0.20   # of the way from the faintest to paint: what has less is no paint
    min_contrast_of_bars: float = 0.30   # the same of a bar across the road, which is often a joint
    min_contrast_of_edge_lines: float = 0.10   # the same of a line where edge lines lie, which wear most and where seams are rare
    # What kind of marking a cluster is.
    lane_clearance: float = 2.0   # m: with less between a line and the road edge there is no lane: it is an edge line
    max_double_line_spacing: float = 0.45   # m between the middles of a double line
    min_solid_length: float = 10.0   # m: longer than any dash in town; solid lines inside the road are centre lines
    short_dash_length: tuple[float, float] = 0.75, 1.5   # m: dashes of cycle lanes and bus bays, which only their row tells from signs and specks
    min_dash_elongation: float = 3.0   # length by width of such dashes
    min_row_of_points: float = 2.0   # m: points in a row of this length are no speck, however few scan lines met it
    stop_line_width: tuple[float, float] = (0.18, 0.90)   # m
    min_stop_line_length: float = 1.5   # m
    min_stop_line_fill: float = 0.62   # of length times width: a stop line is a full bar, the outline of hatching with its bars is not
    max_bar_to_outline: float = 0.3   # m from a bar of hatching to its outline
    max_hatching_pitch: float = 3.0   # m between bars of one hatching
    min_hatching_length: float = 4.0   # m along the road: what is longer is more than one bar
    min_arrow_shaft: float = 0.20   # of an arrow's length: its shaft at least,
    max_arrow_tip: float = 0.25   # and at the other end the tip of its head at most
    # Clusters that are no paint.
    cover_diameter: tuple[float, float] = (0.30, 1.15)   # m, manhole covers
    max_cover_elongation: float = 1.7   # length over width
    min_cover_fill: float = 0.5   # of the square about it
    max_speck_size: float = 0.30   # m
    max_speck_area: float = 0.03   # m2
    min_covered_share: float = 0.8   # of a marking's points beneath or beside something that stands on the road,
    max_car_length: float = 6.0   # m: and no longer than this, it is the foot of a parked car
    curb_corner_clearance: float = 0.30   # m from the road edge: a single bar so near,
    max_curb_corner_length: float = 2.0   # m: and so short, is the curb or gutter of a corner
    rim_clearance: float = 0.60   # m from the road edge where verge, gutter and curb may look like paint
    strip_reach_beyond_edge_line: float = 0.80   # m outside an edge line where strips are taken for verge
    strip_reach_at_road_edge: float = 3.0   # m: as far outside an edge line as this, since no lane fits there
    min_strip_width_at_rim: float = 0.10   # m: at the road edge a narrower strip is the top or the face of a curb
    min_strip_width_on_edge: float = 0.14   # m: likewise where it reaches the edge itself
    edge_contact: float = 0.02   # m between a strip and the road edge: paint keeps more
    edge_line_length_ratio: float = 2.0   # an edge line is so many times as long as the strips outside it


@table
class ROWS:
    """What stands in rows: first dashes."""

    min_dash_spacing: float = 0.25   # m between them at least
    max_dash_breadth: float = 0.45   # m that a dash may reach across its row
    max_dash_offset: float = 0.12   # m off the line through its neighbours
    max_gap_per_dash: float = 3.5   # times the length of the longer dash: no gap of a row is longer (3 ft and 9 ft: MUTCD 3A.06), seen to 20 cm
    max_step_ratio: float = 2.5   # times: how much one step of a row may be longer than the next, a dash worn away between them
    min_step_cosine: float = np.cos(np.radians(12.0))   # by which a row may turn from dash to dash
    min_dashes_in_row: int = 4   # of a row
    # Nats by which pieces are more likely a row of dashes than noise.
    row: float = 3.5   # of a row, against it
    min_lead: float = 0.6   # cosine of its steps to the road, or to the square across it
    next_dash: float = 2.7   # for each dash after the second, where a row leads: noise has a piece in one of 15 such places
    offset_sigma: float = 0.06   # m off the line of the step before
    step_sigma: float = 0.2   # of the step before, by which a step is longer or shorter
    length_sigma: float = 0.4   # of the length of the dash before likewise
    dimmest: float = -3.0   # of a dash, however dim
    worn_dash: float = 1.5   # for a dash worn away: one in five
    # Blocks of give-way lines.
    min_blocks_in_row: int = 3   # of a row
    block_size: tuple[float, float] = 0.30, 0.80   # m, either way
    max_block_ratio: float = 1.35   # times: the longer side of a block to the shorter, and the size of one to the next
    block_spacing: tuple[float, float] = 1.4, 3.2   # block sizes from middle to middle
    max_block_step_ratio: float = 1.25   # times: one step of a row to the next
    max_block_offset: float = 0.15   # m off the line through its neighbours
    max_pace_error: float = 0.10   # of the step of a row: two squares so far apart are two blocks of another such row
    max_end_ratio: float = 1.5   # times: the longer side of a piece that goes on with a row to the usual one of its blocks, either way
    max_end_offset: float = 0.2   # of the step that its middle lies off the place of the next block at most
    least_strip: float = 1.2   # m: three of the smallest blocks
    least_gap: int = 2   # cells between the blocks of a strip
    painted_share: float = 0.25   # of a strip's usual breadth: with less paint across it there is a gap
    row_of_blocks: tuple[float, float] = 0.8, 20.0   # m along the road, where the inside of a bend is shorter than the line itself
    max_row_slope: float = 0.5   # to the road: of a row more oblique the blocks do not touch


@table
class LANES:
    """What may bound lanes, and how they lie between two boundaries."""

    max_interval: int = 4   # cells: longer intervals are divided
    double_spacing: tuple[float, float] = 0.22, 0.6   # m between the two lines of a double line; nearer ones are one line
    weak_twin: float = 0.25   # of the paint of the line beside it: less is a ragged edge, no second line
    ragged_length: float = 6.0   # m of paint at most of such an edge
    usual_lines: float = 0.3   # of the painted length of a road: its lines of usual breadth
    wide_line: float = 1.6   # times the usual breadth: a wide line has twice of it (RMS, MUTCD 3A.04), measured to some 2 cm
    wide_softness: float = 0.1   # times it, by which that is uncertain
    surface_merge: float = 0.8   # m: the surface, or a hatched area, ends at the line or curb that lies this near
    # Lanes in the strip between two boundaries.
    likely_share: tuple[float, float] = 0.8, 1.5   # of the usual width of a lane: lanes in bends
    least_left_over: float = 0.6   # m between two lines beyond a lane beside one of them: less is how widths of lanes scatter
    max_lanes: int = 4   # between two boundaries without paint between them
    hatched_share: float = 0.35   # of a strip that is a hatched area
    asphalt_of_a_lane: tuple[float, float] = 2.2, 3.0   # m of asphalt that could be a lane: between two lines, and elsewhere
    asphalt_softness: float = 0.2   # m by which that is uncertain
    other_sigma: float = 0.8   # m, scatter of lane widths from road to road
    stop_margin: float = 0.5   # m by which a stop line may reach beyond the lanes that it is for
    min_scanned_share: float = 0.6   # of a lane's width that must be seen of a lane beside the end of the surface
    same_divider: int = 1   # places by which the same border between lanes may lie elsewhere


@table
class OUTLIERS:
    """Outliers among the points of paint."""

    window: float = 20.0   # m of station that one limit is taken from
    band: float = 3.0   # m of offset likewise
    min_points_per_band: int = 30   # points of a window whose deviation is still reliable
    sparseness_factor: float = 3.0   # times the distance that is usual among a point's own neighbours
