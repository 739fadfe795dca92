"""What road authorities prescribe, country by country.

In: the name of a country. Out: a `Country` with lane widths, line widths, dash patterns and a design code, each with its source. By place on earth
the catalogue says on which side traffic drives, and nothing else.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "catalogue": ("COUNTRIES", "Country", "DesignSpeed", "country"),
    "traffic_side": ("side_of_traffic",),
})
