"""How long a run will still take, in words, and how often it warned."""

from ..core.common.progress import Progress
from .texts import tr


class CountedWarnings(Progress):
    """Hands everything on to another listener and keeps the warnings, in the words of the core."""

    def __init__(self, listener):
        self.listener = listener
        self.texts: list[str] = []

    def report(self, fraction):
        self.listener.report(fraction)

    def check_cancelled(self):
        self.listener.check_cancelled()

    def info(self, text):
        self.listener.info(text)

    def warn(self, text):
        self.texts.append(text)
        self.listener.warn(text)


def time_left(seconds):
    """What the user reads, in the unit that gives a small number."""
    if seconds < 60:
        return tr("About {number} s left").format(number=round(seconds))
    if seconds < 3600:
        return tr("About {number} min left").format(number=round(seconds / 60))
    return tr("About {number} h left").format(number=round(seconds / 3600))
