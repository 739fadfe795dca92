"""Paint compared with drawn figures, such as bicycles and words, and lines that together are a figure: parking bays.

In: painted cells and a figure of the country catalogue, or markings. Out: how well they agree and where the figure lies, or rows of lines.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
})
