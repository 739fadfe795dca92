"""The weights of the evidence from which the cross-section of a road is estimated, and the calibration of its probabilities."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

# What a boundary is made of
SOLID, DASHED, DOUBLE, CURB, SURFACE, OPEN, OUTSIDE, HATCHING, ISLAND, PAVEMENT, BARE = range(11)
# What a boundary separates
LANE_LINE, CENTRE_LINE, EDGE_LINE, OTHER_LINE = range(4)
# whether the road has a border there without paint, and whether nothing is seen of what ends there, by what a boundary is made of
UNPAINTED, SURFACE_END = (np.isin(np.arange(BARE + 1), made) for made in ((CURB, ISLAND, PAVEMENT, SURFACE, OPEN, BARE), (SURFACE, OPEN, BARE)))


def _costs(*shares: float) -> tuple[float, ...]:
    return tuple(float(-np.log(share)) for share in shares)


@dataclass(frozen=True)
class EstimateWeights:
    """Costs in nats (-log of a probability); those of what goes on along the road are for `correlation` metres of it.

    The probabilities are shares as road authorities paint and build (the dash and line rules of the catalogue of countries); where those say
    nothing they are our own estimates, rounded. Shares of boundaries are of lane lines, centre lines, edge lines and other lines.
    """

    correlation: float = 20.0   # m of road that count as one observation: what neighbouring metres show is not independent
    laid_out: float = 60.0   # m of road laid out alike: of how sure lanes are they say no more than `correlation` does; chosen with `calibration`
    solid: tuple[float, ...] = _costs(0.1, 0.3, 0.9, 0.15)   # shares that are drawn like that
    dashed: tuple[float, ...] = _costs(0.8, 0.4, 0.1, 0.3)
    double: tuple[float, ...] = _costs(0.05, 0.9, 0.05, 0.05)
    # wide lines part special lanes (bus, exit, cycle) from others of the same direction, or mark the edge, in all countries at hand; directions are
    # parted by a usual line or by two (RMS part A; MUTCD 3B.01 and 3B.04; GB 5768.3; Instruction interministerielle, art. 113)
    wide_solid: tuple[float, ...] = _costs(0.1, 0.01, 0.3, 0.1)
    wide_dashed: tuple[float, ...] = _costs(0.1, 0.01, 0.05, 0.05)
    curb: tuple[float, ...] = _costs(0.001, 0.02, 0.9, 0.7)   # of boundaries that are a curb, also of an island
    surface: tuple[float, ...] = _costs(0.001, 0.001, 0.6, 0.8)   # where the road surface ends without one, seen as an edge or not
    open_end: tuple[float, ...] = (np.inf, np.inf, 2.3, np.inf)   # where nothing is known beyond the outermost line
    # where a lane beside a line ends on bare asphalt, as beside a median, a shoulder or a lane that opens: one such border of ten has no line
    bare: tuple[float, ...] = (np.inf, np.inf, 2.3, np.inf)
    bare_too: float = 0.7   # of the other border of a strip between lanes, one border of which has no line: half of them have none either
    hatching: tuple[float, ...] = _costs(0.01, 0.01, 0.9, 0.5)   # that are the border of a hatched area
    named: float = 3.0   # of a line that separates something else than who drew or confirmed it says
    stroke: float = 3.0   # m of paint that strokes of symbols have too
    long_line: float = 25.0   # m of paint that make a line sure
    lane_through_paint: float = 10.0   # of a seen line inside a lane,
    lane_through_curb: float = 12.0   # of a curb,
    lane_through_hatching: float = 12.0   # of the border of a hatched area,
    lane_through_surface: float = 3.0   # of the end of the surface
    paint_in_rest: float = 6.0   # of a seen line inside a strip where nobody drives
    width_sigma: float = 0.45   # m, scatter of lane widths on one road
    width_sigma_asked: float = 0.25   # m, about the width that the user named
    other_width: float = 0.25   # share of lanes as wide as lanes are elsewhere
    odd_width: float = 0.05   # share of lanes of any other width
    odd_width_asked: float = 0.005   # the same where the user named the width
    widest_odd: float = 8.0   # m, of these
    # lanes beside a curb or edge of the pavement: what is left of the room, m and its scatter, and how often that is so: nothing; a gutter (0.3 to
    # 0.6 m: RASt 06, AASHTO Green Book 4.7); a row of parked cars (2.0 to 2.3 m: RASt 06; 7 to 8 ft: AASHTO); else anything
    left_over_beside: tuple[tuple[float, float, float], ...] = ((0.0, 0.05, 0.6), (0.5, 0.15, 0.2), (2.2, 0.25, 0.1))
    like_lines: float = 0.5   # share of such lanes that are as wide as those between lines, where these show it; fitted on half of 18 streets
    width_sigma_lined: float = 0.15   # m, scatter of the widths of these,
    width_sigma_beside: float = 0.8   # and of others about the usual one
    widest_beside: float = 5.5   # m, of them
    # m, scatter of where vehicles keep within a lane about its middle, averaged over a block: 0.09 on half of the streets at hand, 0.13 on the others
    track_sigma: float = 0.1
    alike_beside: float = 4.0   # by how many times more lanes of the same road that were driven tell what is left over than what is usual
    alike_within: float = 500.0   # m of road either way within which they do: a street of a town is laid out alike over a few blocks
    between_widths: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75)   # shares of the way between two readings, at which a lane's width is tried,
    nearer: float = 0.5   # and what it counts that a lane is right to 5 cm, against to 15 cm
    unpainted_divider: float = 2.2   # of a border between the two directions where nothing is painted
    unpainted_lane_line: float = 3.2   # of one between two lanes of a direction
    unused_asphalt: tuple[float, float] = (4.5, 2.0)   # as wide as a lane, between two lines, and beside a curb or an end of surface
    unused_wide: float = 2.5   # between two lines, too wide for a lane
    off_asphalt: float = 3.0   # of a lane on what is no road surface
    driven_rest: float = 8.0   # of a vehicle that drives where no lane is
    driven_against: float = 12.0   # of a vehicle that drives against its lane
    driven_sigma: float = 0.8   # m, scatter of a vehicle about the middle of its lane
    driven_astride: float = 3.0   # the most that this costs
    hatched_lane: float = 8.0   # of a lane over a hatched area
    arrow_outside: float = 4.0   # of an arrow where no lane is
    arrow_sigma: float = 0.4   # m, scatter of arrows about the middle of their lane
    arrow_against: float = 5.0   # of an arrow that surely points against its lane: of 150, one is no arrow, or misread
    against_arrows: float = 7.0   # of a survey driven against the arrows: of a thousand, one was, or has times that run backwards
    wrong_side: float = 8.0   # of oncoming traffic on the near side
    # of a solid line between lanes before their stop line, whichever way they lead, where it is not to be crossed
    solid_at_stop: float = _costs(0.6)[0]
    rest_at_stop: float = 4.0   # of a stop line as broad as a lane where no lane is
    # of two lanes beside each other that lead the same way, of which the outer one alone has a stop line: so for one in twenty
    outer_stopped: float = 3.0
    split_stop: float = 4.0   # of a stop line across the border between the directions: no authority paints one, of fifty one is another bar
    change: float = 0.5   # of a metre across that becomes lane, or ceases to be one
    turn: float = 3.0   # of one that changes its direction
    divider_change: float = 1.5   # of a border between lanes that begins or ends
    lanes_remembered: float = 10.0   # m without any line, as over a junction, that leave a third of what was known of lanes,
    directions_remembered: float = 40.0   # and of directions
    one_way: tuple[float, ...] = (0.4, 1.2, 0.6, 0.4)   # of one, two, three, four lanes and more that all lead one way
    uneven: float = 1.2   # of directions whose numbers of lanes differ by two and more
    median_within: float = 2.3   # of a strip too narrow for a lane between lanes of one direction: of ten medians nine part the directions
    # by what a strip between lines where nobody drives costs less between the directions than elsewhere, and between solid lines on a road of several
    # lanes either way, as a lane there could not be entered: chosen on a street with a pocket for left turns, tried on seven with medians
    median_between: tuple[float, float] = 0.5, 1.7
    two_and_one: float = 0.2   # of two lanes one way and one the other
    two_way_carriageway: float = 4.0   # of two directions on one of two carriageways
    # of two directions where a road was driven more than once, but never back: over `repeats` as of one in five that are surveyed like that
    never_back: float = 0.25
    left_hand: float = 0.7   # of traffic on the left, against traffic on the right, where the place is not known
    # of traffic on the side that is not that of the country there: of four hundred surveys one is of private grounds, or its CRS is another
    foreign_side: float = 6.0
    # slope and offset of the curve by which probable lanes are right, over the log odds; fitted to 13 km of lanes of 32 simulated streets of two
    # simulators, and checked on others (docs/accuracy.md)
    calibration: tuple[float, float] = (0.38, 1.85)
    # slope of that curve for the direction; fitted to 7 km of lanes of 20 simulated streets, on some of which lines leave open which way a lane leads
    calibration_of_direction: float = 1.7
    # m of road beyond which what two readings of it differ by is seen again, not once more, since the road was laid out and driven once. Chosen so
    # that a drive on the near side of dashes surely shows that they part the directions, and one on the far side leaves it open whether the road is
    # one-way or has traffic on the other side
    repeats: float = 130.0
    doubt: float = 3.0   # nats by which a second reading of a lane or line may be less probable to be said beside the first
    most_in_doubt: float = 0.6   # confidence of the first then: two readings of which either may be right, and all others
    not_taken: float = 1000.0   # of a cross-section without the lanes of a reading that an analyst took, against any evidence

    @property
    def boundary(self) -> np.ndarray:
        """(11, 4) costs by what a boundary is made of and what it separates."""
        impossible = (np.inf,) * 4
        return np.array([self.solid, self.dashed, self.double, self.curb, self.surface, self.open_end, impossible, self.hatching, self.curb,
                         self.surface, self.bare])

    @property
    def wide_line(self) -> np.ndarray:
        """(2, 4) costs of a wide line, SOLID or DASHED, by what it separates."""
        return np.array([self.wide_solid, self.wide_dashed])


# Calibration of the probabilities of lanes, and what else may be there.

SAME_LANE = 0.15   # weight: m across within which lanes of two cross-sections are the same: as near as a driving line is right
SUREST = 1e-4   # weight: what is left to say against the surest


@dataclass(frozen=True)
class Reading:
    """The second reading of a place where a lane was found.

    lanes : offset of the middle and width, m, and direction of each lane that then lies there, from left to right
    """

    nats: float   # by how much it is less probable than the first
    lanes: tuple[tuple[float, float, int], ...]


@dataclass(frozen=True)
class TakenReading:
    """A second reading that an analyst took."""

    road: int
    s: np.ndarray   # (V,) m, rising stations and offsets of the lane that it is taken for
    d: np.ndarray
    lanes: tuple[tuple[float, float, int], ...]   # of each lane that lies there instead, m across from that lane, width in m, and direction


def confidence_of(there: np.ndarray, directed: np.ndarray, weights: EstimateWeights = EstimateWeights()) -> np.ndarray:
    """(N,) the share of such lanes within 15 cm of the true driving line that run the right way: of those that lie there, those that lead this way.

    Of two directions that are equally probable neither is right more often, so the curve of the direction goes through one half.
    `there`, `directed` : (N,) 0 to 1, how probable a lane of either direction is there, and this direction among them.
    """
    return calibrated(there, weights) * _on_curve(directed, weights.calibration_of_direction, 0.0)


def calibrated(probability: np.ndarray, weights: EstimateWeights = EstimateWeights()) -> np.ndarray:
    """(N,) the share of such lanes that lie within 15 cm of the true driving line, from the probability of all cross-sections with the lane there.

    The estimate takes its candidates for all there are, and evidence of different kinds for independent, so what it holds for improbable is right
    more often, and what it holds for certain less often; one logistic curve over the log odds tells how often (Platt, Probabilistic outputs for
    support vector machines, 1999).
    """
    return _on_curve(probability, *weights.calibration)


def share_within(sigma: np.ndarray) -> np.ndarray:
    """The share of lines within SAME_LANE of their true place, of those that are off by a normal error; to three decimals.

    `sigma` : (N,) m, one sigma that all lines share, see `RoadFrame.pass_sigma`; 0 where nothing says it.
    """
    with np.errstate(divide="ignore"):
        return np.round(erf(SAME_LANE / (np.sqrt(2.0) * np.asarray(sigma, float))), 3)


def _on_curve(probability, slope, offset):
    p = np.clip(probability, SUREST, 1 - SUREST)
    return 1 / (1 + np.exp(-(slope * np.log(p / (1 - p)) + offset)))
