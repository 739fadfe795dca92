"""A report as one HTML file: headings, texts, tables and pictures. Its looks are in `templates/page.html`."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..common.texts import language

_END_OF_TITLE = "</h1>"
TEMPLATES = Path(__file__).parent / "templates"


class Page:
    """Collects the blocks of a report in order; `html()` returns the whole page. All texts are escaped."""

    def __init__(self, title: str, subtitle: str = "") -> None:
        self.title = title
        self.blocks: list[dict[str, Any]] = []
        if subtitle:
            self.note(subtitle)

    def heading(self, text: str) -> None:
        """A heading."""
        self._add("heading", text=text)

    def text(self, text: str) -> None:
        """A paragraph."""
        self._add("text", text=text)

    def note(self, text: str) -> None:
        """A paragraph of less weight, such as a caption."""
        self._add("note", text=text)

    def warning(self, text: str) -> None:
        """A highlighted paragraph."""
        self._add("warning", text=text)

    def facts(self, rows: Iterable[tuple[str, Any]]) -> None:
        """A table of (name, value) without a head."""
        self._add("table", head=(), rows=[(_Cell(str(name)), _cell(value)) for name, value in rows])

    def table(self, head: Sequence[str], rows: Iterable[Sequence[Any]], digits: Sequence[int | None] = ()) -> None:
        """A table; columns of numbers are aligned to the right.

        Parameters
        ----------
        head : names of the columns
        rows : of str, int, float or None (shown as a dash)
        digits : decimals of each column; None or a missing one: as many as `number` gives
        """
        rows = [list(row) for row in rows]
        numeric = [bool(rows) and all(isinstance(row[k], (int, float)) or row[k] is None for row in rows) for k in range(len(head))]
        digits = [*digits, *[None] * (len(head) - len(digits))]
        self._add("table", head=[_Cell(str(name), right) for name, right in zip(head, numeric)],
                  rows=[[_cell(value, decimals) for value, decimals in zip(row, digits)] for row in rows])

    def picture(self, png: bytes, caption: str = "") -> None:
        """A picture from the bytes of a PNG file."""
        self._add("picture", text=caption, data=base64.b64encode(png).decode("ascii"))
        if caption:
            self.note(caption)

    def drawing(self, svg: str, caption: str = "") -> None:
        """A chart as SVG text from `Chart.svg`, which escapes its own texts."""
        self._add("drawing", svg=svg)
        if caption:
            self.note(caption)

    def colour_key(self, entries: Iterable[tuple[str, str]]) -> None:
        """The meaning of the colours of a picture: (CSS colour, text)."""
        self._add("colour_key", entries=list(entries))

    def html(self) -> str:
        """The whole page."""
        return _template().render(title=self.title, blocks=self.blocks, language=language())

    def _add(self, kind: str, **content: Any) -> None:
        self.blocks.append({"kind": kind, **content})


@dataclass(frozen=True)
class _Cell:
    """A cell of a table."""

    text: str
    is_number: bool = False


def _cell(value: Any, decimals: int | None = None) -> _Cell:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return _Cell("–" if value is None else str(value))
    return _Cell(number(value) if decimals is None or value != value else f"{value:.{decimals}f}", True)


@lru_cache(maxsize=1)
def _template() -> Any:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # only when a report is written: QGIS starts no slower

    loader = FileSystemLoader(str(TEMPLATES))
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined, keep_trailing_newline=True).get_template("page.html")


def with_facts(html: str, rows: Iterable[tuple[str, str]]) -> str:
    """A page of `Page.html` with a table of (name, value) below its title; another page stays as it is."""
    from markupsafe import escape

    table = "".join(f"<tr><td>{escape(name)}</td><td>{escape(value)}</td></tr>\n" for name, value in rows)
    return html.replace(_END_OF_TITLE, f"{_END_OF_TITLE}\n<table>\n{table}</table>", 1)


def number(value: float) -> str:
    """A number for readers: thousands separated, about three significant digits, a dash for NaN."""
    if value != value:
        return "–"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    size = abs(value)
    digits = 0 if size >= 1000 else 1 if size >= 100 else 2 if size >= 1 else 3
    return f"{value:,.{digits}f}".replace(",", "\u202f")
