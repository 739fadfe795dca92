"""The catalogue of countries: COUNTRY names one of them, and nothing guesses it."""

from __future__ import annotations

from ..common.errors import RoadExtractionError
from .china import CHINA
from .germany import GERMANY
from .japan import JAPAN
from .model import Country, DesignSpeed
from .neutral import NEUTRAL
from .united_states import UNITED_STATES

__all__ = ["COUNTRIES", "Country", "DesignSpeed", "country"]

COUNTRIES = {one.name: one for one in (NEUTRAL, CHINA, GERMANY, JAPAN, UNITED_STATES)}


def country(name: str) -> Country:
    """The country of this name; one that the catalogue does not have is refused."""
    if name not in COUNTRIES:
        raise RoadExtractionError(f"There is no country called {name!r} in the catalogue. Choose one of {', '.join(COUNTRIES)}.")
    return COUNTRIES[name]
