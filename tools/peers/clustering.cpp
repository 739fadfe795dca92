// PCL's ConditionalEuclideanClustering, to compare ours with.
// clustering IN OUT DISTANCE STRETCH SQUEEZE: points of IN, whose x runs along the road and y across it,
// to an int32 each in OUT, the number of its cluster. Two points belong together where
// (dx / STRETCH)^2 + (dy * SQUEEZE)^2 <= DISTANCE^2: the condition; PCL looks within the radius DISTANCE * STRETCH.
// STRETCH = SQUEEZE = 1 is plain Euclidean clustering, for coordinates stretched beforehand.
// SPDX-License-Identifier: GPL-2.0-or-later

#include <algorithm>

// PCL's library holds this class for some point types only
#define PCL_NO_PRECOMPILE
#include <pcl/segmentation/conditional_euclidean_clustering.h>

#include "points_file.h"

int main(int count, char **words)
{
  if (count != 6) {
    std::fprintf(stderr, "clustering IN OUT DISTANCE STRETCH SQUEEZE\n");
    return 2;
  }
  try {
    const auto cloud = read_points(words[1]);
    const float distance = std::stof(words[3]), stretch = std::stof(words[4]), squeeze = std::stof(words[5]);
    const double began = cpu_seconds();
    pcl::ConditionalEuclideanClustering<pcl::PointXYZI> clustering;
    clustering.setInputCloud(cloud);
    clustering.setClusterTolerance(distance * std::max(stretch, 1.0f / squeeze));
    clustering.setConditionFunction(std::function<bool(const pcl::PointXYZI &, const pcl::PointXYZI &, float)>(
        [=](const pcl::PointXYZI &a, const pcl::PointXYZI &b, float) {
          const float along = (a.x - b.x) / stretch, across = (a.y - b.y) * squeeze;
          return along * along + across * across <= distance * distance;
        }));
    pcl::IndicesClusters clusters;
    clustering.segment(clusters);
    const double took = cpu_seconds() - began;
    std::vector<std::int32_t> labels(cloud->size(), -1);
    for (std::size_t number = 0; number < clusters.size(); ++number)
      for (const auto index : clusters[number].indices)
        labels[index] = static_cast<std::int32_t>(number);
    write_values(words[2], labels);
    std::printf("{\"points\": %zu, \"clusters\": %zu, \"cpu_seconds\": %.4f}\n", cloud->size(), clusters.size(), took);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "clustering: %s\n", error.what());
    return 1;
  }
  return 0;
}
