"""Settings of cross-sections, their limits, and settings of the roadside."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...core.common.errors import RoadExtractionError
from ...core.common.setting import check_limits, setting
from ...core.countries.catalogue import country
from ...core.countries.model import SectionLimits
from ...core.countries.neutral import NEUTRAL


@dataclass(frozen=True)
class CrossSectionSettings:
    """What is measured, and what is too much. A limit of 0 is that of the country, if it has one.

    min_crossfall, max_crossfall : % of a lane, whatever its direction
    """

    interval: float = setting(10.0, 1.0, 1000.0, "The interval", "m")   # m of station between sections
    country: str = NEUTRAL.name   # of the catalogue
    max_rut: float = setting(0.0, 1.0, 200.0, "The rut depth", "mm", "for the country's")   # mm, of the rut depth under a straight edge of 2 m
    min_crossfall: float = setting(0.0, 0.1, 20.0, "The least crossfall", "%", "for the country's")
    max_crossfall: float = setting(0.0, 0.1, 20.0, "The greatest crossfall", "%", "for the country's")
    max_grade: float = setting(0.0, 0.1, 50.0, "The greatest grade", "%", "for the country's")   # % along the road
    min_width: float = setting(0.0, 1.0, 10.0, "The least lane width", "m", "for the country's")   # m of a driving lane
    min_clearance: float = setting(0.0, 1.0, 10.0, "The least clearance", "m", "for the country's")   # m above the road

    def __post_init__(self) -> None:
        check_limits(self)
        limits = self.limits()
        if limits.min_crossfall is not None and limits.max_crossfall is not None and limits.min_crossfall > limits.max_crossfall:
            least, most = ("" if user_limit else f" in the rules of {self.country}" for user_limit in (self.min_crossfall, self.max_crossfall))
            raise RoadExtractionError(f"The least crossfall is {limits.min_crossfall:g} %{least}, the greatest {limits.max_crossfall:g} %{most}: no "
                                      "lane can keep both. Set both limits so that the least is below the greatest.")

    def limits(self) -> SectionLimits:
        """The limits that hold: the user's own, else the country's; None where neither has one."""
        national = country(self.country).section_limits
        chosen = {name: value for name in SectionLimits.NAMES if (value := getattr(self, name))}
        return replace(national, **chosen, rules={**national.rules, **dict.fromkeys(chosen, "limit set by the user")})


# Settings of the roadside.

@dataclass(frozen=True)
class RoadsideSettings:
    """What counts as standing beside the road."""

    interval: float = setting(10.0, 1.0, 1000.0, "The interval", "m")   # m of station between vertices of the lines at most
    country: str = NEUTRAL.name   # of the catalogue, whose lanes tell two marking lines that bound one, where there are no edges
    reach: float = setting(8.0, 0.5, 50.0, "The reach beyond the edge", "m")   # m beyond the carriageway's edge within which things are looked for
    min_length: float = setting(8.0, 2.0, 200.0, "The length of a line", "m")   # m of a rail, barrier, wall, fence or hedge
    min_height: float = setting(0.4, 0.2, 3.0, "The height of a line", "m")   # m of its top above the ground
    max_gap: float = setting(3.0, 0.5, 20.0, "The gap", "m")   # m along the road that such a line may be hidden or interrupted
    min_pole_height: float = setting(1.5, 0.8, 8.0, "The height of a pole", "m")   # m of a pole, sign or trunk

    def __post_init__(self) -> None:
        check_limits(self)
        country(self.country)
