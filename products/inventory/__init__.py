"""What else the road shows: cross-sections, and in `roadside/` what stands beside it.

In: an open `Survey` and the layers of its road map. Out: `RoadSections`, and their layer and table.
"""
