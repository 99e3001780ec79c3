// Packets of real devices against the points that another decoder (tier4/nebula) makes of them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <numbers>
#include <vector>

#include "bag_samples.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "fleetmap/sensor/velodyne_packet.hpp"
#include "recording/bag_file.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;
using namespace recording::testing;
using sensor::ScanPoint;

constexpr float kTolerance = 0.002f;  // m
/// rad; the reference rounds azimuths to 1/100 deg.
constexpr float kRounding = 0.005f * std::numbers::pi_v<float> / 180.0f;

/// rad, by which the VLP-16 turns in a block.
constexpr float kBlock = 0.4f * std::numbers::pi_v<float> / 180.0f;

/// Points of the reference, by z.
class Reference {
 public:
  /// A binary PCD whose points begin with x, y and z.
  Reference(const fs::path& file, std::size_t point_bytes) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::string mark = "DATA binary\n";
    for (std::size_t at = bytes.find(mark) + mark.size(); at + point_bytes <= bytes.size(); at += point_bytes)
      std::memcpy(points_.emplace_back().data(), bytes.data() + at, 12);
    std::ranges::sort(points_, {}, [](const Eigen::Vector3f& p) { return p.z(); });
  }
  std::size_t size() const { return points_.size(); }

  /// Whether a point of the reference lies within so much, more by so much of the range.
  bool holds(const Eigen::Vector3f& p, float metres, float radians) const {
    const auto z = [](const Eigen::Vector3f& point) { return point.z(); };
    auto at = std::ranges::lower_bound(points_, p.z() - kTolerance, {}, z);
    for (; at != points_.end() && at->z() <= p.z() + kTolerance; ++at) {
      if ((*at - p).norm() <= metres + radians * p.norm()) return true;
    }
    return false;
  }

 private:
  std::vector<Eigen::Vector3f> points_;
};

/// Calls `use` with every packet of a message.
template <class Use>
void for_packets(const fs::path& bag, std::size_t message, Use use) {
  auto file = open_bag_file(bag);
  ASSERT_TRUE(file) << file.error().message;
  for (std::size_t k = 0; k <= message; ++k) {
    const auto next = (*file)->next();
    ASSERT_TRUE(next && *next);
    if (k < message) continue;
    const auto scan = ros_codec::decode_velodyne_scan((*next)->cdr);
    ASSERT_TRUE(scan) << scan.error().message;
    for (std::size_t n = 0; n < scan->packets.size(); ++n) {
      const auto packet = sensor::read_velodyne_packet(scan->packets[n].data);
      ASSERT_TRUE(packet) << packet.error().what;
      use(n, *packet);
    }
  }
}

/// Degrees, clockwise from ahead, [0, 360).
double azimuth_of(const ScanPoint& point) {
  const double azimuth =
      -std::atan2(point.position.y(), point.position.x()) * 180.0f / std::numbers::pi_v<float>;
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth;
}

struct Agreement {
  std::size_t points = 0, within = 0;
  double share() const { return static_cast<double>(within) / static_cast<double>(points); }
};

void add(Agreement& agreement, const std::vector<ScanPoint>& points, const Reference& reference,
         float radians) {
  for (const ScanPoint& point : points) {
    ++agreement.points;
    agreement.within += reference.holds(point.position, kTolerance, radians);
  }
}

