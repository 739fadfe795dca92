"""What each kind of evidence brings to the estimate of lines and lanes, and how often a lane is right that says how sure it is.

Each kind is left out in turn by setting what it weighs to nothing, or to a value that tells no cross-section from another; the stages before
the estimate are not run again, but for what tells where lines go on.
"""

from contextlib import ExitStack
from dataclasses import replace
from functools import partial

import numpy as np
import shapely
from lanewright.core.countries.neutral import NEUTRAL
from lanewright.core.driving.driving_lines import make_driving_lines
from lanewright.core.driving.layers import driving_lines_to_features
from lanewright.core.markings.cross_section.roads import estimate_roads
from lanewright.core.markings.cross_section.weights import EstimateWeights
from lanewright.core.markings.lines.edges_beside import edges_beside
from lanewright.core.markings.lines.fit import fit_marking_lines
from lanewright.core.markings.lines.naming import named_by_estimate

from .chain import swapped
from .streets import BROAD, distance, driving_figures, in_a_true_lane, sampled

ALIKE = (1.0, 1.0, 1.0, 1.0)
WITHOUT_CURBS = "curbs"
WITHOUT_EDGES_BESIDE = "edges beside lines"

# What is left out, and how; a name of an argument is what the estimate is not given
EVIDENCE = {
    "where and which way the vehicle drove": dict(driven_rest=0.0, driven_against=0.0, driven_astride=0.0),
    "curbs": WITHOUT_CURBS,
    "asphalt where no lane is (unused), and lanes beside the asphalt": dict(
        unused_asphalt=(0.0, 0.0), unused_wide=0.0, off_asphalt=0.0, lane_through_surface=0.0),
    "no lane over a painted line": dict(lane_through_paint=0.0, paint_in_rest=0.0),
    "how lines are drawn (solid, dashed, double)": dict(
        solid=ALIKE, dashed=ALIKE, double=ALIKE, wide_solid=ALIKE, wide_dashed=ALIKE, short_dashed=ALIKE, dashed_between_many=0.0),
    "no border between lanes without paint": dict(unpainted_divider=0.0, unpainted_lane_line=0.0),
    "widths of lanes": dict(other_width=0.0, odd_width=1.0),
    "hatched areas": dict(hatched_lane=0.0, lane_through_hatching=0.0),
    "where arrows lie": dict(arrow_outside=0.0),
    "which way arrows point": dict(arrow_against=0.0),
    "stop lines": dict(split_stop=0.0),
    "which way arrows point, and stop lines": dict(arrow_against=0.0, split_stop=0.0),
    "what is usual: how many lanes lead which way": dict(one_way=(0.0,) * 4, uneven=0.0, two_and_one=0.0),
    "another carriageway driven beside this one": dict(two_way_carriageway=0.0),
    "traffic keeps to its side": dict(wrong_side=0.0, left_hand=0.0),
    "lanes go on along the road": dict(change=0.0, turn=0.0, divider_change=0.0),
    "edges of the road beside lines, where these are linked and led on": WITHOUT_EDGES_BESIDE,
}
BINS = (0.0, 0.5, 0.7, 0.85, 0.95, 1.001)   # of the confidence that a piece of lane has


def evidence_figures(case, track, work):
    """{"": figures with everything, what is left out: figures without it, ...}, each as streets.driving_figures gives them.

    Parameters
    ----------
    case : Case whose truth has driving lines
    track : (N, 2) m, the trajectory
    work : Work of the whole chain
    """
    return {name: driving_figures(case.truth, track, list(_lanes_without(change, work).geometries))
            for name, change in {"": {}, **EVIDENCE}.items()}


def _lanes_without(change, work):
    """Features of the driving lines where some evidence is left out."""
    weights = EstimateWeights() if isinstance(change, str) else replace(EstimateWeights(), **change)
    estimate = partial(estimate_roads, weights=weights)
    edges = None if change == WITHOUT_CURBS else work.edges.densified(work.frame)
    with ExitStack() as stack:
        for module in ("markings.lines.naming", "driving.driving_lines"):
            stack.enter_context(swapped(module, "estimate_roads", estimate))
        drawn = work.lines if change != WITHOUT_EDGES_BESIDE else _lines_alone(work, edges)
        # what was named with all evidence must not tell now
        unnamed = replace(drawn, kind=np.full(len(drawn), "", object))
        lines = named_by_estimate(unnamed, work.frame, NEUTRAL.usual_lane, work.marking_objects, edges, work.bright, work.clustered)
        lanes, *_ = make_driving_lines(lines, work.frame, markings=work.marking_objects, edges=edges, road_points=work.bright)
    return driving_lines_to_features(lanes, work.frame)


def _lines_alone(work, edges):
    """Marking lines that are linked and led on without what is known of the edges of the road beside them."""
    with swapped("markings.lines.fit", "edges_beside", lambda _, roads: edges_beside(None, roads)):
        return fit_marking_lines(work.clustered, work.marking_objects, work.frame, edges=edges, road_points=work.bright)


def confidence_figures(case, track, lanes):
    """{bin of BINS: (places that are right, places in all, sum of their confidence)} of driving lines.

    A place is right where it lies within 15 cm of a true driving line. What is drawn on the track where the truth has no lanes is left out,
    as in streets.driving_figures.

    Parameters
    ----------
    case, track : as in evidence_figures
    lanes : [(shapely line, row with `confidence`), ...]
    """
    road = shapely.LineString(track)
    found = {}
    for line, row in lanes:
        places, _ = sampled([line], case.truth.area)
        if not len(places) or row.get("confidence") is None:
            continue
        off = distance(places, case.truth.driving)
        counted = in_a_true_lane(places, off, road)
        key = str(int(np.searchsorted(BINS, row["confidence"], side="right")) - 1)
        right, number = float((off[counted] <= BROAD).sum()), float(counted.sum())
        found[key] = tuple(np.add(found.get(key, (0.0, 0.0, 0.0)), (right, number, number * row["confidence"])).tolist())
    return found
