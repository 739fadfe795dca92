"""What the catalogue says of one country."""

from __future__ import annotations

from dataclasses import dataclass


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
