"""Open3D's outlier removal and clustering: runs in a Python of its own that has Open3D, see open3d_peer.py.

    python open3d_work.py outliers IN OUT NEIGHBOURS STD_RATIO
    python open3d_work.py clusters IN OUT DISTANCE

IN is a .npy of (N, 3) metres; OUT becomes the mask of points kept, or the cluster of each. Prints the
seconds of Open3D's own work as a line of JSON.
"""

import json
import sys
import time

import numpy as np
import open3d


def main():
    task, taken, given, *words = sys.argv[1:]
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(np.load(taken)))
    began = time.perf_counter(), time.process_time()
    if task == "outliers":
        # Open3D counts the point itself among its neighbours, at distance 0
        _, kept = cloud.remove_statistical_outlier(int(words[0]) + 1, float(words[1]))
    else:
        labels = cloud.cluster_dbscan(float(words[0]), 1)
    seconds = dict(wall=time.perf_counter() - began[0], cpu=time.process_time() - began[1])
    if task == "outliers":
        found = np.zeros(len(cloud.points), bool)
        found[np.asarray(kept)] = True
    else:
        found = np.asarray(labels)
    np.save(given, found)
    print(json.dumps(dict(seconds, version=open3d.__version__)))


if __name__ == "__main__":
    main()
