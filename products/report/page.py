"""Reports as HTML: a template for each kind over one base page. Texts, numbers, tables and pictures are made in one way for all of them."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from ...core.common.arrays import round_step
from ...core.common.texts import language, numbers, told, tr, word
from ...core.io.crs import NO_PLACE, place_of_raster
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.lazy import cv2, gdal

TEMPLATES = Path(__file__).parent / "templates"
_END_OF_TITLE = "</h1>"


def html_page(name: str, **values: Any) -> str:
    """The HTML page of the template `name` with values; `notes` among them are sentences to highlight. Everything is escaped but drawings."""
    return templates().get_template(f"{name}.html").render(values)


@lru_cache(maxsize=1)
def templates() -> Any:
    """The jinja2.Environment of the reports."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # only when a report is written: QGIS starts no slower

    environment = Environment(loader=FileSystemLoader(str(TEMPLATES)), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
                              lstrip_blocks=True, keep_trailing_newline=True)
    environment.globals.update(tr=tr, told=told, word=word, language=language, number=number, collected=_Rows,
                               pick=lambda row, names: [row.get(name) for name in names.split()])
    environment.filters.update(shown=_shown, percent=percent, base64_png=lambda image: base64.b64encode(
        cv2.imencode(".png", image)[1].tobytes()).decode("ascii"))   # of pictures (H, W, 3) uint8, blue, green, red
    environment.tests.update(figure=_is_figure, figures=lambda rows, column: bool(rows) and all(
        row[column] is None or _is_figure(row[column]) for row in rows))
    parts = vars(environment.get_template("parts.html").module)
    environment.globals.update({name: macro for name, macro in parts.items() if not name.startswith("_")})
    return environment


def with_facts(html: str, rows: Iterable[tuple[str, str]]) -> str:
    """A page of `html_page` with a table of (name, value) below its title; another page stays as it is."""
    return html.replace(_END_OF_TITLE, f"{_END_OF_TITLE}\n{templates().globals['facts'](list(rows))}", 1)


def number(value: float) -> str:
    """A number for readers: thousands separated, about three significant digits, a dash for NaN."""
    if value != value:
        return "–"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    size = abs(value)
    digits = 0 if size >= 1000 else 1 if size >= 100 else 2 if size >= 1 else 3
    return numbers(f"{value:,.{digits}f}".replace(",", "\u202f"))


def round_down(value: float) -> float:
    """1, 2 or 5 times a power of ten, the largest that is not above a value."""
    ten = 10.0 ** np.floor(np.log10(value))
    return float(max(step * ten for step in (1, 2, 5) if step * ten <= value * (1 + 1e-9)))


class _Rows(list):
    """The rows of a table, which a template adds one by one."""

    def add(self, *values: Any) -> str:
        self.append(values)
        return ""


