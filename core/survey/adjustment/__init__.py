"""Several passes over one road, adjusted to each other.

In: a `Survey` whose passes disagree. Out: corrections along each pass, which are applied to its points and its track.
"""
