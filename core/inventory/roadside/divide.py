"""A chain of uprights divided where one thing ends and the next begins in line with it: garden walls, fences and hedges follow one another."""

from __future__ import annotations

import numpy as np

from .chains import Chain
from .kinds import kind_of
from .uprights import UPRIGHT_SLICE

TOP_CHANGE, THICKNESS_CHANGE, THROUGH_CHANGE = 0.15, 0.05, 0.15  # m, m and share of pulses by which the sections of two things differ at least
THICKEST, HIGHEST = 0.5, 3.0     # m: what is thicker or higher counts as this, for single uprights hold a crown or a window


def things_of(chain: Chain, min_length: float) -> list[tuple[str, Chain]]:
    """The things of a chain with their kinds; what is none of the kinds is left out.

    The chain is halved where height, thickness and what is seen through it change most, as long as both parts are long enough and differ by more
    than their own scatter; neighbours of one kind are one thing all the same.

    Parameters
    ----------
    chain : Chain
    min_length : m along the road of a thing
    """
    cuts = [0, *_cuts(_sections(chain), chain.members.slice, 0, len(chain.members), min_length), len(chain.members)]
    kinds = [kind_of(chain.part(np.arange(a, b))) for a, b in zip(cuts[:-1], cuts[1:])]
    first = np.flatnonzero([k == 0 or kind != kinds[k - 1] for k, kind in enumerate(kinds)])
    found = []
    for k, after in zip(first, [*first[1:], len(kinds)]):
        whole = chain.part(np.arange(cuts[k], cuts[after]))
        # joined again, a row of cars shows that it is one
        kind = kind_of(whole) if after - k > 1 else kinds[k]
        if kind is not None:
            found.append((kind, whole))
    return found


def _sections(chain):
    """(N, 3) what tells things apart, in units of what their sections differ by at least."""
    members = chain.members
    through = members.behind / np.maximum(members.behind + members.points, 1.0)
    return np.c_[np.minimum(members.top, HIGHEST) / TOP_CHANGE, np.minimum(members.thickness, THICKEST) / THICKNESS_CHANGE, through / THROUGH_CHANGE]


def _cuts(sections, slices, first, last, min_length):
    """Where the members from `first` to `last` are divided, rising."""
    least = int(np.ceil(min_length / UPRIGHT_SLICE))
    at = np.arange(first + 1, last)
    at = at[(slices[at - 1] - slices[first] + 1 >= least) & (slices[last - 1] - slices[at] + 1 >= least)]
    if not len(at):
        return []
    own = sections[first:last]
    sums, squares = (np.vstack([np.zeros(own.shape[1]), np.cumsum(values, axis=0)]) for values in (own, own**2))
    left, right = (at - first)[:, None], (last - at)[:, None]
    before, after = sums[at - first] / left, (sums[-1] - sums[at - first]) / right
    gain = ((after - before) ** 2 * left * right / (left + right)).sum(axis=1)
    k = int(gain.argmax())
    scatter = np.sqrt(np.maximum(squares[-1] - before[k] ** 2 * left[k] - after[k] ** 2 * right[k], 0.0) / len(own))
    if not (np.abs(after[k] - before[k]) > np.maximum(1.0, scatter)).any():
        return []
    cut = int(at[k])
    return [*_cuts(sections, slices, first, cut, min_length), cut, *_cuts(sections, slices, cut, last, min_length)]
