"""The run that results come from, and the table of all runs since QGIS was started."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from qgis.core import QgsProcessingContext

from ...algorithms.provenance import Provenance
from ...algorithms.survey_files import survey_name
from ..texts import tr

GROUP = "Lanewright"
SURVEY_OF_RUN = "lanewright_survey"  # what the stages of a model tell each other through their common context


@dataclass(frozen=True)
class Run:
    """One run of an algorithm."""

    provenance: Provenance   # what its layers say of it
    survey: str   # name of the survey, "" where none is known
    group: str   # name of the layer group, "" for none


def run_of(provenance: Provenance, clouds: list[str], whole: bool, context: QgsProcessingContext, group: str | None = None) -> Run:
    """The run that has just ended.

    clouds : paths of its point clouds; none for a stage that starts from another's result
    whole : whether it makes a map in one call. Each such run has a group of its own, named by time and survey;
        the stages of a survey share one, since together they make one map
    context : of the run; the stages of a model have one in common
    group : that its inputs stand in, "" where they stand in none; a stage puts its result beside them. None where they are no layers of ours
    """
    store = context.temporaryLayerStore()  # an object of Qt, which keeps a value for whoever comes next
    survey = survey_name(clouds) or str(store.property(SURVEY_OF_RUN) or "")
    store.setProperty(SURVEY_OF_RUN, survey)
    name = survey or GROUP
    return Run(provenance, survey, f"{datetime.now():%m-%d %H:%M:%S} {name}" if whole else name if group is None else group)


# The runs since QGIS was started, side by side: what a batch of surveys gave, and why some of them failed.

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
    """Remember a run that has just ended: when it began by local time, its results or the sentence that it failed with, its warnings."""
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
