"""What is thick and loose, as a hedge, shows uprights on its face and inside it, and may be followed along either: it is told once, by its face."""

from __future__ import annotations

import numpy as np

from .chains import Chain, along_the_chain
from .shared import SAME_THING
from .uprights import Uprights


def along_faces(things: list[tuple[str, Chain]]) -> list[tuple[str, Chain]]:
    """Things of which those of one kind that run beside each other, nearer than two things stand, are one.

    Parameters
    ----------
    things : kinds and chains of one side of a road

    Returns
    -------
    The same, in order of station; where two are joined, the uprights nearer to the road are kept
    """
    found: list[tuple[str, Chain]] = []
    for kind, chain in sorted(things, key=lambda thing: int(thing[1].members.slice[0])):
        twin = next((k for k, (other, before) in enumerate(found) if other == kind and _beside(before, chain)), None)
        if twin is None:
            found.append((kind, chain))
        else:
            found[twin] = kind, _joined(found[twin][1], chain)
    return found


def _beside(one, other):
    """Whether two chains run beside each other for a while, nearer than two things stand."""
    shared = (other.s >= one.s[0]) & (other.s <= one.s[-1])
    return bool(shared.any()) and float(np.median(np.abs(other.d[shared] - np.interp(other.s[shared], one.s, one.d)))) < SAME_THING


def _joined(one, other):
    """The chain of the uprights of two, without those that stand behind the other's face."""
    parts = [chain.part(np.flatnonzero(~_behind(chain, face, equal))) for chain, face, equal in ((one, other, False), (other, one, True))]
    members = Uprights.join([part.members for part in parts])
    empty = np.concatenate([part.empty for part in parts])
    # the one nearer to the road of two that are left of a slice
    order = np.lexsort((one.side * members.d, members.slice))
    order = order[np.r_[True, np.diff(members.slice[order]) > 0]]
    members, empty = members[order], empty[order]
    # an opening of the one that the other fills is none
    empty = np.minimum(empty, np.diff(members.slice, append=members.slice[-1] + 1) - 1)
    return Chain(one.road, one.side, members, *along_the_chain(members), empty)


def _behind(chain, face, equal):
    """(N,) bool, which uprights of a chain stand behind the face of another, or on it where `equal`."""
    d = np.interp(chain.s, face.s, face.d, left=np.nan, right=np.nan)
    depth = chain.side * (chain.d - d)
    return (depth >= 0.0 if equal else depth > 0.0) & (depth < SAME_THING)
