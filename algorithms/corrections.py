"""The layer CORRECTIONS as an input: points, lines or a table, of whatever program."""

from __future__ import annotations

from ..core.common.errors import RoadExtractionError
from ..core.common.features import CORRECTIONS, Features
from .texts import tr

NEEDED = ("action", "target")


def add_corrections(algorithm):
    algorithm.add_input("layer", "CORRECTIONS", tr("Corrections"),
                        tr("What an analyst decided at doubtful places: points or lines with the fields action (accept, delete, move, draw, take) "
                           "and target (edge, marking, lane). Further fields: note; kind and pattern of a line that is drawn; other of a second "
                           "reading that is taken. A row concerns what this run finds within half a metre of it, whatever its number; for lanes it "
                           "is one metre, for move two. A row without geometry lies at its road, station_m and offset_m. What matches nothing is "
                           "listed in log and report. The window of doubtful places writes this layer."), optional=True, advanced=True)


def corrections_of(call):
    """The layer as Features; None where none was given."""
    source = call.source("CORRECTIONS")
    return None if source is None else read_corrections(source)


def read_corrections(source):
    """A VectorSource as Features with the fields of CORRECTIONS, of which only `action` and `target` have to be there.

    Raises RoadExtractionError if one of these two is missing.
    """
    import shapely

    index = {name.lower(): k for k, name in enumerate(source.names)}
    missing = [name for name in NEEDED if name not in index]
    if missing:
        raise RoadExtractionError(tr("{label} lacks the field(s) {fields}. Make the layer with the buttons of the window of doubtful places, or "
                                     "give it the fields action and target.").format(label=source.label, fields=", ".join(missing)))
    columns = [column for column in CORRECTIONS if column.name in index]
    result = Features("any", list(CORRECTIONS), crs=source.crs)
    for wkb, values in source.rows(check_validity=False):
        row = {column.name: values[index[column.name]] for column in columns}
        result.add(None if wkb is None else shapely.from_wkb(wkb), **row)
    return result
