#include "fleetmap/recording/bag_writer.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iterator>

#include "bag_samples.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace recording::testing;

constexpr BagFormat kMcap{.storage = BagStorage::kMcap};
constexpr BagFormat kSqlite{.storage = BagStorage::kSqlite};

/// Each storage.
class BagWriterOf : public ::testing::TestWithParam<BagFormat> {};
INSTANTIATE_TEST_SUITE_P(Storages, BagWriterOf, ::testing::Values(kMcap, kSqlite), [](const auto& instance) {
  return instance.param.storage == BagStorage::kMcap ? "mcap" : "sqlite3";
});

TEST_P(BagWriterOf, WhatIsWrittenIsRead) {
  const TemporaryFolder folder;
  const auto dir = folder.path() / "drive";
  {
    auto bag = BagWriter::create(dir, GetParam());
    ASSERT_TRUE(bag) << bag.error().message;
    put_drive(*bag, 3);
    ASSERT_TRUE(bag->close());
  }
  auto reader = open(dir);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  EXPECT_EQ(samples.size(), 150u + 30u + 30u + 3u);
  const Counters& counters = (*reader)->counters();
  EXPECT_EQ(counters.scans, 30u);
  EXPECT_EQ(counters.imus, 150u);
  EXPECT_EQ(counters.fixes, 3u);
  EXPECT_EQ(counters.wheels, 30u);
  for (std::size_t k = 1; k < samples.size(); ++k) EXPECT_LE(stamp_of(samples[k - 1]), stamp_of(samples[k]));
  for (const auto& [name, count] : counters.named()) {
    if (name != "scans" && name != "imus" && name != "fixes" && name != "wheels") {
      EXPECT_EQ(count, 0u) << name;
    }
  }
  const auto& scan = std::get<sensor::Scan>(samples[1]);
  EXPECT_EQ(scan.points.size(), 20u);
  EXPECT_EQ(scan.points[7].position, Eigen::Vector3f(8, 2, 3));
}

TEST(BagWriter, LeavesWhatRosbag2OfHumbleExpects) {
  const TemporaryFolder folder;
  const auto dir = folder.path() / "drive";
  {
    auto bag = BagWriter::create(dir, kSqlite);
    ASSERT_TRUE(bag);
    put(*bag, ros_codec::topics::imu(), kStart, ros_codec::encode(imu_at(kStart)));
    put(*bag, ros_codec::topics::imu(), kStart + 5, ros_codec::encode(imu_at(kStart + 5)));
    put(*bag, fleet_codec::topics::global_pose(), kStart + 9, fleet_codec::encode(GlobalPose{}));
  }
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(dir)) files.push_back(entry.path().filename());
  EXPECT_THAT(files, ::testing::UnorderedElementsAre("metadata.yaml", "drive_0.db3"));
  const std::string yaml = fleetmap::testing::file_text(dir / "metadata.yaml");
  for (const char* line :
       {"version: 5", "storage_identifier: sqlite3", "nanoseconds: 9",
        "nanoseconds_since_epoch: 1700000000000000000", "message_count: 3", "name: /imu",
        "type: sensor_msgs/msg/Imu", "serialization_format: cdr",
        "offered_qos_profiles: \"- history: 1\\n  depth: 10\\n  reliability: 1\\n  durability: 2\\n",
        "name: /fleetmap/global_pose", "type: fleetmap/msg/GlobalPose", "- drive_0.db3",
        "compression_mode: \"\""}) {
    EXPECT_THAT(yaml, HasSubstr(line));
  }
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((dir / "drive_0.db3").c_str(), &database), SQLITE_OK);
  std::string rows;
  const auto collect = [](void* out, int columns, char** values, char**) {
    for (int k = 0; k < columns; ++k) *static_cast<std::string*>(out) += std::string(values[k]) + "|";
    return 0;
  };
  sqlite3_exec(database,
               "SELECT schema_version, ros_distro FROM schema; SELECT id, name, type, serialization_format "
               "FROM topics;"
               "SELECT id, topic_id, timestamp, hex(substr(data, 1, 4)) FROM messages",
               collect, &rows, nullptr);
  sqlite3_close(database);
  EXPECT_EQ(
      rows,
      "3|humble|1|/imu|sensor_msgs/msg/Imu|cdr|2|/fleetmap/global_pose|fleetmap/msg/GlobalPose|cdr|"
      "1|1|1700000000000000000|00010000|2|1|1700000000000000005|00010000|3|2|1700000000000000009|00010000|");
}

