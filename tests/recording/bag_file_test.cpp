#include "recording/bag_file.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "bag_samples.hpp"
#include "recording/compressed.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::zstd_of;
using namespace recording::testing;
namespace fs = std::filesystem;

/// Compresses a file in its place, as `ros2 bag record --compression-mode file` does.
void compress(const fs::path& file) {
  const Bytes packed = zstd_of(fleetmap::testing::file_bytes(file));
  std::ofstream out(file.string() + ".zstd", std::ios::binary);
  out.write(reinterpret_cast<const char*>(packed.data()), static_cast<std::streamsize>(packed.size()));
  fs::remove(file);
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(BagFile, CompressedAsAWholeIsUnpackedWhileItIsRead) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b", {.storage = BagStorage::kSqlite});
    put_drive(bag, 1);
  }
  compress(folder.path() / "b" / "b_0.db3");
  folder.write("b/metadata.yaml",
               "rosbag2_bagfile_information:\n  storage_identifier: sqlite3\n  compression_format: zstd\n"
               "  compression_mode: FILE\n  relative_file_paths: [b_0.db3.zstd]\n");
  fs::copy(fs::path(FLEETMAP_SOURCE_DIR) / "tests/recording/data/plain.mcap", folder.path() / "a.mcap");
  compress(folder.path() / "a.mcap");
  const fs::path unpacked = folder.path() / "tmp";
  fs::create_directory(unpacked);
  ::setenv("TMPDIR", unpacked.c_str(), 1);
  {
    auto reader = open(folder.path() / "b");
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(read_all(**reader).size(), 71u);
    auto mcap = open(folder.path() / "a.mcap.zstd");
    ASSERT_TRUE(mcap) << mcap.error().message;
    ASSERT_TRUE((*mcap)->next());
    EXPECT_EQ(files_in(unpacked), 0u) << "it has no name while it is read";
  }
  EXPECT_EQ(files_in(unpacked), 0u) << "nothing is left behind";
  fs::remove(unpacked);
  const auto nowhere = open_bag_file(folder.path() / "a.mcap.zstd");
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(nowhere.error().message, HasSubstr("set TMPDIR"));
  ::unsetenv("TMPDIR");
}

TEST(BagFile, MessagesCompressedOneByOneAreUnpacked) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b", {.storage = BagStorage::kSqlite});
    put(bag, ros_codec::topics::points(), kStart, zstd_of(ros_codec::encode(scan_at(kStart))));
    put(bag, ros_codec::topics::imu(), kStart + 1, zstd_of(ros_codec::encode(imu_at(kStart))));
    put(bag, ros_codec::topics::points(), kStart + 2, Bytes{0x28, 0xb5, 0x2f, 0xfd, 1, 2, 3});
  }
  folder.write("b/metadata.yaml",
               "rosbag2_bagfile_information:\n  storage_identifier: sqlite3\n  compression_format: zstd\n"
               "  compression_mode: MESSAGE\n  relative_file_paths: [b_0.db3]\n");
  auto reader = open(folder.path() / "b");
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(std::get<sensor::Scan>(samples[0]).points.size(), 20u);
  EXPECT_EQ((*reader)->counters().undecodable_messages, 1u);
}

}  // namespace
}  // namespace fleetmap::recording
