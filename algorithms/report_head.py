"""What a report says first: survey, files, CRS, time, version and settings of its run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.common.texts import told
from .texts import tr

if TYPE_CHECKING:
    from .algorithm import Algorithm
    from .provenance import Provenance

MOST_FILES = 5     # that are named
SUFFIXES = (".html", ".htm")


def sign_report(path: str, facts: Callable[[], list[tuple[str, str]]]) -> None:
    """Write the facts of a run below the title of an HTML report that is complete; files of other kinds stay as they are."""
    if Path(path).suffix.lower() in SUFFIXES:
        from ..products.report.page import with_facts

        Path(path).write_text(with_facts(Path(path).read_text(encoding="utf-8"), facts()), encoding="utf-8")


def run_facts(algorithm: Algorithm, survey: str, clouds: Sequence[str], crs: str, provenance: Provenance) -> list[tuple[str, str]]:
    """(name, value) of what tells a run from others; names of files without their folders, since a report is handed on.

    Parameters
    ----------
    algorithm : that ran
    survey : name of the survey
    clouds : paths of its point clouds
    crs : WKT of the results, "" where unknown
    provenance : of the run
    """
    files = [Path(path).name for path in clouds]
    named = ", ".join(files[:MOST_FILES]) + (tr(" and {count} more").format(count=len(files) - MOST_FILES) if len(files) > MOST_FILES else "")
    facts = [(tr("Survey"), survey), (tr("Point clouds"), named), *_inputs(algorithm, provenance.values), (tr("CRS"), _crs_name(crs)),
             (tr("Made"), f"{provenance.ended:%Y-%m-%d %H:%M} UTC, {provenance.program}"), (tr("Settings"), _settings(algorithm, provenance.values)),
             *((tr("Warning"), told(text)) for text in provenance.warnings)]
    return [(name, value) for name, value in facts if value]


def _inputs(algorithm, values):
    """Files and layers that were given, by the name of their parameter."""
    for spec in algorithm.inputs():
        value = values.get(spec.name)
        if spec.name != "POINT_CLOUDS" and not hasattr(spec, "field") and isinstance(value, str) and ("/" in value or "\\" in value):
            yield spec.label, value.replace("\\", "/").rsplit("/", 1)[-1]


def _settings(algorithm, values):
    """What was set otherwise than by default."""
    changed = [f"{spec.label}: {values[spec.name]}" for spec in algorithm.inputs()
               if hasattr(spec, "field") and spec.name in values and values[spec.name] not in (None, "", spec.default)]
    return "; ".join(changed) or tr("as they are by default")


def _crs_name(wkt):
    from ..core.io.crs import parse_crs

    return parse_crs(wkt).name if wkt else ""
