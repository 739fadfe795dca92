"""A small HTML page: headings, numbers, tables and pictures, all in one file."""

import base64
import html

STYLE = """
body { font: 15px/1.5 "DejaVu Sans", "Segoe UI", Helvetica, Arial, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin-top: 2rem; border-bottom: 1px solid #ddd; }
table { border-collapse: collapse; margin: .6rem 0; } th, td { padding: .22rem .9rem .22rem 0; text-align: left; vertical-align: top; }
th { font-weight: 600; border-bottom: 1px solid #bbb; } td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
img { max-width: 100%; border: 1px solid #ccc; } .note { color: #555; } .warning { background: #fff3d6; padding: .4rem .8rem; }
svg { max-width: 100%; height: auto; }
.key { display: inline-block; width: 1.6rem; height: .5rem; margin: 0 .4rem 0 1rem; vertical-align: middle; }
"""


class Page:
    """Collects the parts of a report in order; `html()` gives the whole page. All texts are escaped."""

    def __init__(self, title, subtitle=""):
        self.title = title
        self.parts = [f"<h1>{html.escape(title)}</h1>"]
        if subtitle:
            self.note(subtitle)

    def heading(self, text):
        self.parts.append(f"<h2>{html.escape(text)}</h2>")

    def text(self, text):
        self.parts.append(f"<p>{html.escape(text)}</p>")

    def note(self, text):
        self.parts.append(f'<p class="note">{html.escape(text)}</p>')

    def warning(self, text):
        self.parts.append(f'<p class="warning">{html.escape(text)}</p>')

    def facts(self, rows):
        """A table of (name, value) without a head."""
        cells = "".join(f"<tr><td>{html.escape(str(name))}</td>{_cell(value)}</tr>" for name, value in rows)
        self.parts.append(f"<table>{cells}</table>")

    def table(self, head, rows, digits=()):
        """A table; numbers stand right, those of a column with `digits` (None: as number() likes) after the point."""
        rows = [list(row) for row in rows]
        right = [bool(rows) and all(isinstance(row[k], (int, float)) or row[k] is None for row in rows) for k in range(len(head))]
        top = "".join(f'<th{" class=number" if r else ""}>{html.escape(str(h))}</th>' for h, r in zip(head, right))
        digits = [*digits, *[None] * (len(head) - len(digits))]
        body = "".join(f"<tr>{''.join(_cell(value, places) for value, places in zip(row, digits))}</tr>" for row in rows)
        self.parts.append(f"<table><tr>{top}</tr>{body}</table>")

    def picture(self, png, caption=""):
        """A picture from the bytes of a PNG file."""
        data = base64.b64encode(png).decode("ascii")
        self.parts.append(f'<p><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}"></p>')
        if caption:
            self.note(caption)

    def drawing(self, svg, caption=""):
        """A chart as SVG text made by `chart`, which escapes what it writes."""
        self.parts.append(f"<p>{svg}</p>")
        if caption:
            self.note(caption)

    def colour_key(self, entries):
        """What the colours of a picture mean: (css colour, text)."""
        marks = "".join(f'<span class="key" style="background:{html.escape(colour)}"></span>{html.escape(text)}'
                        for colour, text in entries)
        self.parts.append(f"<p>{marks}</p>")

    def html(self):
        return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(self.title)}</title>'
                f"<style>{STYLE}</style></head><body>\n" + "\n".join(self.parts) + "\n</body></html>\n")


def _cell(value, digits=None):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return f"<td>{html.escape('–' if value is None else str(value))}</td>"
    shown = number(value) if digits is None or value != value else f"{value:.{digits}f}"
    return f'<td class="number">{shown}</td>'


def number(value):
    """A number as people read it: thousands apart, no more digits than mean something."""
    if value != value:
        return "–"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    size = abs(value)
    digits = 0 if size >= 1000 else 1 if size >= 100 else 2 if size >= 1 else 3
    return f"{value:,.{digits}f}".replace(",", "\u202f")
