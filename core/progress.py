"""How a long computation tells how far it is, and learns that it shall stop."""


class Progress:
    """A silent listener; the shell's listener moves the bar, prints, and raises Cancelled.

    Every core function that takes longer than a blink has `progress` as its
    last argument. `at` may raise Cancelled, so call it once per section.
    """

    def at(self, fraction):
        """Report the fraction done, 0 to 1, of this computation."""

    def ask(self):
        """Raise Cancelled where the work shall stop; the bar stays where it is."""

    def say(self, text):
        """Report a finding or a step in one line."""

    def warn(self, text):
        """Report, once, what is doubtful, with a count."""

    def part(self, start, end):
        """A listener for one part of the work, from fraction `start` to `end`."""
        return _Part(self, start, end)


class _Part(Progress):
    def __init__(self, whole, start, end):
        self.whole, self.start, self.span = whole, start, end - start
        self.say, self.warn, self.ask = whole.say, whole.warn, whole.ask

    def at(self, fraction):
        self.whole.at(self.start + self.span * min(max(fraction, 0.0), 1.0))
