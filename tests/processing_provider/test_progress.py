"""What the dialog shows while an algorithm works."""

import gc
import weakref

import pytest
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import RemainingTime
from lanewright.processing_provider.call import FeedbackProgress, time_left
from qgis.core import QgsApplication, QgsProcessingContext, QgsProcessingFeedback


class Dialog(QgsProcessingFeedback):
    def __init__(self):
        super().__init__(False)
        self.texts = []

    def setProgressText(self, text):
        self.texts.append(text)


def test_the_time_left_is_told_a_few_times_while_the_bar_moves(qgis_app):
    dialog, now = Dialog(), [0.0]
    progress = FeedbackProgress(dialog, RemainingTime(lambda: now[0])).part(0.0, 1.0)
    for step in range(1001):
        now[0] = 0.2 * step
        progress.report(step / 1000)
    assert dialog.texts == ["About 3 min left", "About 2 min left", "About 1 min left", "About 40 s left", "About 20 s left",
                            "About 10 s left"]
    assert dialog.progress() == pytest.approx(100.0)


def test_long_times_are_told_in_hours():
    assert [time_left(seconds) for seconds in (40, 60, 2700, 3600, 18000)] == [
        "About 40 s left", "About 1 min left", "About 45 min left", "About 1 h left", "About 5 h left"]


def test_cancel_is_raised_at_the_next_question(qgis_app):
    dialog = Dialog()
    progress = FeedbackProgress(dialog)
    progress.report(0.1)
    dialog.cancel()
    with pytest.raises(Cancelled):
        progress.report(0.2)


@pytest.mark.parametrize("end", [Cancelled(), RoadExtractionError("The road ends here."), OSError(28, "No space left on device", "map.gpkg")])
def test_a_run_that_ends_early_leaves_nothing_in_memory(provider, monkeypatch, end):
    """QGIS keeps every exception for ever, and with it what its frames held."""

    class Survey:
        pass

    held = []

    def work(self, call, progress):
        survey = Survey()
        held.extend([weakref.ref(survey), weakref.ref(call)])
        raise type(end)(*end.args)

    algorithm = QgsApplication.processingRegistry().createAlgorithmById("lanewright:samplesurvey")
    monkeypatch.setattr(type(algorithm.declaration), "work", work)
    dialog = QgsProcessingFeedback(False)
    _, fine = algorithm.run({}, QgsProcessingContext(), dialog)
    gc.collect()
    assert not fine and (str(end.args[-1]) if end.args else "Cancelled") in dialog.textLog()
    assert [reference() for reference in held] == [None, None]