def _is_figure(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _shown(value: Any, decimals: int | None = None) -> Any:
    """A value in a table: with so many decimals, or as `number` has it where they are None; a dash for None and NaN."""
    if value is None:
        return "–"
    if not _is_figure(value):
        return value
    return number(value) if decimals is None or value != value else numbers(f"{value:.{decimals}f}")


def percent(share: float) -> float | None:
    """A share as a percentage; None for NaN."""
    return None if share != share else 100.0 * share


# Charts as SVG: bars, curves and levels over common axes.
#
# Written by hand: matplotlib takes a second per chart and three to load, keeps the settings of its SVG files in global state (not safe in worker
# threads), and shows no text when the pointer rests on a bar.

CHART_WIDTH = 900  # px
LEFT_MARGIN, RIGHT_MARGIN, TOP_MARGIN, BOTTOM_MARGIN = 58, 22, 12, 40  # px
PLOT_END = CHART_WIDTH - RIGHT_MARGIN
MIN_LABEL_DISTANCE = 12  # px between the labels of two levels


class Chart:
    """A chart over axes from lowest to highest, so many pixels high, with labels that name units; parts are drawn in the order of the calls."""

    def __init__(self, x_range: tuple[float, float], y_range: tuple[float, float], x_label: str, y_label: str, height: int = 220) -> None:
        self.height = height
        self.x0, self.x1 = _nonzero_range(x_range)
        self.y0, self.y1 = _nonzero_range(y_range)
        self.parts: list[tuple[Any, ...]] = []   # (bar, curve or level; where, px; colour; text; width, px)
        self.labels = x_label, y_label

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
                self.parts.append(("bar", (a, top, max(b - a - 0.6, 0.6), foot - top), colour, title, 0))
        return np.nan_to_num(values) + base

    def curve(self, x: np.ndarray, y: np.ndarray, colour: str, title: str = "", width: float = 1.6) -> None:
        """Draw a line of some width, px, through points (N,); NaN interrupts it."""
        finite = np.isfinite(x) & np.isfinite(y)
        rows = np.flatnonzero(finite)
        for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            if len(run):
                self.parts.append(("curve", list(zip(self._x(np.asarray(x)[run]), self._y(np.asarray(y)[run]))), colour, title, width))

    def level(self, y: float, colour: str, label: str = "") -> None:
        """Draw a dashed line across the plot, with its label unless that would lie over another one."""
        pixel = float(self._y(y))
        free = all(abs(pixel - drawn) > MIN_LABEL_DISTANCE for kind, drawn, _, text, _ in self.parts if kind == "level" and text)
        self.parts.append(("level", pixel, colour, label if free else "", 0))

    def svg(self) -> str:
        columns, rows = ([(float(pixel_of(value)), f"{value:.10g}" if abs(value) > 1e-12 else "0") for value in ticks(low, high, count)]
                         for pixel_of, low, high, count in ((self._x, self.x0, self.x1, 10), (self._y, self.y0, self.y1, 5)))
        return html_page("chart", chart=self, columns=columns, rows=rows, width=CHART_WIDTH, left=LEFT_MARGIN, right=PLOT_END, top=TOP_MARGIN,
                         foot=self.height - BOTTOM_MARGIN)


def ticks(low: float, high: float, count: int) -> np.ndarray:
    """About `count` round values from low to high: steps of 1, 2 or 5 times a power of ten."""
    step = round_step(0.999 * (high - low) / count)
    return np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1) * step


def _nonzero_range(pair):
    low, high = float(pair[0]), float(pair[1])
    return (low, high) if high > low else (low - 0.5, low + 0.5)


# A small map as a picture: a grey raster with lines and polygons over it.
#
# For reports only; a map to print is made by QGIS. Drawn by OpenCV, which the core needs anyway: matplotlib takes three times as long for such a
# picture and seconds to load. Colours are blue, green, red, as OpenCV takes them.

MAP_LONGEST_SIDE = 1800      # px
MAX_AVERAGED_SIDE = 500_000  # px; of longer rasters a road is narrower than a pixel of the picture
MAP_MARGIN = 3.0             # m around the layers

# What is drawn, from the bottom up: layer, condition (field, value) or None, colour, width (px), filled
MAP_STYLE = (
    ("markings", None, (80, 220, 255), 1, True),
    ("edges", ("status", "measured"), (60, 60, 230), 3, False),
    ("edges", ("status", "bridged"), (60, 150, 255), 3, False),
    ("edges", ("status", "inferred"), (120, 60, 200), 3, False),
    ("differences", None, (255, 60, 230), 7, False),
    ("marking_lines", None, (230, 200, 60), 2, False),
    ("driving_lines", ("status", "measured"), (90, 220, 60), 3, False),
    ("driving_lines", ("status", "bridged"), (60, 255, 190), 3, False),
    ("driving_lines", ("status", "inferred"), (220, 120, 200), 3, False),
)


