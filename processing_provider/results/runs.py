"""The run that results come from: its survey, its algorithm, and the name of the group they are shown in."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from qgis.core import QgsProcessingContext, QgsVariantUtils

GROUP = "Lanewright"
SURVEY_OF_RUN = "lanewright_survey"  # what the stages of a model tell each other through their common context


@dataclass(frozen=True)
class Run:
    """One run of an algorithm.

    algorithm : its id
    survey : name of the survey, "" where none is known
    group : name of the layer group
    clouds : absolute paths of the point clouds
    inputs : JSON of all that it was given, but for destinations
    """

    algorithm: str
    survey: str
    group: str
    clouds: tuple[str, ...] = ()
    inputs: str = ""


def run_of(algorithm: str, clouds: list[str], whole: bool, context: QgsProcessingContext, inputs: dict[str, Any] | None = None) -> Run:
    """The run that has just ended.

    Parameters
    ----------
    algorithm : id
    clouds : paths of its point clouds; none for a stage that starts from another's result
    whole : whether it makes a map in one call. Each such run has a group of its own, named by survey and time;
        the stages of a survey share one, since together they make one map
    context : of the run; the stages of a model have one in common
    inputs : what it was given, as JSON holds it; kept where the run makes a map in one call
    """
    store = context.temporaryLayerStore()  # an object of Qt, which keeps a value for whoever comes next
    survey = survey_name(clouds) or str(store.property(SURVEY_OF_RUN) or "")
    store.setProperty(SURVEY_OF_RUN, survey)
    name = survey or GROUP
    return Run(algorithm, survey, f"{name}, {datetime.now():%Y-%m-%d %H:%M:%S}" if whole else name,
               tuple(str(Path(path).absolute()) for path in clouds), _as_json(inputs) if whole and inputs else "")


def _as_json(inputs):
    """What was given, without what was left empty: None, or in a batch a NULL of QGIS."""
    return json.dumps({name: value for name, value in inputs.items() if not QgsVariantUtils.isNull(value)}, default=str)


def survey_name(clouds: list[str]) -> str:
    """What a survey is called: the folder of its point clouds and what their names have in common, such as B12/tile."""
    stems = [Path(path).stem.removesuffix(".copc") for path in clouds]
    folders = {Path(path).absolute().parent for path in clouds}
    folder = folders.pop().name if len(folders) == 1 else ""
    name = os.path.commonprefix(stems).rstrip("_-. 0123456789") if len(set(stems)) > 1 else "".join(stems[:1])
    return "/".join(part for part in dict.fromkeys((folder, name)) if part)
