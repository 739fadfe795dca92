"""What an analyst corrected in a road map.

In: the layer CORRECTIONS, and what a run found: road edges, marking objects and lines, driving lines and lanes. Out: the same, corrected.
A correction is matched by its place in the road frame of the run, never by the number of a feature, so that it holds when the run changes.
"""
