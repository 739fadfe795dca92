"""Charts as SVG: bars, curves and ribbons over a common axis, with numbers one can read."""

import html
import math

import numpy as np

WIDTH, LEFT, RIGHT, TOP, BOTTOM = 900, 58, 12, 12, 40
END = WIDTH - RIGHT
GRID, INK = "#dddddd", "#444444"


class Chart:
    """A plot of `height` pixels over x from `x_range` and y from `y_range`; parts are drawn in the order of the calls."""

    def __init__(self, x_range, y_range, x_label, y_label, height=220):
        self.height = height
        self.x0, self.x1 = _spread(x_range)
        self.y0, self.y1 = _spread(y_range)
        self.parts, self.levels, self.labels = [], [], (x_label, y_label)

    def _x(self, x):
        return LEFT + (np.asarray(x, float) - self.x0) / (self.x1 - self.x0) * (WIDTH - LEFT - RIGHT)

    def _y(self, y):
        inner = self.height - TOP - BOTTOM
        return TOP + inner - (np.clip(y, self.y0, self.y1) - self.y0) / (self.y1 - self.y0) * inner

    def bars(self, left, right, values, colour, base=0.0, title=""):
        """Bars from `base` up to values; NaN leaves a place empty. Returns the tops, to stack the next upon."""
        base = np.broadcast_to(np.asarray(base, float), np.shape(values))
        for a, b, low, high in zip(self._x(left), self._x(right), base, np.asarray(values, float) + base):
            if np.isfinite(high) and high != low:
                top, foot = sorted((float(self._y(high)), float(self._y(low))))
                self.parts.append(f'<rect x="{a:.1f}" y="{top:.1f}" width="{max(b - a - 0.6, 0.6):.1f}" height="{foot - top:.1f}" '
                                  f'fill="{colour}">{_title(title)}</rect>')
        return np.nan_to_num(values) + base

    def curve(self, x, y, colour, title="", width=1.6):
        """A line through the points; NaN interrupts it."""
        known = np.isfinite(x) & np.isfinite(y)
        rows = np.flatnonzero(known)
        for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            if len(run):
                points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(self._x(np.asarray(x)[run]), self._y(np.asarray(y)[run])))
                self.parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}">{_title(title)}</polyline>')

    def level(self, y, colour, label=""):
        """A dashed line across the plot, with its label where no other is in the way."""
        at = float(self._y(y))
        self.parts.append(f'<line x1="{LEFT}" x2="{END}" y1="{at:.1f}" y2="{at:.1f}" stroke="{colour}" stroke-dasharray="5 4"/>')
        if label and all(abs(at - other) > 12 for other in self.levels):  # labels must not lie over each other
            self.levels.append(at)
            self.parts.append(f'<text x="{END - 4}" y="{at - 4:.1f}" text-anchor="end" font-size="11" fill="{colour}">{html.escape(label)}</text>')

    def svg(self):
        inner = "".join([self._grid(), *self.parts])
        return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{self.height}" viewBox="0 0 {WIDTH} {self.height}" '
                f'font-family="DejaVu Sans, Segoe UI, Helvetica, Arial, sans-serif" font-size="12">'
                f'<rect width="{WIDTH}" height="{self.height}" fill="white"/>{inner}</svg>')

    def _grid(self):
        found, foot = [], self.height - BOTTOM
        for x in ticks(self.x0, self.x1, 10):
            at = float(self._x(x))
            found.append(f'<line x1="{at:.1f}" x2="{at:.1f}" y1="{TOP}" y2="{foot}" stroke="{GRID}"/>'
                         f'<text x="{at:.1f}" y="{foot + 15}" text-anchor="middle" fill="{INK}">{_number(x)}</text>')
        for y in ticks(self.y0, self.y1, 5):
            at = float(self._y(y))
            found.append(f'<line x1="{LEFT}" x2="{END}" y1="{at:.1f}" y2="{at:.1f}" stroke="{GRID}"/>'
                         f'<text x="{LEFT - 6}" y="{at + 4:.1f}" text-anchor="end" fill="{INK}">{_number(y)}</text>')
        middle = TOP + (foot - TOP) / 2
        style = f'text-anchor="middle" fill="{INK}"'
        found.append(f'<text x="{(LEFT + END) / 2}" y="{self.height - 6}" {style}>{html.escape(self.labels[0])}</text>')
        found.append(f'<text x="14" y="{middle}" {style} transform="rotate(-90 14 {middle})">{html.escape(self.labels[1])}</text>')
        return "".join(found)


def ticks(low, high, about):
    """Round values between low and high, about so many."""
    rough = (high - low) / about
    power = 10.0 ** math.floor(math.log10(rough))
    step = power * next(m for m in (1, 2, 5, 10) if m * power >= rough * 0.999)
    return np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1) * step


def _spread(pair):
    low, high = float(pair[0]), float(pair[1])
    return (low, high) if high > low else (low - 0.5, low + 0.5)


def _number(value):
    return f"{value:.10g}" if abs(value) > 1e-12 else "0"


def _title(text):
    return f"<title>{html.escape(text)}</title>" if text else ""