TEST(BagWriter, WritesMcapWithoutAnotherWord) {
  const TemporaryFolder folder;
  const auto dir = folder.path() / "drive";
  {
    auto bag = BagWriter::create(dir);
    ASSERT_TRUE(bag);
    const bus::Topic mounts = ros_codec::topics::tf_static(), frames = ros_codec::topics::tf();
    ASSERT_TRUE(
        bag->write(mounts.name, mounts.type, stamp_from_ns(kStart), Bytes(8), Durability::kTransientLocal));
    ASSERT_TRUE(bag->write(frames.name, frames.type, stamp_from_ns(kStart), Bytes(8)));
  }
  EXPECT_TRUE(std::filesystem::exists(dir / "drive_0.mcap"));
  const std::string yaml = fleetmap::testing::file_text(dir / "metadata.yaml");
  EXPECT_THAT(yaml, HasSubstr("storage_identifier: mcap\n"));
  EXPECT_THAT(yaml, HasSubstr("- drive_0.mcap\n"));
  const std::size_t mounts = yaml.find("name: /tf_static\n"), frames = yaml.find("name: /tf\n");
  ASSERT_LT(mounts, frames);
  ASSERT_NE(frames, std::string::npos);
  EXPECT_THAT(yaml.substr(mounts, frames - mounts), HasSubstr("durability: 1\\n")) << "latched";
  EXPECT_THAT(yaml.substr(frames), HasSubstr("durability: 2\\n"));
}

TEST_P(BagWriterOf, AKilledWriterLeavesAReadableBag) {
  const TemporaryFolder folder;
  const auto dir = folder.path() / "killed";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto bag = BagWriter::create(dir, GetParam());
    if (!bag) _exit(1);
    put_drive(*bag, 3);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_FALSE(std::filesystem::exists(dir / "metadata.yaml"));
  auto reader = open(dir);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  // Commits come once a second, so at least two of the three are there.
  EXPECT_GE(to_ns(stamp_of(samples.back())), kStart + 1'980'000'000);
}

TEST_P(BagWriterOf, FlushedMessagesAreThereForAReaderAtOnce) {
  const TemporaryFolder folder;
  auto bag = BagWriter::create(folder.path() / "live", GetParam());
  ASSERT_TRUE(bag);
  put(*bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
  ASSERT_TRUE(bag->flush());
  auto reader = open(folder.path() / "live");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 1u);
}

TEST(BagWriter, NeverWritesIntoABagThatIsThere) {
  const TemporaryFolder folder;
  for (const BagFormat& format : {kMcap, kSqlite}) {
    const auto dir = folder.path() / (format.storage == BagStorage::kMcap ? "a" : "b");
    { ASSERT_TRUE(BagWriter::create(dir, format)); }
    std::filesystem::remove(dir / "metadata.yaml");
    for (const BagFormat& other : {kMcap, kSqlite})
      EXPECT_THAT(BagWriter::create(dir, other).error().message,
                  HasSubstr("holds a bag already; record to another folder"));
  }
  folder.write("file", "");
  EXPECT_THAT(BagWriter::create(folder.path() / "file" / "b").error().message, HasSubstr("cannot be made"));
}

TEST(BagWriter, AClosedBagTakesNothing) {
  const TemporaryFolder folder;
  auto bag = BagWriter::create(folder.path() / "a");
  ASSERT_TRUE(bag->close());
  const auto status =
      bag->write("rt/imu", "sensor_msgs::msg::dds_::Imu_", stamp_from_ns(1), Bytes{0, 1, 0, 0});
  EXPECT_THAT(status.error().message, HasSubstr("the bag is closed"));
}

TEST(BagWriter, AssigningOverAnOpenBagClosesIt) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "a");
    put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
    bag = *BagWriter::create(folder.path() / "b");
    put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
  }
  for (const char* name : {"a", "b"}) {
    auto reader = open(folder.path() / name);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(read_all(**reader).size(), 1u);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name / "metadata.yaml"));
  }
}

}  // namespace
}  // namespace fleetmap::recording
