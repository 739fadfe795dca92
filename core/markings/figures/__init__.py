"""Paint compared with drawn figures, such as bicycles and words.

In: painted cells, and a figure of the country catalogue. Out: how well they agree, and where the figure lies.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "match": ("Agreement", "PaintImage", "agreement"),
})
