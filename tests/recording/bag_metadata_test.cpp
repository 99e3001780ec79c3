#include "bag_metadata.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string metadata_error(const std::string& text) {
  const TemporaryFolder folder;
  folder.write(kMetadataFile, text);
  const auto metadata = read_metadata(folder.path());
  return metadata ? "no error" : metadata.error().message;
}

const BagMetadata kDriveMetadata{
    .storage = "mcap",
    .compression_format = "zstd",
    .compression_mode = "FILE",
    .files = {"a: b_0.mcap.zstd", "#_1.mcap.zstd"},
    .topics = {{"/points", "sensor_msgs/msg/PointCloud2", 3, {}}, {"/imu", "x/msg/Imu", 40, {}}},
    .first_ns = 1'700'000'000'000'000'005,
    .last_ns = 1'700'000'003'500'000'000};

TEST(BagMetadata, WrittenContentIsRead) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_metadata(folder.path(), kDriveMetadata));
  const auto read = read_metadata(folder.path());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->storage, "mcap");
  EXPECT_EQ(read->compression_format, "zstd");
  EXPECT_EQ(read->compression_mode, "FILE");
  EXPECT_THAT(read->files, ElementsAre("a: b_0.mcap.zstd", "#_1.mcap.zstd"));
  BagMetadata empty;
  ASSERT_TRUE(write_metadata(folder.path(), empty));
  EXPECT_EQ(read_metadata(folder.path())->storage, "sqlite3");
  EXPECT_THAT(read_metadata(folder.path())->files, IsEmpty()) << "the file is replaced as a whole";
}

TEST(BagMetadata, WritesWhatRosbag2OfHumbleWants) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_metadata(folder.path(), kDriveMetadata));
  const YAML::Node info =
      YAML::LoadFile((folder.path() / kMetadataFile).string())["rosbag2_bagfile_information"];
  EXPECT_EQ(info["version"].as<int>(), 5);
  EXPECT_EQ(info["message_count"].as<int>(), 43);
  EXPECT_EQ(info["starting_time"]["nanoseconds_since_epoch"].as<std::int64_t>(), 1'700'000'000'000'000'005);
  EXPECT_EQ(info["duration"]["nanoseconds"].as<std::int64_t>(), 3'499'999'995);
  const YAML::Node topics = info["topics_with_message_count"];
  ASSERT_EQ(topics.size(), 2u);
  EXPECT_EQ(topics[1]["topic_metadata"]["name"].as<std::string>(), "/imu");
  EXPECT_EQ(topics[1]["topic_metadata"]["type"].as<std::string>(), "x/msg/Imu");
  EXPECT_EQ(topics[1]["topic_metadata"]["serialization_format"].as<std::string>(), "cdr");
  EXPECT_EQ(topics[1]["message_count"].as<int>(), 40);
  EXPECT_EQ(info["files"].size(), 2u);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1u) << "the draft is gone";
}

TEST(BagMetadata, UnknownContentIsReadAsFarAsPossible) {
  const TemporaryFolder folder;
  folder.write(kMetadataFile, "rosbag2_bagfile_information: {version: 9, compression_mode: [x]}\n");
  const auto metadata = read_metadata(folder.path());
  ASSERT_TRUE(metadata) << metadata.error().message;
  EXPECT_EQ(metadata->storage, "");
  EXPECT_EQ(metadata->compression_mode, "");
  EXPECT_THAT(metadata->files, IsEmpty());
}

TEST(BagMetadata, ProblemsNameTheFileAndItsLine) {
  EXPECT_THAT(metadata_error("a: 1\n"),
              HasSubstr("metadata.yaml: has no rosbag2_bagfile_information; is this"));
  EXPECT_THAT(metadata_error("rosbag2_bagfile_information: text\n"), HasSubstr("is this a rosbag2 folder?"));
  EXPECT_THAT(metadata_error("rosbag2_bagfile_information:\n  relative_file_paths: [[x]]\n"),
              HasSubstr("metadata.yaml:2: "));
  EXPECT_THAT(metadata_error("a: 1\nb: [\n"), HasSubstr("metadata.yaml:3: "));
  const TemporaryFolder folder;
  EXPECT_THAT(read_metadata(folder.path()).error().message, HasSubstr("metadata.yaml"));
  EXPECT_THAT(write_metadata(folder.path() / "none", kDriveMetadata).error().message,
              HasSubstr("metadata.yaml: cannot be written: No such file or directory"));
}

}  // namespace
}  // namespace fleetmap::recording
