"""Reports as HTML: a template for each kind over one base page. Texts, numbers, tables and pictures are made in one way for all of them."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ...core.common.texts import language, told, tr, word
from ...core.lazy import cv2

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
    environment.globals.update(tr=tr, told=told, word=word, language=language, number=number, pick=_pick, collected=_Rows)
    environment.filters.update(shown=_shown, percent=percent, base64_png=_base64_png)
    environment.tests.update(figure=_is_figure, figures=_are_figures)
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
    return f"{value:,.{digits}f}".replace(",", "\u202f")


class _Rows(list):
    """The rows of a table, which a template adds one by one."""

    def add(self, *values: Any) -> str:
        self.append(values)
        return ""


def _is_figure(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _are_figures(rows: Sequence[Sequence[Any]], column: int) -> bool:
    return bool(rows) and all(row[column] is None or _is_figure(row[column]) for row in rows)


def _shown(value: Any, decimals: int | None = None) -> Any:
    """A value in a table: with so many decimals, or as `number` has it where they are None; a dash for None and NaN."""
    if value is None:
        return "–"
    if not _is_figure(value):
        return value
    return number(value) if decimals is None or value != value else f"{value:.{decimals}f}"


def percent(share: float) -> float | None:
    """A share as a percentage; None for NaN."""
    return None if share != share else 100.0 * share


def _pick(row: Any, names: str) -> list[Any]:
    """The values of fields, their names separated by spaces."""
    return [row.get(name) for name in names.split()]


def _base64_png(image: np.ndarray) -> str:
    """A picture (H, W, 3) uint8, blue, green, red, as the text of a PNG file."""
    return base64.b64encode(cv2.imencode(".png", image)[1].tobytes()).decode("ascii")
