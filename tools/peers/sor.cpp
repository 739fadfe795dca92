// PCL's StatisticalOutlierRemoval, to compare ours with.
// sor IN OUT NEIGHBOURS STD_RATIO: points of IN to a byte each in OUT, 1 where the point is kept.
// SPDX-License-Identifier: GPL-2.0-or-later

#include <pcl/filters/statistical_outlier_removal.h>

#include "points_file.h"

int main(int count, char **words)
{
  if (count != 5) {
    std::fprintf(stderr, "sor IN OUT NEIGHBOURS STD_RATIO\n");
    return 2;
  }
  try {
    const auto cloud = read_points(words[1]);
    const double began = cpu_seconds();
    pcl::StatisticalOutlierRemoval<pcl::PointXYZI> filter;
    filter.setInputCloud(cloud);
    filter.setMeanK(std::stoi(words[3]));
    filter.setStddevMulThresh(std::stod(words[4]));
    pcl::Indices kept;
    filter.filter(kept);
    const double took = cpu_seconds() - began;
    std::vector<std::uint8_t> mask(cloud->size(), 0);
    for (const auto index : kept)
      mask[index] = 1;
    write_values(words[2], mask);
    std::printf("{\"points\": %zu, \"kept\": %zu, \"cpu_seconds\": %.4f}\n", cloud->size(), kept.size(), took);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "sor: %s\n", error.what());
    return 1;
  }
  return 0;
}
