"""Charts as SVG: bars, curves and levels over common axes.

Written by hand: matplotlib takes a second per chart and three to load, keeps the settings of its SVG files in global state
(not safe in worker threads), and shows no text when the pointer rests on a bar.
"""

from __future__ import annotations

import html
import math
from collections.abc import Sequence

import numpy as np

CHART_WIDTH = 900  # px
LEFT_MARGIN, RIGHT_MARGIN, TOP_MARGIN, BOTTOM_MARGIN = 58, 22, 12, 40  # px
PLOT_END = CHART_WIDTH - RIGHT_MARGIN
GRID_COLOUR, TEXT_COLOUR = "#dddddd", "#444444"
MIN_LABEL_DISTANCE = 12  # px between the labels of two levels


class Chart:
    """A chart; its parts are drawn in the order of the calls.

    x_range, y_range : (lowest, highest) of the axes
    x_label, y_label : with units
    height : pixels
    """

    def __init__(self, x_range: tuple[float, float], y_range: tuple[float, float], x_label: str, y_label: str, height: int = 220) -> None:
        self.height = height
        self.x0, self.x1 = _nonzero_range(x_range)
        self.y0, self.y1 = _nonzero_range(y_range)
        self.parts: list[str] = []
        self.levels: list[float] = []
        self.labels = x_label, y_label

    @property
    def _clip(self) -> str:
        return f"plot{self.height}"

    def _x(self, x):
        return LEFT_MARGIN + (np.asarray(x, float) - self.x0) / (self.x1 - self.x0) * (CHART_WIDTH - LEFT_MARGIN - RIGHT_MARGIN)

    def _y(self, y):
        inner = self.height - TOP_MARGIN - BOTTOM_MARGIN
        return TOP_MARGIN + inner - (np.clip(y, self.y0, self.y1) - self.y0) / (self.y1 - self.y0) * inner

    def bars(self, left: np.ndarray | Sequence[float], right: np.ndarray | Sequence[float], values: np.ndarray | Sequence[float], colour: str,
             base: float | np.ndarray = 0.0, title: str = "") -> np.ndarray:
        """Draw bars between (N,) left and right, of (N,) heights above `base`, none where NaN; `title` is shown under the pointer.

        Returns the (N,) y of their upper ends, on which further bars can be stacked.
        """
        base = np.broadcast_to(np.asarray(base, float), np.shape(values))
        for a, b, low, high in zip(self._x(left), self._x(right), base, np.asarray(values, float) + base):
            if np.isfinite(high) and high != low:
                top, foot = sorted((float(self._y(high)), float(self._y(low))))
                self.parts.append(f'<rect x="{a:.1f}" y="{top:.1f}" width="{max(b - a - 0.6, 0.6):.1f}" height="{foot - top:.1f}" '
                                  f'fill="{colour}">{_title(title)}</rect>')
        return np.nan_to_num(values) + base

    def curve(self, x: np.ndarray, y: np.ndarray, colour: str, title: str = "", width: float = 1.6) -> None:
        """Draw a line of some width, px, through points (N,); NaN interrupts it."""
        finite = np.isfinite(x) & np.isfinite(y)
        rows = np.flatnonzero(finite)
        for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            if len(run):
                points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(self._x(np.asarray(x)[run]), self._y(np.asarray(y)[run])))
                self.parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}" '
                                  f'clip-path="url(#{self._clip})">{_title(title)}</polyline>')

    def level(self, y: float, colour: str, label: str = "") -> None:
        """Draw a dashed line across the plot, with its label unless that would lie over another one."""
        pixel = float(self._y(y))
        self.parts.append(f'<line x1="{LEFT_MARGIN}" x2="{PLOT_END}" y1="{pixel:.1f}" y2="{pixel:.1f}" stroke="{colour}" stroke-dasharray="5 4"/>')
        if label and all(abs(pixel - drawn) > MIN_LABEL_DISTANCE for drawn in self.levels):
            self.levels.append(pixel)
            self.parts.append(f'<text x="{PLOT_END - 4}" y="{pixel - 4:.1f}" text-anchor="end" font-size="11" fill="{colour}">'
                              f'{html.escape(label)}</text>')

    def svg(self) -> str:
        """The chart as an SVG element."""
        # charts of one page may share the name of the clip path: it is the same rectangle for all of one height
        clip = (f'<clipPath id="{self._clip}"><rect x="{LEFT_MARGIN}" y="0" width="{PLOT_END - LEFT_MARGIN}" '
                f'height="{self.height}"/></clipPath>')
        inner = "".join([clip, self._grid(), *self.parts])
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{CHART_WIDTH}" height="{self.height}" viewBox="0 0 {CHART_WIDTH} {self.height}" '
                f'font-family="DejaVu Sans, Segoe UI, Helvetica, Arial, sans-serif" font-size="12">'
                f'<rect width="{CHART_WIDTH}" height="{self.height}" fill="white"/>{inner}</svg>')

    def _grid(self):
        parts, foot = [], self.height - BOTTOM_MARGIN
        for x in ticks(self.x0, self.x1, 10):
            pixel = float(self._x(x))
            parts.append(f'<line x1="{pixel:.1f}" x2="{pixel:.1f}" y1="{TOP_MARGIN}" y2="{foot}" stroke="{GRID_COLOUR}"/>'
                         f'<text x="{pixel:.1f}" y="{foot + 15}" text-anchor="middle" fill="{TEXT_COLOUR}">{_number(x)}</text>')
        for y in ticks(self.y0, self.y1, 5):
            pixel = float(self._y(y))
            parts.append(f'<line x1="{LEFT_MARGIN}" x2="{PLOT_END}" y1="{pixel:.1f}" y2="{pixel:.1f}" stroke="{GRID_COLOUR}"/>'
                         f'<text x="{LEFT_MARGIN - 6}" y="{pixel + 4:.1f}" text-anchor="end" fill="{TEXT_COLOUR}">{_number(y)}</text>')
        middle = TOP_MARGIN + (foot - TOP_MARGIN) / 2
        style = f'text-anchor="middle" fill="{TEXT_COLOUR}"'
        parts.append(f'<text x="{(LEFT_MARGIN + PLOT_END) / 2}" y="{self.height - 6}" {style}>{html.escape(self.labels[0])}</text>')
        parts.append(f'<text x="14" y="{middle}" {style} transform="rotate(-90 14 {middle})">{html.escape(self.labels[1])}</text>')
        return "".join(parts)


def ticks(low: float, high: float, count: int) -> np.ndarray:
    """About `count` round values from low to high: steps of 1, 2 or 5 times a power of ten."""
    rough = (high - low) / count
    power = 10.0 ** math.floor(math.log10(rough))
    step = power * next(m for m in (1, 2, 5, 10) if m * power >= rough * 0.999)
    return np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1) * step


def _nonzero_range(pair):
    low, high = float(pair[0]), float(pair[1])
    return (low, high) if high > low else (low - 0.5, low + 0.5)


def _number(value):
    return f"{value:.10g}" if abs(value) > 1e-12 else "0"


def _title(text):
    return f"<title>{html.escape(text)}</title>" if text else ""
