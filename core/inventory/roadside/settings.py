"""Settings of the roadside."""

from __future__ import annotations

from dataclasses import dataclass

from ...common.setting import check_limits, setting
from ...countries.catalogue import country
from ...countries.neutral import NEUTRAL


@dataclass(frozen=True)
class RoadsideSettings:
    """What counts as standing beside the road.

    interval : m of station between vertices of the lines at most
    country : of the catalogue, whose lanes tell two marking lines that bound one, where there are no edges
    reach : m beyond the carriageway's edge within which things are looked for
    min_length : m of a rail, barrier, wall, fence or hedge
    min_height : m of its top above the ground
    max_gap : m along the road that such a line may be hidden or interrupted
    min_pole_height : m of a pole, sign or trunk
    """

    interval: float = setting(10.0, 1.0, 1000.0, "The interval", "m")
    country: str = NEUTRAL.name
    reach: float = setting(8.0, 0.5, 50.0, "The reach beyond the edge", "m")
    min_length: float = setting(8.0, 2.0, 200.0, "The length of a line", "m")
    min_height: float = setting(0.4, 0.2, 3.0, "The height of a line", "m")
    max_gap: float = setting(3.0, 0.5, 20.0, "The gap", "m")
    min_pole_height: float = setting(1.5, 0.8, 8.0, "The height of a pole", "m")

    def __post_init__(self) -> None:
        check_limits(self)
        country(self.country)
