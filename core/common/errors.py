"""The two ways a run ends early: the input is not fit, or the user stopped it."""


class RoadExtractionError(Exception):
    """The input cannot be worked with: what we saw, what we needed, what to try."""


class Cancelled(Exception):
    """The user pressed Cancel; nothing is to be written."""
