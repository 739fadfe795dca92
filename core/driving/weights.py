"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common.setting import table


@table
class ALIGNMENT:
    """The alignment that lanes have in common, their courses and curves."""

    max_parallel_deviation: float = 0.06   # m: 95 % of a lane's places are nearer than this to a parallel of the others
    min_shared_lane_length: float = 10.0   # m that a lane must share with others to be compared
    division_spacing: float = 1.0   # m between places that are divided: fitted lines err alike over metres
    min_status_length: float = 5.0   # m: a shorter change of status is not worth a piece
    min_element_share: float = 0.9   # share of a piece that one element must cover to give it its name
    arc_blend_length: float = 5.0   # m at its ends over which an arc passes into what comes before and after
    max_shared_arc_rmse: float = 0.02   # m: RMSE below which a lane is taken to be the arc it shares with its neighbours
    fitted_together: int = 8   # curves of a task at most: one takes some 20 ms
    min_places_per_fit: int = 8   # grid stations of a lane that a curve is fitted to
    max_curve_radius: float = 5000.0   # m: flatter arcs are straights to any driver
    min_turn: float = np.radians(1.0)   # of an arc that is a curve
    max_turn: float = np.pi * 0.95   # the tangents of a half circle do not meet


@table
class SIGMA:
    """How uncertain the place of a driving line is."""

    border_share: float = 0.13   # of the RMS distance of a border's paint from its curve, that the border is off by
    usual_scatter: float = 0.010   # m, of paint about its curve, where no border says it
    # m, of a painted border, however many points show it; fitted on nine simulated surveys and scenes: lines of a street are within one or two
    # sigma in 73 and 85 % on average there, and so they are on nine others; two of these streets are off by 3 and 5 cm throughout
    border_sigma: float = 0.005
    spacing_share: float = 0.028   # of the spacing of the points, that a painted border is off by
    usual_spacing: float = 0.03   # m, where there are no points to say it
    gap_share: float = 0.003   # m per m to the next place where a border is painted, or, without borders, where the lane is measured
    hatching_sigma: float = 0.03   # m, of a hatched area's border: outlines are of image cells, and its line's breadth is not known
    between_borders: float = 0.5   # of the error of a border, that the middle of a lane is off by
    own_border: float = 0.75   # the same of the one border that is painted where two lanes lie between both
    far_border: float = 0.25   # and of the other one
    max_gap_distance: float = 50.0   # m, beyond which a painted place says nothing
    misfit_window: float = 2.5   # m along the lane, over which its places are averaged
    misfit_share: float = 0.8   # of the RMS of what they lie beside the line over
    misfit_reach: float = 5.0   # m either way: where the line passes what was measured, which of the two is off is open, and so is how far beyond
    arc_reach: float = 3.9   # m, either way, over which the line is as good as an arc
    curvature_sigma: float = 1.0   # m, of the Gaussian that smooths heading and curvature
    curvature_window: float = 10.0   # m along the lane, of the RMS of the change of curvature


@table
class HEIGHTS:
    """Heights of driving lines."""

    height_reach: float = 0.3   # m either side of the driving line
    min_points_per_height: int = 3   # points within reach
    dense_slice: float = 0.05   # m before and after a place: with so many points there, no others are looked at
    dense_count: int = 200   # points
    height_smoothing_sigma: float = 2.0   # m: a car does not follow a pothole


@table
class AREAS:
    """Shoulders and connectors."""

    least_shoulder: float = 1.0   # m, median: what is narrower is the marginal strip of the carriageway (0.5 to 0.75 m, RAA)
    shortest_shoulder: float = 10.0   # m
    next_lane_gap: float = 3.0   # m between the end of a lane and the beginning of what follows it
    longest_connector: float = 150.0   # m between the end of a lane and the beginning of the one that the vehicle drove on to
    connector_confidence: float = 0.5   # where the way is known from the drive alone
    driven_on: float = 2.0   # s between two passes of one drive at most: it went on without a stop between them


@dataclass(frozen=True)
class _TrackWeights:
    """Lanes followed along the road: first how stretches become one lane."""

    max_lane_jump_share: float = 0.35   # share of a lane's width by which it may jump from one stretch to the next
    gap_neighbourhood: float = 10.0   # m around a gap within which other lanes tell of a split or merge
    near_doubt: float = 20.0   # m between two stretches in doubt that are one: what neighbouring metres show is not independent
    bridged_trust: float = 0.7   # share of the probability at both ends of a gap that is left between them
    # shares of what is right at both ends of a gap that is right between them, and of what is right at its end that is so beyond all paint: set by
    # what lanes of simulated streets show, not fitted on streets kept aside
    trust_bridged: float = 0.95
    trust_beyond_paint: float = 0.8
    least_probability_of_end: tuple[float, float] = 0.3, 0.8   # of a lane at its end, between two borders and beside one: else it is mostly wrong
    end_width_length: float = 10.0   # m over which a lane's width at its end is taken
    least_jump: float = 0.02   # m across from which a border that goes on as another line is led over
    jump_lead: float = 30.0   # m along for each m across: at 1 in 20 at its steepest, a lane can be followed without braking
    longest_lead: float = 20.0   # m along, at most
    most_oblique_border: float = 0.3   # m across for each m along: no border is painted or built more oblique, not even at a bus bay
    # Lanes followed from interval to interval.
    # m, one sigma of the place of a lane between lines that are seen, and of others; and m along the lane over which it is off by as much, where
    # nothing is painted between two lanes, and of others: fitted on four simulated streets, checked on others
    place_sigma: tuple[float, float] = 0.002, 0.2
    place_reach: tuple[float, float] = 100.0, 2.0
    # Lanes that open or close beside another one.
    longest_taper: float = 100.0   # m
    full_share: float = 0.9   # of a lane's width: from there on it is taken to have its full width
    least_widening: float = 0.05   # m: less is how lines are painted
    border_before_lane: float = 30.0   # m by which the line between two lanes may begin before the new one has 2 m: these at one in ten, and a gap
    missing_share: float = 0.25   # of a lane's width by which two lanes beside each other may be apart or overlap


TRACKS = _TrackWeights()
