"""What both methods of boundary detection use: pseudo scan-lines, decimation, corners of curbs, tracking along the road, occlusion."""
