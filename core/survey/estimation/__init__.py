"""The trajectory from the cloud alone: where the scanner must have been to see what it saw at its times.

In: point cloud files. Out: an `EstimatedTrajectory`.
"""
