#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace recording::testing;

constexpr char kCloud[] = "sensor_msgs/msg/PointCloud2";

/// A bag with a message on each of the topics.
void write_bag(const std::filesystem::path& dir,
               const std::vector<std::pair<const char*, const char*>>& topics) {
  auto bag = BagWriter::create(dir);
  ASSERT_TRUE(bag);
  for (const auto& [name, type] : topics) {
    const std::string kind = type;
    const Bytes cdr = kind == kCloud ? ros_codec::encode(scan_at(kStart))
                      : kind == "sensor_msgs/msg/Imu"
                          ? ros_codec::encode(imu_at(kStart))
                          : ros_codec::encode(sensor::Wheel{stamp_from_ns(kStart), 1.0, {}});
    ASSERT_TRUE(bag->write(name, type, stamp_from_ns(kStart), cdr));
  }
}

TEST(BagTopics, TheOnlyTopicOfATypeIsTaken) {
  const TemporaryFolder folder;
  write_bag(
      folder.path() / "b",
      {{"/velodyne_points", kCloud}, {"/imu/data", "sensor_msgs/msg/Imu"}, {"/chat", "std_msgs/msg/String"}});
  auto reader = open(folder.path() / "b");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 2u);
}

TEST(BagTopics, SeveralOfATypeNeedAChoice) {
  const TemporaryFolder folder;
  const auto bag = folder.path() / "b";
  write_bag(bag, {{"/left", kCloud},
                  {"/right", kCloud},
                  {"/odom", "nav_msgs/msg/Odometry"},
                  {"/ekf", "nav_msgs/msg/Odometry"}});
  EXPECT_THAT(
      refusal(bag),
      AllOf(HasSubstr(
                "several topics of type sensor_msgs/msg/PointCloud2: /left (sensor_msgs/msg/PointCloud2), "
                "/right (sensor_msgs/msg/PointCloud2)"),
            HasSubstr("choose one with recording.topics.points")));
  ReaderConfig config;
  config.topics.points = "/left";
  EXPECT_THAT(refusal(bag, config), HasSubstr("choose one with recording.topics.wheel (or none)"));
  config.topics.wheel = "none";
  auto reader = open(bag, config);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 1u);
}

TEST(BagTopics, OurOwnNamesNeedNoChoice) {
  const TemporaryFolder folder;
  write_bag(folder.path() / "b", {{"/points", kCloud},
                                  {"/odometry", "nav_msgs/msg/Odometry"},
                                  {"/wheel_odometry", "nav_msgs/msg/Odometry"}});
  auto reader = open(folder.path() / "b");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 2u);
}

/// Its map, its fix and its odometry are no sensors, however few others there are.
TEST(BagTopics, TopicsOfTheProgramAreNoInput) {
  const TemporaryFolder folder;
  const auto bag = folder.path() / "b";
  write_bag(bag, {{"/velodyne_points", kCloud},
                  {"/fleetmap/map", kCloud},
                  {"/fleetmap/submaps", kCloud},
                  {"/odometry", "nav_msgs/msg/Odometry"}});
  auto reader = open(bag);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 1u) << "only the points of the LiDAR";
  ReaderConfig config;
  config.topics.wheel = "/odometry";
  reader = open(bag, config);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 2u) << "unless it is named";
}

TEST(BagTopics, ALoneOdometryOfAnotherProgramIsTaken) {
  const TemporaryFolder folder;
  write_bag(folder.path() / "b", {{"/velodyne_points", kCloud}, {"/odometry", "nav_msgs/msg/Odometry"}});
  auto reader = open(folder.path() / "b");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 2u);
}

TEST(BagTopics, MissingTopicsAreNamed) {
  const TemporaryFolder folder;
  const auto bag = folder.path() / "b";
  write_bag(bag, {{"/imu", "sensor_msgs/msg/Imu"}});
  EXPECT_THAT(
      refusal(bag),
      AllOf(HasSubstr("no topic of points, of type sensor_msgs/msg/PointCloud2, "
                      "livox_ros_driver2/msg/CustomMsg, "),
            HasSubstr(" or velodyne_msgs/msg/VelodyneScan; the bag has: /imu (sensor_msgs/msg/Imu). "),
            HasSubstr("The LiDAR was off, or its topic or type is another"),
            HasSubstr("recording.topics.points")));
  ReaderConfig config;
  config.topics.points = "/scan";
  EXPECT_THAT(refusal(bag, config),
              HasSubstr("recording.topics.points is '/scan', but the bag has no such topic of type "
                        "sensor_msgs/msg/PointCloud2; it has: /imu (sensor_msgs/msg/Imu)"));
}

}  // namespace
}  // namespace fleetmap::recording
