"""Reading: blocks of points are placed in the road frame, chosen, stored by section, and put in order.

In: point cloud files and a road frame. Out: a section store. Threads of this process do it, or whoever runs phases.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
})
