"""What both methods of boundary detection use.

In: points of a `Survey` near the driven tracks. Out: decimated points, pseudo scan-lines, bottom corners of curbs, chains of them along
the road, and where the curb is occluded.
"""
