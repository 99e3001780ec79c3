#include "recording/ros1_file.hpp"

#include <gmock/gmock.h>

#include <bit>

#include "bag_samples.hpp"
#include "recording/ros1_records.hpp"
#include "ros1_bag.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace recording::testing;
namespace fs = std::filesystem;

constexpr std::uint64_t kSecond = 1'000'000'000;

/// An Imu of ROS 1 at a time, whose turn rate is that of a test.
std::string imu_message(std::uint64_t ns) {
  std::string bytes = u32(9) + time_of(ns) + counted("imu");
  for (int k = 0; k < 37; ++k) {
    const auto raw = std::bit_cast<std::uint64_t>(k == 3 ? 1.0 : k == 15 ? 0.5 : k == 27 ? 9.81 : 0.0);
    bytes += u32(static_cast<std::uint32_t>(raw)) + u32(static_cast<std::uint32_t>(raw >> 32));
  }
  return bytes;
}

/// Three chunks of four messages each, the second of which begins before the first ends. With its connections
/// at the end, as a bag that was closed, or only in its chunks.
std::string bag(const std::string& compression, bool closed) {
  const std::string names =
      connection(1, "/text", "std_msgs/String") + connection(0, "/imu/data", "sensor_msgs/Imu");
  std::string bytes(ros1::kMagic);
  bytes += record({{"op", "\x03"}, {"conn_count", u32(closed ? 2 : 0)}}, std::string(100, ' '));
  for (const auto& times : {std::vector<std::uint64_t>{10, 11, 14, 15}, {12, 13, 16, 17}, {18, 19, 20, 21}}) {
    std::string records = names;
    std::vector<std::uint64_t> ns;
    for (const std::uint64_t time : times) {
      records += message(0, time * kSecond, imu_message(time * kSecond)) +
                 message(1, time * kSecond, counted("hello"));
      ns.push_back(time * kSecond);
    }
    bytes += chunk(records, compression) + index(0, ns) + index(1, ns);
  }
  return closed ? bytes + names : bytes;
}

std::vector<Sample> samples_of(const fs::path& file) {
  ReaderConfig config;
  config.scans_needed = false;
  auto reader = open(file, config);
  EXPECT_TRUE(reader) << reader.error().message;
  return reader ? read_all(**reader) : std::vector<Sample>();
}

TEST(Ros1File, IsReadWhateverItsCompressionAndWhetherItWasClosed) {
  const TemporaryFolder folder;
  for (const char* compression : {"none", "bz2", "lz4"}) {
    for (const bool closed : {true, false}) {
      folder.write("a.bag", bag(compression, closed));
      const auto samples = samples_of(folder.path() / "a.bag");
      ASSERT_EQ(samples.size(), 12u) << compression << closed;
      for (std::size_t k = 0; k < samples.size(); ++k) {
        const auto& imu = std::get<sensor::Imu>(samples[k]);
        EXPECT_EQ(to_ns(imu.stamp), static_cast<std::int64_t>((10 + k) * kSecond));
        EXPECT_EQ(imu.angular_velocity.z(), 0.5);
        EXPECT_EQ(imu.specific_force.z(), 9.81);
      }
    }
  }
}

TEST(Ros1File, WithoutScansIsRefusedWhereTheyAreNeeded) {
  const TemporaryFolder folder;
  folder.write("a.bag", bag("none", true));
  EXPECT_THAT(refusal(folder.path() / "a.bag"), HasSubstr("/imu/data (sensor_msgs/msg/Imu)"));
}

TEST(Ros1File, ThatWasCutIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  const std::string whole = bag("bz2", true);
  std::size_t before = 0;
  for (std::size_t size = ros1::kMagic.size(); size <= whole.size(); size += 41) {
    folder.write("a.bag", whole.substr(0, size));
    ReaderConfig config;
    config.scans_needed = false;
    auto reader = open(folder.path() / "a.bag", config);
    ASSERT_TRUE(reader) << size;
    const std::size_t samples = read_all(**reader).size();
    EXPECT_GE(samples, before) << size;
    before = samples;
  }
  EXPECT_EQ(before, 12u);
}

TEST(Ros1File, OfFlippedBytesIsReadOrRefused) {
  const TemporaryFolder folder;
  const std::string whole = bag("lz4", true);
  for (std::size_t at = ros1::kMagic.size(); at < whole.size(); at += 7) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    folder.write("a.bag", damaged);
    auto file = open_ros1_file(folder.path() / "a.bag");
    if (!file || !(*file)->topics()) continue;
    int messages = 0;
    for (auto message = (*file)->next(); message && *message; message = (*file)->next()) ++messages;
    EXPECT_LE(messages, 24);
  }
}

/// Bags of real robots, bz2, whose counts their readme states.
TEST(Ros1File, OfRealRobotsAreReadWhole) {
  const auto bags = fleetmap::testing::shared_data("robot_localization_bags");
  if (!bags) GTEST_SKIP() << "robot_localization_bags is not installed";
  ReaderConfig config;
  config.scans_needed = false;
  for (const auto& [name, imus, wheels, fixes] :
       {std::tuple("test1.bag", 11865u, 3952u, 989u), std::tuple("test2.bag", 3061u, 3060u, 0u)}) {
    auto reader = open(*bags / name, config);
    ASSERT_TRUE(reader) << reader.error().message;
    read_all(**reader);
    const Counters& counters = (*reader)->counters();
    EXPECT_EQ(counters.imus + counters.time_backwards, imus) << name;
    EXPECT_EQ(counters.wheels, wheels) << name;
    EXPECT_EQ(counters.fixes, fixes) << name;
    EXPECT_EQ(counters.undecodable_messages, 0u) << name;
  }
}

}  // namespace
}  // namespace fleetmap::recording
