"""Settings of the roadside."""

from __future__ import annotations

from dataclasses import dataclass

from ...common.setting import check_limits, setting


@dataclass(frozen=True)
class RoadsideSettings:
    """What counts as standing beside the road.

    reach : m beyond the carriageway's edge within which things are looked for
    min_length : m of a rail, barrier, wall, fence or hedge
    min_height : m of its top above the ground
    max_gap : m along the road that such a line may be hidden or interrupted
    min_pole_height : m of a pole, sign or trunk
    """

    reach: float = setting(8.0, 0.5, 50.0, "The reach beyond the edge", "m")
    min_length: float = setting(8.0, 2.0, 200.0, "The length of a line", "m")
    min_height: float = setting(0.4, 0.2, 3.0, "The height of a line", "m")
    max_gap: float = setting(3.0, 0.5, 20.0, "The gap", "m")
    min_pole_height: float = setting(1.5, 0.8, 8.0, "The height of a pole", "m")

    def __post_init__(self) -> None:
        check_limits(self)
