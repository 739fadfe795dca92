"""What a line beside the road is, told by its section."""

from __future__ import annotations

import numpy as np

from .chains import Chain
from .gaps import TOLD_GAP
from .uprights import TALL, TOP_BIN

BUILDING_TOP, LOW_ROCK = 4.2, 0.25  # m: what rises higher is a building; share of a rock face, whose top goes up and down, that does not
RAIL_TOP = 0.55, 1.15        # m: tops of guard rails, with tolerance for the ground (EN 1317 systems: 0.70 to 1.00 m)
BEAM = 0.20, 0.40            # m below the top: to the first a beam fills everything, before the second it ends (EN 1317: 0.31 m, W beam)
BEAM_GAP = 0.35              # of the points of the beam, what fewer remain in a free bin below it: posts
FREE_BELOW = 0.45            # share of the height that is free below ropes or pipes of a rail
BARRIER_TOP = 0.6, 1.35      # m: tops of concrete barriers
MIN_BATTER = 0.08            # m per m by which the face of a barrier leans back
BARRIER_DEPTH = 0.30         # m of thickness of its face at most
OPEN_HEDGE = 1.0             # points seen behind, for each on it, from which a rough thing is no hedge
OPEN_FENCE = 0.45                  # points seen behind, for each on it, from which it is a fence whatever its section
SEEN_THROUGH = 0.12          # the same, from which a thin thing is no wall
SEEN_THROUGH_TALL = 0.3      # the same of what is TALL: rock stands back here and there
SCATTERED = 8.0                # the same, from which there is nothing but scattered points
THICK_HEDGE, ROUGH_HEDGE = 0.08, 0.015  # m of thickness, and across from one point to the next higher one, from which a solid line is a hedge:
#                              the face of a wall is plane, that of a fence on a wall is plane and thick
THIN_LINE = 0.20                  # m of thickness of rails and fences at most
MAX_BATTER = 0.35            # m per m: more is an embankment
MIN_UPRIGHT_POINTS = 5, 3    # on an upright, median; on one of a straight line
STRAIGHT_LINE = 0.02         # m of roughness of such a line
MAX_WOBBLE = 0.06            # m, of everything that is built
STEADY_TOP, STEADY_SHARE = 0.30, 0.75  # m of change of the top over a car's half length, kept by this share: cars go up and down more
CAR_HALF = 4                 # slices
MAX_EMPTY = 0.08             # share of a line's length that is open in short gaps: a row of cars has as many of them as cars
LEAST_MEASURED = 0.3         # share of its length that was measured


def kind_of(chain: Chain) -> str | None:
    """guard_rail, barrier, wall, fence or hedge; None for what is none of them, or may be none: buildings, rows of parked cars, embankments."""
    members = chain.members
    top = float(np.median(chain.top))
    tall = top > TALL
    batter, thickness = float(np.median(members.batter)), float(np.median(members.thickness))
    through = float(members.behind.sum() / max(members.points.sum(), 1.0))
    if np.median(members.points) < MIN_UPRIGHT_POINTS[chain.roughness < STRAIGHT_LINE] or members.above_view.mean() > 0.5:
        return None
    if _is_row(chain):
        return None
    if np.quantile(chain.top, LOW_ROCK) > BUILDING_TOP or abs(batter) > MAX_BATTER or through > SCATTERED or not tall and _restless(members.top):
        return None
    if tall:
        return "wall" if through < SEEN_THROUGH_TALL else None
    built = chain.wobble < MAX_WOBBLE
    # the beams of a rail are straight: in a bend its line has a kink at every post or so
    if (built or chain.roughness < MAX_WOBBLE) and thickness < THIN_LINE and RAIL_TOP[0] < top < RAIL_TOP[1] and _is_rail(members, top, through):
        return "guard_rail"
    if built and BARRIER_TOP[0] < top < BARRIER_TOP[1] and batter > MIN_BATTER and thickness < BARRIER_DEPTH and through < SEEN_THROUGH:
        return "barrier"
    if thickness > THICK_HEDGE and np.median(members.rough) > ROUGH_HEDGE and through < OPEN_HEDGE:
        return "hedge"
    if not built or through > OPEN_FENCE and thickness > THIN_LINE:
        return None
    return "fence" if through > SEEN_THROUGH else "wall"


def _is_rail(members, top, through):
    """Whether there is a beam with free height below, above the ground or another beam, or ropes that leave much of the height free."""
    points = members.below_top.sum(axis=0)
    beam, end = (int(round(depth / TOP_BIN)) for depth in BEAM)
    # a W beam has a fold that few pulses reach: every tenth of a metre counts, not every bin
    filled = points[:beam].reshape(-1, 2).mean(axis=1)
    is_beam = filled.min() > 0.5 * filled.mean() and points[end - 2:end].mean() < BEAM_GAP * filled.mean()
    return is_beam or through > OPEN_FENCE and float(np.median(members.foot)) > FREE_BELOW * top


def _is_row(chain):
    """Whether short gaps again and again show what lies beyond, as between parked cars, or most of it is hidden."""
    slices = chain.members.slice[-1] - chain.members.slice[0] + 1
    short = chain.empty[:-1] < TOLD_GAP
    return chain.empty[:-1][short].sum() > MAX_EMPTY * slices or len(chain.members) < LEAST_MEASURED * slices


def _restless(tops):
    """Whether the top goes up and down as bonnets and roofs do."""
    if len(tops) <= CAR_HALF:
        return False
    return float(np.quantile(np.abs(tops[CAR_HALF:] - tops[:-CAR_HALF]), STEADY_SHARE)) > STEADY_TOP
