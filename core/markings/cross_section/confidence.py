"""How often a lane is right that the estimate holds for so probable."""

from __future__ import annotations

import numpy as np

from .weights import EstimateWeights

SUREST = 1e-4    # what is left to say against the surest


def calibrated(probability: np.ndarray, weights: EstimateWeights = EstimateWeights()) -> np.ndarray:
    """The share of such lanes that run the right way and within 15 cm of the true driving line.

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
    slope, offset = weights.calibration
    p = np.clip(probability, SUREST, 1 - SUREST)
    return 1 / (1 + np.exp(-(slope * np.log(p / (1 - p)) + offset)))
