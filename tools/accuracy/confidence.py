"""How often a lane is right that says how sure it is."""

import numpy as np
import shapely

from .streets import BROAD, distance, in_a_true_lane, sampled

BINS = (0.0, 0.5, 0.7, 0.85, 0.95, 1.001)   # of the confidence that a piece of lane has


def confidence_figures(case, track, lanes):
    """{bin of BINS: (places that are right, places in all, sum of their confidence)} of driving lines.

    A place is right where it lies within 15 cm of a true driving line. What is drawn on the track where the truth has no lanes is left out,
    as in streets.driving_figures.

    Parameters
    ----------
    case : Case whose truth has driving lines
    track : (N, 2) m, the trajectory
    lanes : [(shapely line, row with `confidence`), ...]
    """
    road = shapely.LineString(track)
    found = {}
    for line, row in lanes:
        places, _ = sampled([line], case.truth.area)
        if not len(places) or row.get("confidence") is None:
            continue
        off = distance(places, case.truth.driving)
        counted = in_a_true_lane(places, off, case.truth.driving, road)
        key = str(int(np.searchsorted(BINS, row["confidence"], side="right")) - 1)
        right, number = float((off[counted] <= BROAD).sum()), float(counted.sum())
        found[key] = tuple(np.add(found.get(key, (0.0, 0.0, 0.0)), (right, number, number * row["confidence"])).tolist())
    return found
