"""How long a run will still take, in words."""

from .texts import tr


def time_left(seconds):
    """What the user reads, in the unit that gives a small number."""
    if seconds < 60:
        return tr("About {number} s left").format(number=round(seconds))
    if seconds < 3600:
        return tr("About {number} min left").format(number=round(seconds / 60))
    return tr("About {number} h left").format(number=round(seconds / 3600))