@gdal_exceptions()
def grey_background(path: str, longest: int = MAP_LONGEST_SIDE) -> tuple[np.ndarray, tuple[float, float, float, float]] | None:
    """((H, W) uint8 grey, 0 where there is no data; its (min x, min y, max x, max y)) of a raster file, small, with stretched contrast.

    None of a raster of more than MAX_AVERAGED_SIDE.
    """
    dataset = open_raster(path)
    width, height = dataset.RasterXSize, dataset.RasterYSize
    if max(width, height) > MAX_AVERAGED_SIDE:
        return None
    scale = min(1.0, longest / max(width, height))
    columns, rows = max(int(width * scale), 1), max(int(height * scale), 1)
    band = dataset.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    data = band.ReadRaster(0, 0, width, height, columns, rows, gdal.GDT_Float32, resample_alg=gdal.GRIORA_Average)
    values = np.frombuffer(data, np.float32).reshape(rows, columns)
    empty = ~np.isfinite(values)
    if nodata is not None and np.isfinite(nodata):
        empty |= values == np.float32(nodata)
    x0, dx, _, y0, _, dy = place_of_raster(dataset)[0] or NO_PLACE
    extent = (x0, y0 + dy * height, x0 + dx * width, y0)
    grey = np.zeros(values.shape, np.uint8)
    if not empty.all():
        low, high = np.percentile(values[~empty], [1, 99.5])
        stretched = 1 + 254 * np.clip((values - low) / max(high - low, 1e-9), 0, 1)
        grey = np.where(empty, 0, np.nan_to_num(stretched)).astype(np.uint8)
    return grey, extent


def draw_map(layers: Mapping[str, Any], background: tuple[np.ndarray, Sequence[float]] | None = None, bounds: Sequence[float] | None = None,
             longest: int = MAP_LONGEST_SIDE, style: Sequence[tuple[Any, ...]] = MAP_STYLE, paper: int = 28) -> np.ndarray | None:
    """(H, W, 3) uint8 picture of layers over an image, None if there is nothing to draw.

    layers : Features by the names in `style`, which is like MAP_STYLE; missing ones are left out
    background : (grey image (H, W) uint8 with 0 where empty, (min x, min y, max x, max y)) or None
    bounds : (min x, min y, max x, max y), `longest` pixels at the longer side; by default those of the layers with a margin of 3 m
    paper : grey level where neither a layer nor the image covers the map
    """
    shapes = [g for features in layers.values() if features is not None for g in features.geometries if g is not None]
    if bounds is None:
        if not shapes:
            return None
        bounds = shapely.total_bounds(np.array(shapes, object)) + MAP_MARGIN * np.array([-1, -1, 1, 1])
    scale = longest / max(bounds[2] - bounds[0], bounds[3] - bounds[1])
    width, height = (max(int(np.ceil(side * scale)), 2) for side in (bounds[2] - bounds[0], bounds[3] - bounds[1]))
    canvas = np.full((height, width, 3), paper, np.uint8)
    if background is not None:
        _paste(canvas, *background, bounds, scale)
    for name, rule, colour, thickness, filled in style:
        for geometry, row in layers.get(name) or ():
            if geometry is not None and (rule is None or row.get(rule[0]) == rule[1]):
                _draw(canvas, geometry, bounds, scale, colour, thickness, filled)
    return canvas


def _paste(canvas, grey, extent, bounds, scale):
    """Put an image where it belongs on the canvas."""
    height, width = canvas.shape[:2]
    column = (bounds[0] + (np.arange(width) + 0.5) / scale - extent[0]) / (extent[2] - extent[0]) * grey.shape[1]
    row = (extent[3] - bounds[3] + (np.arange(height) + 0.5) / scale) / (extent[3] - extent[1]) * grey.shape[0]
    column_inside, row_inside = (column >= 0) & (column < grey.shape[1]), (row >= 0) & (row < grey.shape[0])
    part = grey[np.ix_(row[row_inside].astype(int), column[column_inside].astype(int))]
    target = canvas[np.ix_(row_inside, column_inside)]
    canvas[np.ix_(row_inside, column_inside)] = np.where(part[..., None] > 0, part[..., None], target)


def _draw(canvas, geometry, bounds, scale, colour, thickness, filled):
    shift = 4  # bits of sub-pixel position
    for part in getattr(geometry, "geoms", [geometry]):
        rings = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
        drawn = []
        for ring in rings:
            xy = shapely.get_coordinates(ring)
            xy = np.c_[(xy[:, 0] - bounds[0]) * scale, (bounds[3] - xy[:, 1]) * scale]
            drawn.append(np.rint(xy * 2**shift).astype(np.int32))
        if filled:
            cv2.fillPoly(canvas, drawn, colour, cv2.LINE_AA, shift)
        else:
            cv2.polylines(canvas, drawn, part.geom_type == "Polygon", colour, thickness, cv2.LINE_AA, shift)
