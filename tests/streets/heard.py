"""What a run says, kept for the tests."""

from lanewright.core.common.progress import Progress


class Heard(Progress):
    """Keeps what was said, and what was warned of."""

    def __init__(self):
        self.said, self.warned = [], []

    def info(self, text):
        self.said.append(text)

    def warn(self, text):
        self.warned.append(text)

    def says(self, text):
        """Whether a line that was said or warned of holds a text."""
        return any(text in line for line in self.said + self.warned)
