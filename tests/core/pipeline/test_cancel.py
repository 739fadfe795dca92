"""Cancel is asked for often enough, in every stage, however long the road is."""

import threading
from collections import Counter

import pytest
from lanewright.core.common.errors import Cancelled
from lanewright.core.common.parallel import cancellation_scope
from lanewright.core.common.progress import Progress
from lanewright.core.pipeline import road_map as chain
from lanewright.core.pipeline.road_map import STAGE_NAMES, RoadMapSettings, make_road_map
from lanewright.core.survey.open_survey import SurveySettings

pytestmark = pytest.mark.slow

SHORT, LONG = 24.0, 72.0   # m
SECTION = 5.0               # m of a section of the store, as on dense streets: longer ones hold no more points than these do there


class Questions(Progress):
    """Counts how often each stage asks, in the caller and in threads that work for it; cancels at a question of the caller if it is told to."""

    def __init__(self, last=None):
        self.asked, self.by_threads, self.stage, self.last = Counter(), Counter(), "", last

    def check_cancelled(self):
        if self.asked.total() == self.last:
            raise Cancelled
        self.asked[self.stage] += 1

    def counting(self):
        """What holds the question of each thread; it counts those of other threads than the caller's."""
        questions = self

        class Held(threading.local):
            def __setattr__(self, name, check):
                def counted():
                    questions.by_threads[questions.stage] += 1
                    check()

                super().__setattr__(name, counted if threading.current_thread() is not threading.main_thread() else check)

        return Held()

    def report(self, fraction):
        self.check_cancelled()


def questions(monkeypatch, survey, folder, last=None):
    sample, cloud = survey
    found = Questions(last)
    run = chain.Stages.run

    def noted(self, name, *arguments, **options):
        found.stage = name
        return run(self, name, *arguments, **options)

    with monkeypatch.context() as patch:
        patch.setattr(chain.Stages, "run", noted)
        patch.setattr("lanewright.core.common.parallel._thread", found.counting())
        patch.setattr("lanewright.core.common.parallel.POLL_INTERVAL", 60.0)  # no question depends on the machine's speed
        with cancellation_scope(found):
            make_road_map([cloud], sample.trajectory, folder / "image.tif", RoadMapSettings(survey=SurveySettings(section_length=SECTION)), found)
    return found.asked, found.by_threads


@pytest.fixture(scope="module")
def streets(made_survey):
    return [made_survey(length=length, pulse_rate=40_000.0, rotation_rate=60.0) for length in (SHORT, LONG)]


@pytest.fixture(scope="module")
def asked(streets, tmp_path_factory):
    folder = tmp_path_factory.mktemp("maps")
    with pytest.MonkeyPatch.context() as patch:
        return [questions(patch, street, folder) for street in streets]


def test_no_stretch_without_a_question_grows_with_the_road(asked):
    """Three times the road is asked about far more often in every stage, though some look at as many samples of any road."""
    short, long = (by_caller + by_threads for by_caller, by_threads in asked)
    few = {stage: (short[stage], long[stage]) for stage in long if stage not in ("survey", "corrected") and long[stage] < 1.5 * short[stage]}
    assert not few
    assert set(long) == set(STAGE_NAMES)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.99])
def test_cancel_at_any_question_ends_the_work_there_and_leaves_nothing_unfinished(streets, asked, share, tmp_path, monkeypatch):
    last = int(share * asked[0][0].total())
    with pytest.raises(Cancelled):
        questions(monkeypatch, streets[0], tmp_path, last)
    assert {path.name for path in tmp_path.iterdir()} <= {"image.tif"}
