"""The words of choices in the user's language; commands and models keep those that are written here."""

from .texts import languages, tr

NAMES = ("scanner_channel", "point_source_id", "1.7", "1.8", "dxf", "landxml", "A4", "A3", "A2", "A1", "A0", "1:100", "1:200", "1:250", "1:500",
         "1:1000", "1:2000", "1:2500", "1:5000", *languages())  # of fields and formats: alike in every language
CHOICES = ("automatic", "gps", "adjusted", "week", "day", "street", "rural", "urban", "one-lane", "wide-lane", "no-centre-line",
           "hatched-island", "motorway", "serpentine", "crossing", "roundabout", "outskirts", "cycle-lanes", "intensity", "rgb", "profiles",
           "scanlines", "both", "linear", "logarithmic", "multi-threshold", "intensity-peaks", "point-segments", "all", "windows", "neutral",
           "china", "germany", "japan", "united-states", "line", "circle", "ellipse", "clothoid", "polynomial", "b-spline", "right", "left",
           "nonurban", "half-width", "total-width", "draw", "leave-out", "bilinear", "nearest", "cubic", "curbs", "landscape", "portrait")


def choice_word(choice):
    """What a dialog shows for a choice."""
    return choice if choice in NAMES else tr(choice)
