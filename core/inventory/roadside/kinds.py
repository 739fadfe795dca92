"""What a line beside the road is, told by its section."""

from __future__ import annotations

import numpy as np

from .chains import Chain
from .uprights import FIRST_BIN, TALL

BUILDING_TOP = 4.2           # m: what rises higher is a building
RAIL_TOP = 0.55, 1.15        # m: tops of guard rails, with tolerance for the ground (EN 1317 systems: 0.70 to 1.00 m)
BEAM_BINS = 4                # height bins from the lower edge of a beam to its top: 0.31 m (EN 1317, W beam) that bins may cut
MIN_FILLED_BEAM = 0.55       # share of slices with points in the beam
OF_BEAM = 0.7                # of the most filled bin, what still belongs to the beam
BARRIER_TOP = 0.6, 1.35      # m: tops of concrete barriers
MIN_BATTER = 0.08            # m per m by which the face of a barrier leans back
BARRIER_DEPTH = 0.30         # m of thickness of its face at most
OPEN_HEDGE = 1.0             # points seen behind, for each on it, from which a rough thing is no hedge
OPEN_FENCE = 0.45                  # points seen behind, for each on it, from which it is a fence whatever its section
SEEN_THROUGH = 0.12          # the same, from which a thin thing is no wall
SEEN_THROUGH_TALL = 0.3      # the same of what is TALL: rock stands back here and there
SCATTERED = 8.0                # the same, from which there is nothing but scattered points
ROUGH_HEDGE = 0.08           # m of thickness from which a solid line is a hedge: a wall's face is plane
THIN_LINE = 0.20                  # m of thickness of rails and fences at most
MAX_BATTER = 0.35            # m per m: more is an embankment
MIN_UPRIGHT_POINTS = 5               # on an upright, median
MAX_WOBBLE = 0.06            # m, of everything that is built
STEADY_TOP, STEADY_SHARE = 0.30, 0.75  # m of change of the top over a car's half length, kept by this share: cars go up and down more
CAR_HALF = 4                 # slices


def kind_of(chain: Chain) -> str | None:
    """guard_rail, barrier, wall, fence or hedge; None for what is none of them: buildings, rows of parked cars, embankments."""
    members = chain.members
    top = float(np.median(chain.top))
    tall = top > TALL
    batter, thickness = float(np.median(members.batter)), float(np.median(members.thickness))
    through = float(members.behind.sum() / max(members.points.sum(), 1.0))
    if np.median(members.points) < MIN_UPRIGHT_POINTS:
        return None
    if top > BUILDING_TOP or abs(batter) > MAX_BATTER or through > SCATTERED or not tall and _restless(members.top):
        return None
    if tall:
        return "wall" if through < SEEN_THROUGH_TALL else None
    built = chain.wobble < MAX_WOBBLE
    # the beams of a rail are straight: in a bend its line has a kink at every post or so
    if (built or chain.roughness < MAX_WOBBLE) and thickness < THIN_LINE and RAIL_TOP[0] < top < RAIL_TOP[1] and _is_beam(members.bins.mean(axis=0)):
        return "guard_rail"
    if thickness > ROUGH_HEDGE and through < OPEN_HEDGE:
        is_barrier = built and BARRIER_TOP[0] < top < BARRIER_TOP[1] and batter > MIN_BATTER and thickness < BARRIER_DEPTH and through < SEEN_THROUGH
        return "barrier" if is_barrier else "hedge"
    if through > OPEN_FENCE:
        return "fence" if built and thickness < THIN_LINE else None
    if built and BARRIER_TOP[0] < top < BARRIER_TOP[1] and batter > MIN_BATTER:
        return "barrier"
    return None if not built else "fence" if through > SEEN_THROUGH else "wall"


def _is_beam(filled):
    """Whether points fill a band no higher than a beam, with free height below."""
    own = np.flatnonzero(filled > OF_BEAM * filled.max())
    return filled.max() > MIN_FILLED_BEAM and own[0] > FIRST_BIN and own[-1] - own[0] < BEAM_BINS


def _restless(tops):
    """Whether the top goes up and down as bonnets and roofs do."""
    if len(tops) <= CAR_HALF:
        return False
    return float(np.quantile(np.abs(tops[CAR_HALF:] - tops[:-CAR_HALF]), STEADY_SHARE)) > STEADY_TOP
