#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::recording::testing {

inline constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

inline sensor::Scan scan_at(std::int64_t ns) {
  sensor::Scan scan;
  scan.stamp = stamp_from_ns(ns);
  scan.has_time = scan.has_ring = true;
  for (int k = 0; k < 20; ++k) {
    scan.points.push_back({{1.0f + static_cast<float>(k), 2.0f, 3.0f},
                           0.5f,
                           0.001f * static_cast<float>(k),
                           static_cast<std::uint16_t>(k % 4)});
  }
  return scan;
}
inline sensor::Imu imu_at(std::int64_t ns) {
  sensor::Imu imu;
  imu.stamp = stamp_from_ns(ns);
  imu.specific_force.z() = 9.81;
  return imu;
}
inline sensor::Fix fix_at(std::int64_t ns) {
  sensor::Fix fix;
  fix.stamp = stamp_from_ns(ns);
  fix.position = geo_point_from_degrees(49.0, 8.4, 110.0);
  return fix;
}

inline void put(BagWriter& bag, const bus::Topic& topic, std::int64_t received, const Bytes& cdr) {
  const auto status = bag.write(topic.name, topic.type, stamp_from_ns(received), cdr);
  ASSERT_TRUE(status) << status.error().message;
}

/// `seconds` of a robot: scans at 10 Hz, IMU at 50 Hz, fixes at 1 Hz, wheels at 10 Hz.
inline void put_drive(BagWriter& bag, int seconds) {
  for (int k = 0; k < seconds * 50; ++k) {
    const std::int64_t ns = kStart + std::int64_t{k} * 20'000'000;
    put(bag, ros_codec::topics::imu(), ns, ros_codec::encode(imu_at(ns)));
    if (k % 5 == 0) put(bag, ros_codec::topics::points(), ns + 1, ros_codec::encode(scan_at(ns)));
    if (k % 5 == 0)
      put(bag, ros_codec::topics::wheel_odometry(), ns + 2,
          ros_codec::encode(sensor::Wheel{stamp_from_ns(ns), 1.0, {}}));
    if (k % 50 == 0) put(bag, ros_codec::topics::fix(), ns + 3, ros_codec::encode(fix_at(ns)));
  }
}

inline std::vector<Sample> read_all(Reader& reader) {
  std::vector<Sample> samples;
  while (true) {
    auto sample = reader.next();
    EXPECT_TRUE(sample) << sample.error().message;
    if (!sample || !*sample) return samples;
    samples.push_back(std::move(**sample));
  }
}

inline std::string refusal(const std::filesystem::path& path, const ReaderConfig& config = {}) {
  const auto reader = open(path, config);
  return reader ? "opened" : reader.error().message;
}

}  // namespace fleetmap::recording::testing
