"""The run that results come from: its survey, its algorithm, and the name of the group they are shown in."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from qgis.core import QgsProcessingContext

from ...algorithms.provenance import Provenance
from ...algorithms.survey_files import survey_name

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

    Parameters
    ----------
    provenance : of the run
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
