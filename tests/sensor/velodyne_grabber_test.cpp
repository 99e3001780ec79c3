// The decoder of Velodyne's packets beside an independent one: PCL's grabbers read the same capture.
#include <gtest/gtest.h>
#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/sensor/velodyne_packet.hpp"
#include "recording/pcap_bytes.hpp"
#include "support/temporary_folder.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kPackets = 400;  // more than two turns of each device

struct Return {
  Eigen::Vector3f position;  ///< x forward, y left, z up
  float intensity = 0.0f;
};

/// A room whose walls are at another range in each direction, so that no two lasers can be confused.
std::vector<Bytes> packets_of(std::uint8_t product) {
  fleetmap::testing::VelodyneDevice device(Duration{});
  device.product = product;
  device.range_at = [](double azimuth, double elevation) {
    return 12.0 + 4.0 * std::sin(azimuth) + 10.0 * elevation;
  };
  std::vector<Bytes> packets;
  for (std::size_t k = 0; k < kPackets; ++k) packets.push_back(device.next().bytes);
  return packets;
}

std::vector<Return> decoded(const std::vector<Bytes>& packets) {
  std::vector<ScanPoint> points;
  for (const Bytes& bytes : packets) {
    const auto packet = read_velodyne_packet(bytes);
    if (!packet) return {};
    for (const VelodyneBlock& block : packet->blocks)
      append_points(*packet->model, block, block.time, points);
  }
  std::vector<Return> returns;
  for (const ScanPoint& point : points) returns.push_back({point.position.cast<float>(), point.intensity});
  return returns;
}

std::string capture_of(const std::vector<Bytes>& packets) {
  std::string capture = recording::testing::pcap_header();
  // All at one time: the grabber waits between packets as long as the capture says.
  for (const Bytes& bytes : packets)
    capture += recording::testing::pcap_record(Stamp{}, recording::testing::udp_frame({}, bytes));
  return capture;
}

/// The first `wanted` returns of a grabber, in the order in which they were fired.
std::vector<Return> grabbed(pcl::HDLGrabber& grabber, std::size_t wanted) {
  using OnSweep = pcl::HDLGrabber::sig_cb_velodyne_hdl_sweep_point_cloud_xyzi;
  std::mutex mutex;
  std::condition_variable arrived;
  std::vector<Return> returns;
  const std::function<OnSweep> on_sweep = [&](const pcl::PointCloud<pcl::PointXYZI>::ConstPtr& sweep) {
    const std::lock_guard lock(mutex);
    for (const pcl::PointXYZI& point : *sweep)  // x to the right, y forward
      returns.push_back({{point.y, -point.x, point.z}, point.intensity});
    arrived.notify_all();
  };
  auto connection = grabber.registerCallback(on_sweep);
  grabber.start();
  {
    std::unique_lock lock(mutex);
    arrived.wait_for(lock, std::chrono::seconds(60), [&] { return returns.size() >= wanted; });
  }
  grabber.stop();
  connection.disconnect();
  return returns;
}

/// PCL assumes that all lasers of a block (of the VLP-16: of half a block) fire at once.
void expect_same_returns(const std::vector<Return>& ours, const std::vector<Return>& theirs,
                         double max_azimuth_apart) {
  ASSERT_GE(theirs.size(), ours.size() / 3);
  for (std::size_t k = 0; k < std::min(ours.size(), theirs.size()); ++k) {
    const Eigen::Vector3f &a = ours[k].position, &b = theirs[k].position;
    SCOPED_TRACE("return " + std::to_string(k));
    ASSERT_NEAR(a.norm(), b.norm(), 1e-3);
    ASSERT_NEAR(a.z(), b.z(), 2e-3);
    const double apart = std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x());
    ASSERT_LE(std::abs(std::remainder(apart, 360.0 * kDegree)), max_azimuth_apart);
    ASSERT_EQ(ours[k].intensity, theirs[k].intensity);
  }
}

TEST(VelodyneGrabber, OfPclDecodesAVlp16Alike) {
  const testing::TemporaryFolder folder;
  const std::vector<Bytes> packets = packets_of(0x22);
  const std::vector<Return> ours = decoded(packets);
  pcl::VLPGrabber grabber(folder.write("vlp16.pcap", capture_of(packets)).string());
  // 16 lasers fire within 34.6 us, in which it turns by 0.125 deg.
  expect_same_returns(ours, grabbed(grabber, ours.size() / 3), 0.14 * kDegree);
}

TEST(VelodyneGrabber, OfPclDecodesAnHdl32eAlike) {
  const testing::TemporaryFolder folder;
  const std::vector<Bytes> packets = packets_of(0x21);
  const std::vector<Return> ours = decoded(packets);
  pcl::HDLGrabber grabber("", folder.write("hdl32e.pcap", capture_of(packets)).string());
  // 32 lasers fire within 35.7 us.
  expect_same_returns(ours, grabbed(grabber, ours.size() / 3), 0.14 * kDegree);
}

}  // namespace
}  // namespace fleetmap::sensor
