"""What was measured: point clouds, trajectory, passes, the road frame, the section store."""
