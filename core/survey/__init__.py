"""What was measured.

In: point cloud files and a trajectory. Out: a `Survey`, whose points lie in the road frame, in a bounded section store.
"""
