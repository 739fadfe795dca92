"""QGIS's progress bar and log as the listener that the core speaks to."""

from ..core.errors import Cancelled
from ..core.progress import Progress


class FeedbackProgress(Progress):
    """Moves the bar, prints, and raises Cancelled once the user pressed Cancel."""

    def __init__(self, feedback):
        self.feedback = feedback

    def at(self, fraction):
        if self.feedback.isCanceled():
            raise Cancelled
        self.feedback.setProgress(100.0 * fraction)

    def say(self, text):
        self.feedback.pushInfo(text)

    def warn(self, text):
        self.feedback.pushWarning(text)
