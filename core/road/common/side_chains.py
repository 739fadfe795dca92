"""The chains of steps that a method found on one side of a road, and curb points of them that it may give later."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .corners import CurbSteps
from .pseudo_scanlines import expand_ranges
from .tracking import LINK_TOLERANCE, MAX_LINK_LENGTH, StepChain


@dataclass(frozen=True)
class SideChains:
    """The chains of one side of one road.

    steps : CurbSteps of the side
    chains : list of StepChain of these steps
    block_points : function, CurbSteps of one chain and a number for it -> a dict for each curb point: s, u, h, and `fields`, what else is known of it
    """

    steps: CurbSteps
    chains: list[StepChain]
    block_points: Callable[[CurbSteps, int], list[dict]]

    def points(self, members: np.ndarray, number: int) -> list[dict]:
        """Curb points of the steps with the (K,) indices, by station, of one line; they get the number."""
        return self.block_points(self.steps[members], number)

    def support_along(self, s: np.ndarray, u: np.ndarray, skew: np.ndarray) -> np.ndarray:
        """Laser points that show a step on a line.

        Parameters
        ----------
        s, u : (N,) m, station and outward offset of places on the line
        skew : (N,) m outward per m along, direction of the line

        Returns
        -------
        (N,) points per metre of road, over MAX_LINK_LENGTH of it, half on either side
        """
        order = np.argsort(self.steps.s, kind="stable")
        by_station = self.steps.s[order]
        place, row = expand_ranges(*(np.searchsorted(by_station, s + end) for end in (-0.5 * MAX_LINK_LENGTH, 0.5 * MAX_LINK_LENGTH)))
        row = order[row]
        near = np.abs(self.steps.u[row] - u[place] - skew[place] * (self.steps.s[row] - s[place])) <= 2 * LINK_TOLERANCE
        return np.bincount(place[near], self.steps.support[row[near]], len(s)) / MAX_LINK_LENGTH
