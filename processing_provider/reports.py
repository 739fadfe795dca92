"""The report that a run of this QGIS wrote last, for the menu."""

from __future__ import annotations

from pathlib import Path

_last = ""


def note_report(path: str) -> None:
    """Remember the HTML report of a run that has just ended."""
    global _last
    if str(path).lower().endswith((".html", ".htm")):
        _last = str(path)


def last_report() -> str:
    """Path of the last report since QGIS was started; "" where there was none, or it is gone."""
    return _last if _last and Path(_last).is_file() else ""
