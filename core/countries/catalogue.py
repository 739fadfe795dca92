"""The catalogue of countries, countries.json: COUNTRY names one of them, and nothing guesses it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from ..common.errors import RoadExtractionError


@dataclass(frozen=True)
class _DesignSpeed:
    """One row of a design code."""

    speed: int   # design speed, km/h
    radius: float   # least radius of a circular curve at that speed, metres
    length: float = 0.0   # least length of a curve, metres; 0 where the code sets none


@dataclass(frozen=True)
class _Dashes:
    """Length of a dash and of the gap behind it, metres, and where it is used."""

    dash: float
    gap: float
    where: str = ""


@dataclass(frozen=True)
class SectionLimits:
    """What a cross-section must keep to; None where the country's rules at hand set nothing."""

    max_rut: float | None = None   # mm, of the rut depth
    min_crossfall: float | None = None   # min_crossfall, max_crossfall: %, of a lane
    max_crossfall: float | None = None
    max_grade: float | None = None   # %
    min_width: float | None = None   # m, of a driving lane
    min_clearance: float | None = None   # m above the road
    rules: Mapping[str, str] = field(default_factory=dict)   # {name of a limit: the rule that sets it}

    NAMES: ClassVar[tuple[str, ...]] = ("max_rut", "min_crossfall", "max_crossfall", "max_grade", "min_width", "min_clearance")


@dataclass(frozen=True)
class Country:
    """Dimensions of lanes and markings in one country; lengths in metres."""

    name: str   # as COUNTRY names it
    narrowest_lane: float   # narrowest_lane, widest_lane: between the lines of a lane; wider strips hold several lanes
    widest_lane: float
    usual_lane: float   # assumed where no lane of a road shows its width
    longest_dash: float   # longer paint is a solid line
    line_widths: tuple[float, ...]   # of longitudinal lines, ascending
    dash_patterns: tuple[_Dashes, ...]   # of lane and centre lines
    design_code: str   # name of the code that curves are checked against
    design_speeds: tuple[_DesignSpeed, ...]   # its rows, slowest first
    sources: tuple[str, ...]   # one sentence for each group of values above
    section_limits: SectionLimits   # what cross-sections must keep to


def _country(line_widths: list[float], dash_patterns: list[Any], design_speeds: list[Any], sources: list[str], section_limits: dict[str, Any],
             note: str = "", **further: Any) -> Country:
    """A country as it stands in countries.json: dashes as [dash, gap, where], speeds as [speed, radius, length], limits as {name: [value, rule]}."""
    limits = {name: value for name, (value, _) in section_limits.items()}
    return Country(line_widths=tuple(line_widths), dash_patterns=tuple(_Dashes(*row) for row in dash_patterns),
                   design_speeds=tuple(_DesignSpeed(*row) for row in design_speeds), sources=tuple(sources),
                   section_limits=SectionLimits(**limits, rules={name: rule for name, (_, rule) in section_limits.items()}), **further)


COUNTRIES = {entry["name"]: _country(**entry) for entry in json.loads(Path(__file__).with_name("countries.json").read_text(encoding="utf-8"))}
NEUTRAL = COUNTRIES["neutral"]   # the default: limits that lanes and markings of all countries at hand keep


def country(name: str) -> Country:
    """The country of this name; one that the catalogue does not have is refused."""
    if name not in COUNTRIES:
        raise RoadExtractionError(f"There is no country called {name!r} in the catalogue. Choose one of {', '.join(COUNTRIES)}.")
    return COUNTRIES[name]
