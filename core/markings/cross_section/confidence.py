"""How often a lane is right that the estimate holds for so probable, and what else may be there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from .weights import EstimateWeights

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
    weights : EstimateWeights

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
    weights : EstimateWeights

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
