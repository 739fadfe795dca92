"""The runs since QGIS was started, side by side: what a batch of surveys gave, and why some of them failed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from ..texts import tr

MOST_RUNS = 1000  # kept; a batch of more is read from its reports


@dataclass(frozen=True)
class RunRecord:
    """One run: its algorithm's title, survey, begin, seconds, numbers by label, why it failed ("" if it did not), warnings, and report or ""."""

    title: str
    survey: str
    began: datetime
    seconds: float
    numbers: Mapping[str, float]
    failure: str = ""
    warnings: tuple[str, ...] = ()
    report: str = ""


_runs: list[RunRecord] = []


def note_run(declaration: Any, survey: str, began: datetime, results: Mapping[str, Any] | None = None, failure: str = "",
             warnings: Sequence[str] = ()) -> None:
    """Remember a run that has just ended.

    Parameters
    ----------
    declaration : of the algorithm
    survey : what the survey is called, "" where there is none
    began : local time
    results : of the run, None where it failed
    failure : the sentence that it failed with
    warnings : as the log has them
    """
    numbers = {number.label: results[number.name] for number in declaration.numbers if results is not None and number.name in results}
    seconds = (datetime.now() - began).total_seconds()
    report = next((path for path in map(str, (results or {}).values()) if path.lower().endswith((".html", ".htm"))), "")
    _runs.append(RunRecord(declaration.title(), survey, began, seconds, numbers, failure, tuple(warnings), report))
    del _runs[:-MOST_RUNS]


def last_run() -> RunRecord | None:
    """The run that ended last; None where there was none."""
    return _runs[-1] if _runs else None


def last_report() -> str:
    """Path of the last report since QGIS was started; "" where there was none, or it is gone."""
    path = next((run.report for run in reversed(_runs) if run.report), "")
    return path if Path(path).is_file() else ""


def run_tables() -> list[tuple[str, list[str], list[list[Any]]]]:
    """(title, head, rows) of a table for every algorithm, with a row for each of its runs since QGIS was started."""
    tables = []
    for title in dict.fromkeys(run.title for run in _runs):
        runs = [run for run in _runs if run.title == title]
        labels = list(dict.fromkeys(label for run in runs for label in run.numbers))
        rows = [[f"{run.began:%Y-%m-%d %H:%M:%S}", run.survey or "–", *(run.numbers.get(label, "–") for label in labels),
                 round(run.seconds, 1), run.failure or "–"] for run in runs]
        tables.append((title, [tr("Begun"), tr("Survey"), *labels, tr("Duration (s)"), tr("Failed")], rows))
    return tables


def run_table() -> str:
    """An HTML page with these tables; "" where there was no run."""
    if not _runs:
        return ""
    from ...products.report.page import html_page

    return html_page("runs", tables=run_tables())
