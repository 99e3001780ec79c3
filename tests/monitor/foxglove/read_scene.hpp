#pragma once

#include <gtest/gtest.h>

#include "monitor/foxglove/cdr_reader.hpp"

namespace fleetmap::testing {

struct ReadLine {
  std::uint32_t type = 0;
  double thickness = 0.0;
  std::vector<std::vector<double>> points;
  std::vector<double> color;
};
struct ReadSphere {
  std::vector<double> pose, size, color;
};
struct ReadEntity {
  std::uint32_t sec = 0, nsec = 0;
  std::string frame, id;
  std::vector<ReadSphere> spheres;
  std::vector<ReadLine> lines;
};

inline ReadLine read_line(CdrReader& cdr) {
  ReadLine line;
  line.type = cdr.count();
  EXPECT_EQ(cdr.numbers(7), (std::vector<double>{0, 0, 0, 0, 0, 0, 1})) << "pose";
  line.thickness = cdr.number<double>();
  EXPECT_TRUE(cdr.flag()) << "scale_invariant";
  for (std::uint32_t left = cdr.count(); left > 0; --left) line.points.push_back(cdr.numbers(3));
  line.color = cdr.numbers(4);
  EXPECT_EQ(cdr.count(), 0u) << "colors";
  EXPECT_EQ(cdr.count(), 0u) << "indices";
  return line;
}

inline ReadEntity read_entity(CdrReader& cdr) {
  ReadEntity entity;
  entity.sec = cdr.count();
  entity.nsec = cdr.count();
  entity.frame = cdr.text();
  entity.id = cdr.text();
  EXPECT_EQ(cdr.number<std::int32_t>(), 0) << "lifetime";
  EXPECT_EQ(cdr.count(), 0u) << "lifetime";
  EXPECT_FALSE(cdr.flag()) << "frame_locked";
  for (const char* none : {"metadata", "arrows", "cubes"}) EXPECT_EQ(cdr.count(), 0u) << none;
  for (std::uint32_t left = cdr.count(); left > 0; --left) {
    ReadSphere& sphere = entity.spheres.emplace_back();
    sphere.pose = cdr.numbers(7);
    sphere.size = cdr.numbers(3);
    sphere.color = cdr.numbers(4);
  }
  EXPECT_EQ(cdr.count(), 0u) << "cylinders";
  for (std::uint32_t left = cdr.count(); left > 0; --left) entity.lines.push_back(read_line(cdr));
  for (const char* none : {"triangles", "texts", "models"}) EXPECT_EQ(cdr.count(), 0u) << none;
  return entity;
}

/// Reads foxglove::SceneUpdate, member by member in the order of the published schema.
inline std::vector<ReadEntity> read_scene(const Bytes& message) {
  CdrReader cdr(message);
  EXPECT_EQ(cdr.count(), 0u) << "deletions";
  std::vector<ReadEntity> entities;
  for (std::uint32_t left = cdr.count(); left > 0; --left) entities.push_back(read_entity(cdr));
  EXPECT_TRUE(cdr.at_end());
  return entities;
}

}  // namespace fleetmap::testing