/// Dual returns. The reference does not interpolate the azimuth in the last pair of blocks of a packet.
TEST(VelodyneSharedData, Vlp16AgreesWithTheReference) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/velodyne_vlp16");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  const Reference reference(*data / "1673400472138016708.pcd", 32);
  ASSERT_EQ(reference.size(), 14'831u);
  Agreement before_last, last;
  for_packets(
      *data / "1673400471837873222_0.db3", 3, [&](std::size_t n, const sensor::VelodynePacket& packet) {
        if (n == 149) return;  // ends in the next turn
        ASSERT_EQ(packet.model->name, "VLP-16");
        ASSERT_EQ(packet.blocks.size(), 6u) << "dual returns";
        for (std::size_t k = 0; k < packet.blocks.size(); ++k) {
          std::vector<ScanPoint> points;
          append_points(*packet.model, packet.blocks[k], 0.0, points);
          k == 5 ? add(last, points, reference, kBlock) : add(before_last, points, reference, kRounding);
        }
      });
  EXPECT_GT(before_last.points, 11'000u);
  EXPECT_EQ(before_last.within, before_last.points);
  EXPECT_GT(last.points, 2'000u);
  EXPECT_EQ(last.within, last.points);
}

TEST(VelodyneSharedData, Vlp16BagIsReadAsScans) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/velodyne_vlp16");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  auto reader = open(*data);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 4u);
  const Reference reference(*data / "1673400472138016708.pcd", 32);
  std::vector<ScanPoint> points = std::get<sensor::Scan>(samples[3]).points;
  EXPECT_EQ(points.size(), 14'674u);
  // The reference leaves out 359 to 360 deg, and cuts within a block where its points pass 0.
  std::erase_if(points, [](const ScanPoint& point) {
    const double azimuth = azimuth_of(point);
    return azimuth > 359.0 || (azimuth < 1.0 && point.time > 0.05f);
  });
  Agreement agreement;
  add(agreement, points, reference, kBlock);
  EXPECT_EQ(agreement.within, agreement.points);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto& scan = std::get<sensor::Scan>(samples[k]);
    EXPECT_NEAR(to_seconds(sensor::sweep_of(scan)), 0.1, 1e-3);
  }
}

TEST(VelodyneSharedData, Vlp32cAgreesWithTheReference) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/velodyne_vlp32");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  const Reference reference(*data / "1713492677464078412.pcd", 12);
  ASSERT_EQ(reference.size(), 26'216u);
  // The reference interpolates as if the lasers fired one by one, though they fire in pairs.
  sensor::VelodyneModel one_by_one = *sensor::velodyne_model(0x28);
  for (std::size_t k = 0; k < one_by_one.lasers.size(); ++k)
    one_by_one.lasers[k].delay = 2.304e-6 * static_cast<double>(k);
  constexpr float kSixteenShots = 0.14f * std::numbers::pi_v<float> / 180.0f;
  Agreement same_times, own_times;
  for_packets(*data / "1713492677464078412_0.db3", 0, [&](std::size_t, const sensor::VelodynePacket& packet) {
    ASSERT_EQ(packet.model->name, "VLP-32C");
    for (std::size_t k = 0; k + 1 < packet.blocks.size(); ++k) {
      const int azimuth = packet.blocks[k].azimuth;
      const bool before_gap = packet.blocks[k + 1].azimuth - azimuth > 100;  // of the field of view
      const bool outside = azimuth > 9'000 && azimuth < 27'000;  // of the field of view of the reference
      if (before_gap || outside) continue;
      std::vector<ScanPoint> points;
      append_points(one_by_one, packet.blocks[k], 0.0, points);
      add(same_times, points, reference, kRounding);
      points.clear();
      append_points(*packet.model, packet.blocks[k], 0.0, points);
      add(own_times, points, reference, kSixteenShots);
    }
  });
  EXPECT_GT(same_times.points, 23'000u);
  EXPECT_EQ(same_times.within, same_times.points);
  EXPECT_EQ(own_times.within, own_times.points);
}

TEST(VelodyneSharedData, Vlp32cBagIsReadAsScans) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/velodyne_vlp32");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  auto reader = open(*data);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 4u) << "the first begins behind 0 deg";
  for (const Sample& sample : samples) {
    const auto& scan = std::get<sensor::Scan>(sample);
    EXPECT_NEAR(static_cast<double>(scan.points.size()), 26'235.0, 20.0);
    EXPECT_NEAR(to_seconds(sensor::sweep_of(scan)), 0.1, 1e-3);
  }
}

}  // namespace
}  // namespace fleetmap::recording
