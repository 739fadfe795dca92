"""How much work a function does, counted and not timed."""

import sys
from collections import Counter


def calls(function):
    """How many calls of Python and of compiled functions a piece of work takes."""
    counted = Counter()
    sys.setprofile(lambda frame, event, _: counted.update([event]))
    try:
        function()
    finally:
        sys.setprofile(None)
    return counted["call"] + counted["c_call"]
