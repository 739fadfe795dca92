"""A drawing in millimetres, as a picture of a layout: lines, areas and texts that nothing evaluates."""

from __future__ import annotations

import base64
import math
from html import escape

import numpy as np
import shapely
from qgis.PyQt.QtCore import QRectF
from qgis.PyQt.QtGui import QFont, QFontMetricsF

from .legend import FONT

LETTER = 0.353   # mm of a point
FINEST = 0.01    # mm by which a line may be drawn beside its places
GREY, DARK = "#8a8a8a", "#202020"


class Drawing:
    """Lines and texts on a rectangle of so many millimetres, y downwards."""

    def __init__(self, width: float, height: float):
        self.width, self.height = width, height
        self._parts: list[str] = []
        self._taken: list[QRectF] = []   # where texts stand

    def line(self, places: np.ndarray | list, colour: str = DARK, width: float = 0.2, dash: str = "", fill: str = "none",
             closed: bool = False) -> None:
        """A polyline through (N, 2) places; what is not finite interrupts it."""
        places = np.asarray(places, float)
        for part in np.split(places, np.flatnonzero(~np.isfinite(places).all(axis=1))):
            part = part[np.isfinite(part).all(axis=1)]
            if len(part) > 1:
                if not closed:
                    part = shapely.get_coordinates(shapely.simplify(shapely.linestrings(part), FINEST))
                path = "M" + "L".join(f"{x:.3f} {y:.3f}" for x, y in part) + "Z" * closed
                dashed = f' stroke-dasharray="{dash}"' if dash else ""
                faint = f' fill-opacity="{int(fill[7:], 16) / 255:.2f}"' if len(fill) == 9 else ""
                self._parts.append(f'<path d="{path}" fill="{fill[:7]}"{faint} stroke="{colour}" stroke-width="{width}"{dashed} '
                                   'stroke-linejoin="round"/>')

    def text(self, x: float, y: float, text: str, size: float = 7.0, anchor: str = "middle", turned: float = 0.0, colour: str = DARK,
             boxed: bool = False, yields: bool = False) -> bool:
        """A text whose middle line passes through a place, `turned` clockwise by degrees; False where it `yields` to texts already there."""
        wide, high = text_width(text, size), size * LETTER
        shift = {"start": wide / 2, "middle": 0.0, "end": -wide / 2}[anchor]
        angle = math.radians(turned)
        cx, cy = x + shift * math.cos(angle), y + shift * math.sin(angle)
        w = abs(wide * math.cos(angle)) + abs(high * math.sin(angle))
        h = abs(wide * math.sin(angle)) + abs(high * math.cos(angle))
        room = QRectF(cx - w / 2 - 0.4, cy - h / 2 - 0.3, w + 0.8, h + 0.6)
        if yields and (any(room.intersects(other) for other in self._taken) or not QRectF(0, 0, self.width, self.height).contains(room)):
            return False
        self._taken.append(room)
        turn = f' transform="rotate({turned:.2f} {cx:.3f} {cy:.3f})"' if turned else ""
        if boxed:
            self._parts.append(f'<rect x="{cx - wide / 2 - 0.5:.3f}" y="{cy - high * 0.62:.3f}" width="{wide + 1:.3f}" height="{high * 1.24:.3f}" '
                               f'fill="#ffffff" fill-opacity="0.85"{turn}/>')
        self._parts.append(f'<text x="{cx:.3f}" y="{cy + 0.36 * high:.3f}" font-family="{FONT}" font-size="{high:.3f}" text-anchor="middle" '
                           f'fill="{colour}"{turn}>{escape(text)}</text>')
        return True

    def path(self) -> str:
        """As QGIS takes a picture that lies in no file."""
        text = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}mm" height="{self.height}mm" '
                f'viewBox="0 0 {self.width} {self.height}">{"".join(self._parts)}</svg>')
        return "base64:" + base64.b64encode(text.encode()).decode()


def text_width(text: str, size: float) -> float:
    """mm that a text takes, letters of `size` points."""
    font = QFont(FONT)
    font.setPixelSize(100)
    return QFontMetricsF(font).horizontalAdvance(text) / 100 * size * LETTER


def station_text(station: float) -> str:
    """0+125 for 125 m, as on plans."""
    whole, rest = divmod(round(abs(station), 2), 1000)
    sign = "-" if station < 0 else ""
    return f"{sign}{int(whole)}+{rest:03.0f}" if rest == round(rest) else f"{sign}{int(whole)}+{rest:06.2f}"
