"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass

from ..common.setting import table


@dataclass(frozen=True)
class _AsphaltWeights:
    """The intensity of asphalt by scanner and distance, and its correction."""

    vehicle_tick: float = 5e-4   # s between the times at which the vehicle's position is tabulated: 1 cm of driving
    pass_margin: float = 1.0   # s before and after a pass in which its points may still have been measured
    distance_bin: float = 0.5   # m
    max_distance: float = 30.0   # m; farther road counts with the last bin
    min_asphalt_points: int = 200   # points of a bin, below which its asphalt is unknown
    max_joined_bins: int = 10   # 5 m of neighbouring bins with fewer points are taken together
    mixed_bin_spread: float = 1.5   # times the spread of its neighbours: a bin of paint and asphalt, left out
    mixed_bin_neighbours: int = 4   # bins either side that a bin is compared with
    paint_sigmas: float = 3.0   # lower spreads above the median of asphalt: what is brighter is taken for paint
    dark_sigmas: float = 4.0   # standard deviations below the median of asphalt: what is darker is something else
    cleaning_rounds: int = 4   # of taking the median and leaving out paint and what is dark
    points_at_once: int = 1 << 15   # points corrected or counted at a time: what fits the processor's cache
    max_share_at_highest: float = 0.05   # share of points at their scanner's highest intensity: more than paint covers of most roads
    enough_points_per_metre: int = 6_000   # of road: more do not improve the estimate of asphalt
    sample_stripe_length: int = 100   # units of 0.1 mm along the road: of denser roads, stripes of this length are sampled
    max_share_without_vehicle: float = 0.2   # of the points, whose vehicle position is unknown: beyond it nothing is corrected
    # When a scanner is noisy.
    noisy_scatter: float = 0.40   # of asphalt's level: single points that scatter more are averaged (multi-beam scanners)
    scatter_square: float = 1.0   # m
    scatter_step: int = 4   # one of so many squares along the road is looked at
    # Whether brightness is that of photographs: near a logistic regression over half of some simulated streets, of which the other half were judged.
    # Neighbours differed in photographs by 0.3 to 1.8 of their variance, under scanners by 1.05 to 2.2, on two real streets by 1.57 and 1.67
    photographed: float = 1.30
    neighbour_nats: float = 10.0   # for each time the variance
    place_nats: float = 5.5   # for each time e that levels scatter more about those of a distance than about those of a place (of squares of scatter)
    usual_level: float = 0.10   # of logarithms of the level of asphalt: scatter that both have anyway
    usual_squares: int = 30   # seen twice, of which the evidence counts half
    doubtful_photographs: float = 2.0   # nats against, within which it is said that brightness may be that of photographs
    pixels: tuple[int, int] = 400, 800   # units of 0.1 mm: points in one such square are neighbours, in the larger where few share the smaller
    min_square_points: int = 30   # points of one scanner
    min_neighbours: int = 5   # pairs of neighbours in a square
    min_scanner_points: int = 500   # in squares, below which the scatter of a scanner is unknown


ASPHALT = _AsphaltWeights()


@table
class BEAMS:
    """The beams of spinning scanners."""

    lowest_elevation: float = -45.0   # degrees; elevations of road reach from here to 0
    elevation_bin: float = 0.05   # degrees
    min_sharpness: float = 1.5   # times as full as the mean of a degree around them: bins that are rings of beams
    unequal_beams: float = 0.05   # of asphalt's level: beams that differ less from their neighbours are alike
    neighbour_beams: int = 3   # beams either side
    sample_windows: int = 12   # windows of each road that are searched for beams; their length, m
    sample_window: float = 5.0   # windows of each road that are searched for beams; their length, m
    max_sample_points: int = 8_000   # points of one scanner in a window that are examined
    max_turn_time: float = 1.0   # s, the longest turn of a spinning scanner


@table
class IMAGE:
    """The intensity image."""

    distance_offset: float = 1e-3   # m added to a distance, so that a point on a cell's centre has a finite weight
    distances_at_once: int = 1 << 19   # distances computed at a time: what fits the processor's cache
    radius_rounding: float = 2e-6   # of the weight at the radius: a point exactly on it counts, whatever the rounding
    ranking_window: float = 20.0   # m of station over which intensities are ranked for the brightness rule
    pieces_per_window: int = 4   # pieces of a window, each interpolated at once: 5 m of road
    looked_windows: int = 8   # windows of 20 m that a worker process looks at together: a tenth of a second of its time
    tiles_per_task: int = 12   # tiles of 20 m that a worker process is given together: what lies beside them is interpolated again for others
    far_points_per_cell: int = 3   # with twice as many, an evenly spread share of the points weighs on cells farther than the next
    width_sample_step: int = 16   # the width of a piece is taken from every 16th point
    max_ranked_points: int = 50_000   # points of a piece whose intensities are ranked; of twice as many an evenly spread share
    state_margin: float = 1.0   # m, more than the sagitta of a bend between two stations as far apart, and than a point reaches
    min_shown_share: float = 0.5   # of the sample_road_points points: must lie on a pixel with a value
