"""The words of choices in the user's language; commands and models keep those that are written here on the left."""

from .texts import tr

NAMES = ("scanner_channel", "point_source_id", "1.7", "1.8", "dxf", "landxml")  # of fields and formats: alike in every language
CHOICE_WORDS = {
    "automatic": tr("automatic"), "gps": tr("gps"), "adjusted": tr("adjusted"), "week": tr("week"), "day": tr("day"), "street": tr("street"),
    "rural": tr("rural"), "urban": tr("urban"), "one-lane": tr("one-lane"), "wide-lane": tr("wide-lane"), "no-centre-line": tr("no-centre-line"),
    "hatched-island": tr("hatched-island"), "motorway": tr("motorway"), "serpentine": tr("serpentine"), "crossing": tr("crossing"),
    "roundabout": tr("roundabout"), "outskirts": tr("outskirts"), "cycle-lanes": tr("cycle-lanes"), "intensity": tr("intensity"),
    "rgb": tr("rgb"),
    "profiles": tr("profiles"), "scanlines": tr("scanlines"), "both": tr("both"), "linear": tr("linear"), "logarithmic": tr("logarithmic"),
    "multi-threshold": tr("multi-threshold"),
    "intensity-peaks": tr("intensity-peaks"), "point-segments": tr("point-segments"), "all": tr("all"), "windows": tr("windows"),
    "neutral": tr("neutral"), "china": tr("china"), "germany": tr("germany"), "japan": tr("japan"), "united-states": tr("united-states"),
    "line": tr("line"), "circle": tr("circle"), "ellipse": tr("ellipse"), "clothoid": tr("clothoid"), "polynomial": tr("polynomial"),
    "b-spline": tr("b-spline"), "right": tr("right"), "left": tr("left"), "nonurban": tr("nonurban"), "half-width": tr("half-width"),
    "total-width": tr("total-width"), "draw": tr("draw"), "leave-out": tr("leave-out"), "bilinear": tr("bilinear"), "nearest": tr("nearest"),
    "cubic": tr("cubic"), "curbs": tr("curbs"),
}


def choice_word(choice):
    """What a dialog shows for a choice."""
    return CHOICE_WORDS.get(choice, choice)
