"""Control points proposed: the same paint found in a photo and in the intensity image.

In: an image that lies roughly, and the intensity image. Out: pairs of places, each with the likeness of its two cut-outs.
"""

from ....core.lazy import public

__getattr__, __all__ = public(__name__, {"propose": ("Proposal", "ProposalSettings", "propose_control_points")})
