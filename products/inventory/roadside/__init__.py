"""What stands beside the road: lines of rails, barriers, walls, fences and hedges, gutters, and single poles, signs and trunks.

In: an open `Survey` and the layers that say where the carriageway ends. Out: `Roadside`, and its layers.
"""
