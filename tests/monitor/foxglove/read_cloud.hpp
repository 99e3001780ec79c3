#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "monitor/foxglove/cdr_reader.hpp"

namespace fleetmap::testing {

struct ReadPoint {
  std::array<float, 3> p{};  ///< m
  std::uint16_t intensity = 0, robot = 0;
};

/// Reads foxglove::PointCloud, member by member in the order of the published schema.
inline std::vector<ReadPoint> read_cloud(const Bytes& message) {
  CdrReader cdr(message);
  cdr.count(), cdr.count();  // timestamp
  EXPECT_EQ(cdr.text(), "enu");
  EXPECT_EQ(cdr.numbers(7), (std::vector<double>{0, 0, 0, 0, 0, 0, 1})) << "pose";
  EXPECT_EQ(cdr.count(), sizeof(ReadPoint)) << "point_stride";
  EXPECT_EQ(cdr.count(), 5u) << "fields";
  const std::tuple<const char*, std::uint32_t, std::uint32_t> fields[] = {
      {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"intensity", 12, 3}, {"robot", 14, 3}};
  for (const auto& [name, offset, type] : fields) {
    EXPECT_EQ(cdr.text(), name);
    EXPECT_EQ(cdr.count(), offset) << name;
    EXPECT_EQ(cdr.count(), type) << name;
  }
  const Bytes data = cdr.octets();
  EXPECT_TRUE(cdr.at_end());
  std::vector<ReadPoint> points(data.size() / sizeof(ReadPoint));
  EXPECT_EQ(points.size() * sizeof(ReadPoint), data.size());
  if (!points.empty()) std::memcpy(points.data(), data.data(), data.size());
  return points;
}

}  // namespace fleetmap::testing
