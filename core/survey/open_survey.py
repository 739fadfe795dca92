"""Opening a survey: it is read by whoever does the work, or taken from where an earlier run put it."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..execution.choice import ExecutionSettings, cluster_for, executor_for
from ..execution.phase import THREADS, Executor, digest
from ..execution.work_folder import Heard, KeptResults, WorkFolder, code_digest
from .las.reader import read_headers
from .las.samples import without_copies
from .read_survey import SharedReading, read_survey
from .store.spill_file import parts_are_whole
from .survey import SURVEY_FOLDER, Survey, SurveySettings, survey_in_folder

if TYPE_CHECKING:
    from .trajectory.trajectory import Trajectory


def open_survey(paths: Sequence[str | Path], trajectory: Trajectory, settings: SurveySettings = SurveySettings(),
                progress: Progress = Progress(), execution: ExecutionSettings = ExecutionSettings()) -> Survey:
    """Read a survey, or take what an earlier run read from the work folder.

    Parameters
    ----------
    paths : LAS, LAZ or COPC files in any order
    trajectory, settings, progress : as in `read_survey`
    execution : who runs the phases that read from the survey, and the work folder

    Returns
    -------
    Survey; closing its store ends everything that was started for it

    Raises
    ------
    RoadExtractionError
        As `read_survey`, and if the work folder or the cluster cannot be used.
    """
    work, cluster = execution.work, cluster_for(execution, progress)
    executor: Executor = cluster or THREADS
    try:
        files = without_copies(read_headers(paths, progress.warn, settings.crs or trajectory.crs), progress.warn)
        executor = executor_for(sum(file.count for file in files), execution, progress, cluster)
        read = files, trajectory, settings
        survey = _kept_survey(work, executor, read, progress) if work else _survey_of_run(executor, read, progress)
    except BaseException:
        executor.close()
        raise
    # what workers keep of reading is of no use to the stages that follow
    executor.forget()
    survey.executor, survey.store.at_close = executor, executor.close
    return survey


def _survey_of_run(executor, read, progress):
    """The survey, whose points lie where the workers of an executor see them; in memory for threads."""
    reading = _readers(executor, read[0], progress)
    if reading.folder is None:
        return read_survey(*read, progress)
    shared = SharedReading(reading, executor, reading.folder / "points", reading.folder / SURVEY_FOLDER)
    try:
        survey = read_survey(*read, progress, shared)
    except OSError as error:
        raise executor.disk_error(error) from error
    shutil.rmtree(shared.points, ignore_errors=True)
    return survey


def _readers(executor, files, progress):
    """Who reads the files: the workers, if they see them, else threads."""
    if executor.sees([Path(file.path).absolute() for file in files]):
        return executor
    progress.info("The workers do not see the point clouds where this computer does, which therefore reads them alone.")
    return THREADS


def _kept_survey(work, executor, read, progress):
    """The survey of a work folder; it is read into it where it is not there."""
    files, trajectory, settings = read
    states = [(os.path.abspath(file.path), os.path.getsize(file.path), os.stat(file.path).st_mtime_ns) for file in files]
    name = f"survey-{digest((code_digest(), states, trajectory, settings))}"
    try:
        found = _found_survey(work, name, files, progress)
        if found is not None:
            return found
        heard = Heard(progress)
        parts = WorkFolder(str(work.path / f"{name}.parts"))
        if not parts_are_whole(parts.path / "points"):
            parts.discard()
            parts = WorkFolder(str(parts.path))
        reading = KeptResults(_readers(executor.executor, files, progress), parts)
        shared = SharedReading(reading, executor.executor, parts.path / "points", work.begin(name))
        try:
            survey = read_survey(*read, heard, shared)
        except RoadExtractionError:
            # another run, which was quicker, has removed the parts
            found = _found_survey(work, name, files, progress)
            if found is None:
                raise
            return found
        work.finish(name, survey.folder, heard.messages)
        parts.discard()
        return survey
    except OSError as error:
        raise work.error(error) from error


def _found_survey(work, name, files, progress):
    """The survey that an earlier run put into a work folder; None where there is none."""
    found = work.finished(name)
    if found is None:
        return None
    folder, messages = found
    survey = survey_in_folder(str(folder))
    survey.files = files
    progress.info("The points were read by an earlier run and are taken from the work folder. It said:")
    for kind, text in messages:
        (progress.warn if kind == "warn" else progress.info)(text)
    progress.report(1.0)
    return survey
