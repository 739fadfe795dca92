"""What the dialog shows while an algorithm works."""

import pytest
from lanewright.core.errors import Cancelled
from lanewright.core.remaining_time import RemainingTime
from lanewright.processing_provider.progress import FeedbackProgress, time_left
from qgis.core import QgsProcessingFeedback


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
        progress.at(step / 1000)
    assert dialog.texts == ["About 3 min left", "About 2 min left", "About 1 min left", "About 40 s left", "About 20 s left",
                            "About 10 s left"]
    assert dialog.progress() == pytest.approx(100.0)


def test_long_times_are_told_in_hours():
    assert [time_left(seconds) for seconds in (40, 60, 2700, 3600, 18000)] == [
        "About 40 s left", "About 1 min left", "About 45 min left", "About 1 h left", "About 5 h left"]


def test_cancel_is_raised_at_the_next_question(qgis_app):
    dialog = Dialog()
    progress = FeedbackProgress(dialog)
    progress.at(0.1)
    dialog.cancel()
    with pytest.raises(Cancelled):
        progress.at(0.2)
