// What both programs share: points in, results out, and the clock of the work alone.
// SPDX-License-Identifier: GPL-2.0-or-later

#pragma once

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

// Rows of four float32 (x, y, z, intensity), one after the other, in the machine's byte order.
inline pcl::PointCloud<pcl::PointXYZI>::Ptr read_points(const std::string &path)
{
  pcl::PointCloud<pcl::PointXYZI>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZI>);
  std::FILE *file = std::fopen(path.c_str(), "rb");
  if (!file)
    throw std::runtime_error("cannot read " + path);
  float row[4];
  while (std::fread(row, sizeof row, 1, file) == 1) {
    pcl::PointXYZI point;
    point.x = row[0], point.y = row[1], point.z = row[2], point.intensity = row[3];
    cloud->push_back(point);
  }
  std::fclose(file);
  return cloud;
}

template <typename Value> void write_values(const std::string &path, const std::vector<Value> &values)
{
  std::FILE *file = std::fopen(path.c_str(), "wb");
  if (!file || std::fwrite(values.data(), sizeof(Value), values.size(), file) != values.size() || std::fclose(file))
    throw std::runtime_error("cannot write " + path);
}

// CPU seconds of this process so far, all its threads together.
inline double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
