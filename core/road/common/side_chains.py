"""The chains of steps that a method found on one side of a road, and curb points of them that it may give later."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .corners import CurbSteps
from .tracking import StepChain


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

    def points(self, chain: int, start: float, end: float, number: int) -> list[dict]:
        """Curb points of the steps of a chain between two stations, m; they get the number."""
        members = self.chains[chain].steps
        return self.block_points(self.steps[members[(self.steps.s[members] >= start) & (self.steps.s[members] <= end)]], number)
