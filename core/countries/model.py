"""What the catalogue says of one country."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class DesignSpeed:
    """One row of a design code.

    speed : design speed, km/h
    radius : least radius of a circular curve at that speed, metres
    length : least length of a curve, metres; 0 where the code sets none
    """

    speed: int
    radius: float
    length: float = 0.0


@dataclass(frozen=True)
class Dashes:
    """Length of a dash and of the gap behind it, metres, and where it is used."""

    dash: float
    gap: float
    where: str = ""


@dataclass(frozen=True)
class SectionLimits:
    """What a cross-section must keep to; None where the country's rules at hand set nothing.

    max_rut : mm, of the rut depth
    min_crossfall, max_crossfall : %, of a lane
    max_grade : %
    min_width : m, of a driving lane
    min_clearance : m above the road
    sources : one sentence for each rule
    """

    max_rut: float | None = None
    min_crossfall: float | None = None
    max_crossfall: float | None = None
    max_grade: float | None = None
    min_width: float | None = None
    min_clearance: float | None = None
    sources: tuple[str, ...] = ()

    NAMES: ClassVar[tuple[str, ...]] = ("max_rut", "min_crossfall", "max_crossfall", "max_grade", "min_width", "min_clearance")


@dataclass(frozen=True)
class Country:
    """Dimensions of lanes and markings in one country; lengths in metres.

    name : as COUNTRY names it
    narrowest_lane, widest_lane : between the lines of a lane; wider strips hold several lanes
    usual_lane : assumed where no lane of a road shows its width
    longest_dash : longer paint is a solid line
    line_widths : of longitudinal lines, ascending
    dash_patterns : of lane and centre lines
    design_code : name of the code that curves are checked against
    design_speeds : its rows, slowest first
    sources : one sentence for each group of values above
    section_limits : what cross-sections must keep to
    """

    name: str
    narrowest_lane: float
    widest_lane: float
    usual_lane: float
    longest_dash: float
    line_widths: tuple[float, ...]
    dash_patterns: tuple[Dashes, ...]
    design_code: str
    design_speeds: tuple[DesignSpeed, ...]
    sources: tuple[str, ...]
    section_limits: SectionLimits = SectionLimits()
