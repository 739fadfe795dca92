"""The weights of the evidence from which the cross-section of a road is estimated, and the calibration of its probabilities."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

# What a boundary is made of
SOLID, DASHED, DOUBLE, CURB, SURFACE, OPEN, OUTSIDE, HATCHING, ISLAND, PAVEMENT = range(10)
# What a boundary separates
LANE_LINE, CENTRE_LINE, EDGE_LINE, OTHER_LINE = range(4)


def _costs(*shares: float) -> tuple[float, ...]:
    return tuple(float(-np.log(share)) for share in shares)


@dataclass(frozen=True)
class EstimateWeights:
    """Costs in nats (-log of a probability); those of what goes on along the road are for `correlation` metres of it.

    The probabilities are shares as road authorities paint and build (the dash and line rules of the catalogue of countries); where those say
    nothing they are our own estimates, rounded.

    correlation : metres of road that count as one observation: what neighbouring metres show is not independent
    laid_out : metres of road that are laid out alike: of how sure lanes are they say no more than `correlation` does; chosen with `calibration`
    solid, dashed, double : share of lane lines, centre lines, edge lines and other lines that are drawn like that
    wide_solid, wide_dashed : the same of wide lines: in all countries at hand they part special lanes (bus, exit, cycle) from others of the same
        direction, or mark the edge, and the directions are parted by a usual line or by two (RMS part A; MUTCD 3B.01 and 3B.04; GB 5768.3;
        Instruction interministerielle, art. 113)
    short_dashed : the same of dashes of usual breadth shorter than those between lanes: they mark an edge that may be crossed, as before a bus bay,
        a lay-by, a strip for cycles or a side street, and no country at hand parts lanes by them (RMS part A; MUTCD 3B.08; catalogue of countries)
    curb, surface : the same of boundaries that are a curb, also of an island, or where the road surface ends without one, seen as an edge or not
    open_end : the same where nothing is known beyond the outermost line
    hatching : the same of boundaries that are the border of a hatched area
    named : of a line that separates something else than its layer says
    stroke, long_line : m of paint that strokes of symbols have too, and that make a line sure
    lane_through_paint, lane_through_curb, lane_through_hatching, lane_through_surface : of a seen line, curb, border of a hatched area or end of
        the surface inside a lane
    paint_in_rest : of a seen line inside a strip where nobody drives
    width_sigma, width_sigma_asked : m, scatter of lane widths on one road, and about the width that the user named
    other_width : share of lanes as wide as lanes are elsewhere; odd_width, odd_width_asked : share of lanes of any other width up to `widest_odd`
    unpainted_divider, unpainted_lane_line : of a border between the two directions, and between two lanes of one, where nothing is painted
    unused_asphalt : of asphalt as wide as a lane where no lane is: between two lines, and beside a curb, the end of the surface or short dashes
    unused_wide : the same of asphalt between two lines that is too wide for a lane
    off_asphalt : of a lane on what is no road surface
    driven_rest : of a vehicle that drives where no lane is
    driven_against : of a vehicle that drives against its lane
    driven_against_asked : the same where the user named the side of traffic
    driven_sigma : m, scatter of a vehicle about the middle of its lane; driven_astride : the most that this costs
    hatched_lane : of a lane over a hatched area
    arrow_outside, arrow_sigma : of an arrow where no lane is; m, scatter of arrows about the middle of their lane
    arrow_against : of an arrow that surely points against its lane: of 150, one is no arrow, or misread
    against_arrows : of a survey driven against the arrows in its lanes: of a thousand, one was, or has times that run backwards
    wrong_side : of oncoming traffic on the near side
    split_stop : of a stop line across the border between the two directions: no authority paints one, of fifty one is another bar
    change : of a metre across that becomes lane, or ceases to be one; turn : that changes its direction
    divider_change : of a border between lanes that begins or ends
    lanes_remembered, directions_remembered : m without any line, as over a junction, that leave a third of what was known before
    one_way : of one, two, three, four lanes and more that all lead one way; uneven : of directions whose numbers of lanes differ by two and more;
        two_and_one : of two lanes one way and one the other; two_way_carriageway : of two directions on one of two carriageways
    dashed_between_many : of dashes between the directions of a road of more than two lanes
    left_hand : of traffic on the left, against traffic on the right
    calibration : slope and offset of the curve by which probable lanes are right, over the log odds; fitted to 13 km of lanes of 32 simulated
        streets of two simulators, and checked on others (docs/accuracy.md)
    repeats : metres of road beyond which what two readings of it differ by is seen again, not once more; tuned: what a vehicle that keeps half a
        metre beside the middle of a lane of 7 m shows on 120 m of road must say no more on a kilometre, and the longest blocks between crossings of
        the simulated streets have 200 m
    doubt, most_in_doubt : nats by which a second reading of a lane or line may be less probable to be said beside the first, and the most that the
        confidence of the first is then: two readings of which either may be right, and all others
    not_taken : of a cross-section without the lanes of a reading that an analyst took, against any evidence
    calibration_of_direction : slope of the same curve for the direction of a lane; fitted to 7 km of lanes of 20 simulated streets, on some of
        which the lines leave open which way a lane leads
    """

    correlation: float = 20.0
    laid_out: float = 60.0
    solid: tuple[float, ...] = _costs(0.1, 0.3, 0.9, 0.15)
    dashed: tuple[float, ...] = _costs(0.8, 0.4, 0.1, 0.3)
    double: tuple[float, ...] = _costs(0.05, 0.9, 0.05, 0.05)
    wide_solid: tuple[float, ...] = _costs(0.1, 0.01, 0.3, 0.1)
    wide_dashed: tuple[float, ...] = _costs(0.1, 0.01, 0.05, 0.05)
    short_dashed: tuple[float, ...] = _costs(0.003, 0.002, 0.1, 0.15)
    curb: tuple[float, ...] = _costs(0.001, 0.02, 0.9, 0.7)
    surface: tuple[float, ...] = _costs(0.001, 0.001, 0.6, 0.8)
    open_end: tuple[float, ...] = (np.inf, np.inf, 2.3, np.inf)
    hatching: tuple[float, ...] = _costs(0.01, 0.01, 0.9, 0.5)
    named: float = 3.0
    stroke: float = 3.0
    long_line: float = 25.0
    lane_through_paint: float = 10.0
    lane_through_curb: float = 12.0
    lane_through_hatching: float = 12.0
    lane_through_surface: float = 3.0
    paint_in_rest: float = 6.0
    width_sigma: float = 0.45
    width_sigma_asked: float = 0.25
    other_width: float = 0.25
    odd_width: float = 0.05
    odd_width_asked: float = 0.005
    widest_odd: float = 8.0
    unpainted_divider: float = 2.2
    unpainted_lane_line: float = 3.2
    unused_asphalt: tuple[float, float] = (4.5, 2.0)
    unused_wide: float = 2.5
    off_asphalt: float = 3.0
    driven_rest: float = 8.0
    driven_against: float = 12.0
    driven_against_asked: float = 0.5
    driven_sigma: float = 0.8
    driven_astride: float = 3.0
    hatched_lane: float = 8.0
    arrow_outside: float = 4.0
    arrow_sigma: float = 0.4
    arrow_against: float = 5.0
    against_arrows: float = 7.0
    wrong_side: float = 8.0
    split_stop: float = 4.0
    change: float = 0.5
    turn: float = 3.0
    divider_change: float = 1.5
    lanes_remembered: float = 10.0
    directions_remembered: float = 40.0
    one_way: tuple[float, ...] = (0.4, 1.2, 0.3, 1.2)
    uneven: float = 1.2
    two_and_one: float = 0.4
    two_way_carriageway: float = 4.0
    dashed_between_many: float = 1.5
    left_hand: float = 0.7
    calibration: tuple[float, float] = (0.38, 1.85)
    calibration_of_direction: float = 1.7
    repeats: float = 200.0
    doubt: float = 3.0
    most_in_doubt: float = 0.6
    not_taken: float = 1000.0

    @property
    def boundary(self) -> np.ndarray:
        """(10, 4) costs by what a boundary is made of and what it separates."""
        impossible = (np.inf,) * 4
        return np.array([self.solid, self.dashed, self.double, self.curb, self.surface, self.open_end, impossible, self.hatching, self.curb,
                         self.surface])

    @property
    def wide_line(self) -> np.ndarray:
        """(2, 4) costs of a wide line, SOLID or DASHED, by what it separates."""
        return np.array([self.wide_solid, self.wide_dashed])


# Calibration of the probabilities of lanes, and what else may be there.

SAME_LANE = 0.15   # m across within which lanes of two cross-sections are the same: as near as a driving line is right
SUREST = 1e-4    # what is left to say against the surest


@dataclass(frozen=True)
class Reading:
    """The second reading of a place where a lane was found.

    nats : by how much it is less probable than the first; 0 where that was chosen by the names of lines alone
    lanes : offset of the middle and width, metres, and direction of each lane that then lies where the lane was found, from left to right
    """

    nats: float
    lanes: tuple[tuple[float, float, int], ...]


@dataclass(frozen=True)
class TakenReading:
    """A second reading that an analyst took.

    road : number; s, d : (V,) metres, rising stations and offsets of the lane that it is taken for
    lanes : of each lane that lies there instead, metres across from that lane, width in metres, and direction
    """

    road: int
    s: np.ndarray
    d: np.ndarray
    lanes: tuple[tuple[float, float, int], ...]


def confidence_of(there: np.ndarray, directed: np.ndarray, weights: EstimateWeights = EstimateWeights()) -> np.ndarray:
    """The share of such lanes that run the right way and within 15 cm of the true driving line: of those that lie there, those that lead this way.

    Of two directions that are equally probable neither is right more often, so the curve of the direction goes through one half.

    Parameters
    ----------
    there, directed : (N,) 0 to 1, confidence and directed of LaneSpan

    Returns
    -------
    (N,) 0 to 1
    """
    return calibrated(there, weights) * _on_curve(directed, weights.calibration_of_direction, 0.0)


def calibrated(probability: np.ndarray, weights: EstimateWeights = EstimateWeights()) -> np.ndarray:
    """The share of such lanes that lie within 15 cm of the true driving line.

    The estimate takes its candidates for all there are, and evidence of different kinds for independent, so what it holds for improbable is right
    more often, and what it holds for certain less often; one logistic curve over the log odds tells how often (Platt, Probabilistic outputs for
    support vector machines, 1999).

    Parameters
    ----------
    probability : (N,) 0 to 1, of all cross-sections in which the lane lies there

    Returns
    -------
    (N,) 0 to 1
    """
    return _on_curve(probability, *weights.calibration)


def share_within(sigma: np.ndarray) -> np.ndarray:
    """The share of lines that lie within SAME_LANE of their true place, of those that are off by a normal error; to three decimals.

    Parameters
    ----------
    sigma : (N,) m, one sigma that all lines share, see `RoadFrame.pass_sigma`; 0 where nothing says it
    """
    with np.errstate(divide="ignore"):
        return np.round(erf(SAME_LANE / (np.sqrt(2.0) * np.asarray(sigma, float))), 3)


def _on_curve(probability, slope, offset):
    p = np.clip(probability, SUREST, 1 - SUREST)
    return 1 / (1 + np.exp(-(slope * np.log(p / (1 - p)) + offset)))
