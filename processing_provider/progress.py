"""QGIS's progress bar and log as the listener that the core speaks to."""

from ..algorithms.call import time_left
from ..core.common.errors import Cancelled
from ..core.common.progress import Progress, RemainingTime
from .texts import told


class FeedbackProgress(Progress):
    """Moves the bar, prints, tells how long it will still take, and raises Cancelled once the user pressed Cancel."""

    def __init__(self, feedback, remaining=None):
        self.feedback = feedback
        self._remaining = remaining or RemainingTime()

    def check_cancelled(self):
        if self.feedback.isCanceled():
            raise Cancelled

    def report(self, fraction):
        self.check_cancelled()
        self.feedback.setProgress(100.0 * fraction)
        left = self._remaining.after(fraction)
        if left is not None:
            self.feedback.setProgressText(time_left(left))

    def info(self, text):
        self.feedback.pushInfo(told(text))

    def warn(self, text):
        self.feedback.pushWarning(told(text))
