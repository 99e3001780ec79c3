#include "recording/mcap_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "bag_samples.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace recording::testing;
namespace fs = std::filesystem;

const fs::path kData = fs::path(FLEETMAP_SOURCE_DIR) / "tests/recording/data";

/// Expects the contents that an independent writer put into each file of the folder: scans at 10 Hz, an IMU
/// at 50 Hz, 0.4 s.
void expect_drive(const fs::path& file, std::size_t scans = 4, std::size_t imus = 20) {
  auto reader = open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  EXPECT_EQ((*reader)->counters().scans, scans) << file;
  EXPECT_EQ((*reader)->counters().imus, imus) << file;
  EXPECT_EQ((*reader)->counters().time_backwards, 0u) << file;
  std::int64_t k = 0;
  for (const Sample& sample : samples) {
    if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
      EXPECT_EQ(to_ns(imu->stamp), kStart + k++ * 20'000'000);
      EXPECT_EQ(imu->specific_force.z(), 9.81);
      EXPECT_EQ(imu->angular_velocity.z(), 0.1);
    } else {
      const auto& points = std::get<sensor::Scan>(sample).points;
      ASSERT_EQ(points.size(), 10u);
      EXPECT_EQ(points[4].position, Eigen::Vector3f(5.0f, 2.0f, 3.0f));
    }
  }
}

TEST(McapFile, IsReadWhateverItsChunks) {
  for (const char* name :
       {"plain.mcap", "zstd.mcap", "lz4.mcap", "no_chunks.mcap", "disordered.mcap", "no_schemas.mcap"})
    expect_drive(kData / name);
}

TEST(McapFile, IsABagWithItsMetadataToo) {
  const TemporaryFolder folder;
  folder.write("b/b_0.mcap", fleetmap::testing::file_text(kData / "zstd.mcap"));
  expect_drive(folder.path() / "b");
  folder.write(
      "b/metadata.yaml",
      "rosbag2_bagfile_information:\n  storage_identifier: mcap\n  relative_file_paths: [b_0.mcap]\n");
  expect_drive(folder.path() / "b");
}

TEST(McapFile, ThatWasCutIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  constexpr std::size_t mcap_tail_bytes = 29 + 8 + 1;  // footer and magic
  for (const char* name : {"plain.mcap", "zstd.mcap", "lz4.mcap", "no_chunks.mcap"}) {
    const std::string whole = fleetmap::testing::file_text(kData / name);
    std::size_t before = 0;
    for (std::size_t size = 0; size < whole.size(); size += 97) {
      folder.write("cut.mcap", whole.substr(0, size));
      auto reader = open(folder.path() / "cut.mcap");
      if (!reader) {
        EXPECT_THAT(reader.error().message,
                    ::testing::AnyOf(HasSubstr("no mcap file"), HasSubstr("no topic")));
        EXPECT_LT(size, whole.size() / 2) << name;
        continue;
      }
      const std::size_t samples = read_all(**reader).size();
      const bool footer_is_there = size + mcap_tail_bytes > whole.size();
      EXPECT_GE((*reader)->counters().damaged_parts, footer_is_there ? 0u : 1u) << name << " of " << size;
      EXPECT_GE(samples, before) << name << " of " << size;
      before = samples;
    }
    EXPECT_EQ(before, 24u) << name;
  }
}

TEST(McapFile, ADamagedChunkIsLeftOutAndCounted) {
  const TemporaryFolder folder;
  std::string whole = fleetmap::testing::file_text(kData / "zstd.mcap");
  const std::size_t frame = whole.find("\x28\xb5\x2f\xfd", whole.size() / 4);
  ASSERT_NE(frame, std::string::npos);
  whole[frame + 20] = static_cast<char>(whole[frame + 20] ^ 0x55);
  folder.write("a.mcap", whole);
  auto reader = open(folder.path() / "a.mcap");
  ASSERT_TRUE(reader) << reader.error().message;
  const std::size_t samples = read_all(**reader).size();
  EXPECT_GT(samples, 10u);
  EXPECT_LT(samples, 24u);
  EXPECT_EQ((*reader)->counters().damaged_parts, 1u);
}

/// Any bytes are read to an end, within memory.
TEST(McapFile, OfFlippedBytesIsReadOrRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"plain.mcap", "lz4.mcap"}) {
    const std::string whole = fleetmap::testing::file_text(kData / name);
    for (std::size_t at = 0; at < whole.size(); at += 13) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(~damaged[at]);
      folder.write("a.mcap", damaged);
      auto file = open_mcap_file(folder.path() / "a.mcap");
      if (!file) continue;
      EXPECT_TRUE((*file)->topics());
      int messages = 0;
      for (auto message = (*file)->next(); message && *message; message = (*file)->next()) ++messages;
      EXPECT_LE(messages, 24);
    }
  }
}

TEST(McapFile, OfAnotherEncodingSaysSo) {
  const TemporaryFolder folder;
  std::string ros1 = fleetmap::testing::file_text(kData / "plain.mcap");
  for (std::size_t at = ros1.find("cdr"); at != std::string::npos; at = ros1.find("cdr", at))
    ros1.replace(at, 3, "ros");
  folder.write("a.mcap", ros1);  // with the wrong checksum of its chunks, but the summary is plain
  EXPECT_THAT(refusal(folder.path() / "a.mcap"), HasSubstr("(sensor_msgs/msg/PointCloud2 in ros)"));
}

}  // namespace
}  // namespace fleetmap::recording
