"""Arrows on the road: in which lane they lie and which way they point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from ...countries.neutral import NEUTRAL
from ...survey.frame.placement import located

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame
    from ..objects.marking_objects import MarkingObjects

SHORTEST_ARROW = 2.0  # m along the road, of a lane of a road (Convention on Road Signs and Signals, Vienna 1968, annex 2, 39)
WORN_ENDS = 0.1       # m that an arrow may look shorter than it was painted
SLICES = 50           # of an arrow from end to end, whose breadth is taken
SHAFT_BREADTH = 0.36  # m, of a single stroke at most: shafts are 0.10 to 0.20 m broad, and a cell more on either side; heads begin at 0.5 m
POINTED = 0.03         # of the length: the tip gets broad in a longer way than the end of a letter, which is as broad as the letter
SURE_LEAN = 0.15      # of the length by which the shaft must be longer than the tip to be sure which is which; painted arrows have 0.15 to 0.5


def arrows_of(markings: MarkingObjects, frame: RoadFrame, road: int) -> np.ndarray:
    """Where arrows lie and which way they point.

    An arrow begins with a bare shaft and soon is broad behind its tip, so it points to the end at which less of it is a single stroke. That
    is read from the painted outline alone. Shorter arrows than a lane of a road has belong to cycle paths or are none.

    Parameters
    ----------
    markings : MarkingObjects
    frame : RoadFrame
    road : number of the road

    Returns
    -------
    (A, 3) station and offset of the middle, m, and which way it points: 1 along the road, -1 against it, nearer 0 the less that shows
    """
    rows = np.flatnonzero((markings.road == road) & (markings.kind == "arrow") & np.isfinite(markings.extent[:, 0]))
    if not len(rows):
        return np.empty((0, 3))
    # the parts that wear left of an arrow are one arrow
    cluster = markings.cluster[rows]
    _, of = np.unique(np.where(cluster >= 0, cluster, -2 - np.arange(len(rows))), return_inverse=True)
    parts = shapely.force_2d(markings.outlines.polygons()[rows])
    parts = shapely.transform(parts, lambda places: np.column_stack(located(frame, np.full(len(places), road), *places.T)))
    places, owner = shapely.get_coordinates(parts, return_index=True)
    # some may lie beyond what the road reaches
    known = np.bincount(owner, ~np.isfinite(places).all(axis=1), minlength=len(rows)) == 0
    arrows = np.array([shapely.union_all(shapely.make_valid(parts[known & (of == k)])) for k in np.unique(of[known])], object)
    first, low, last, high = shapely.bounds(arrows).T
    arrows, first, low, last, high = (values[last - first >= SHORTEST_ARROW - WORN_ENDS] for values in (arrows, first, low, last, high))
    begin, finish = stems(arrows)
    way = np.clip((begin - finish) / SURE_LEAN, -1, 1) * (np.minimum(begin, finish) > POINTED)
    return np.c_[(first + last) / 2, (low + high) / 2, way]


def driven_against(arrows: np.ndarray, s: np.ndarray, driven: np.ndarray, directions: np.ndarray) -> float:
    """How many arrows point against those who drove over them, less those that point along with them, each as far as it surely points.

    Parameters
    ----------
    arrows : (A, 3) as `arrows_of` gives them
    s : (K,) metres, stations in order
    driven, directions : (P, K) m and (P,), offsets of every pass, NaN where it did not drive, and 1 along the road or -1 against it
    """
    if not len(arrows) or not len(s):
        return 0.0
    at = np.searchsorted(s, arrows[:, 0]).clip(0, len(s) - 1)
    with np.errstate(invalid="ignore"):
        over = np.abs(driven[:, at] - arrows[:, 1]) < NEUTRAL.narrowest_lane / 2
    return -float((over * directions[:, None] * arrows[:, 2]).sum())


def stems(shapes: np.ndarray) -> np.ndarray:
    """Shares of the length of outlines, from either end, that are a single stroke.

    Parameters
    ----------
    shapes : (A,) shapely polygons in (s, d), m

    Returns
    -------
    (2, A) from the first station on, and from the last one back
    """
    first, low, last, high = shapely.bounds(shapes).T
    at = first[:, None] + (last - first)[:, None] * (np.arange(SLICES) + 0.5) / SLICES
    ends = np.stack([np.stack([at, np.broadcast_to(side[:, None], at.shape)], axis=-1) for side in (low - 1, high + 1)], axis=-2)
    slices = shapely.intersection(shapely.linestrings(ends), shapes[:, None])
    _, right, _, left = np.moveaxis(shapely.bounds(slices), -1, 0)
    broad = np.nan_to_num(left - right) > SHAFT_BREADTH
    bare = np.stack([np.argmax(broad, axis=1), np.argmax(broad[:, ::-1], axis=1)]) / SLICES
    return np.where(broad.any(axis=1), bare, 0.0)
