"""The two exceptions that end a run early: unsuitable input, and cancellation by the user."""


class RoadExtractionError(Exception):
    """The input cannot be processed; the message says what was found, what is needed and what to try."""


class Cancelled(Exception):
    """The user cancelled the run; no result is written."""
