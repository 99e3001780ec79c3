#include "bag_reader.hpp"

#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace recording::testing;
namespace fs = std::filesystem;

class BagReaderTest : public ::testing::Test {
 protected:
  /// Writes scans at these stamps (ns after kStart), received 5 ns later, and returns the database's file.
  fs::path write_bag(const std::string& name, std::initializer_list<std::int64_t> stamps) const {
    auto bag = BagWriter::create(folder_.path() / name, {.storage = BagStorage::kSqlite}).value();
    for (const std::int64_t ns : stamps)
      put(bag, ros_codec::topics::points(), kStart + ns + 5, ros_codec::encode(scan_at(kStart + ns)));
    EXPECT_TRUE(bag.close());
    return folder_.path() / name / (name + "_0.db3");
  }
  Result<std::unique_ptr<Reader>> open(const std::string& name,
                                       ScanContent content = ScanContent::kPoints) const {
    return open_bag(folder_.path() / name, {}, content);
  }
  std::vector<std::int64_t> stamps(const std::string& name) const {
    auto reader = open(name);
    EXPECT_TRUE(reader) << reader.error().message;
    std::vector<std::int64_t> found;
    if (!reader) return found;
    for (const Sample& sample : read_all(**reader)) found.push_back(to_ns(stamp_of(sample)) - kStart);
    return found;
  }

  fleetmap::testing::TemporaryFolder folder_;
};

TEST_F(BagReaderTest, ABagIsToldByItsNames) {
  for (const char* bag : {"a.db3", "a.mcap", "a.bag", "a.db3.zstd", "a.mcap.zstd"})
    EXPECT_TRUE(is_bag(bag)) << bag;
  for (const char* other : {"a.bin", "a.zstd", "db3", "a.bag.zstd", "a.db3.xz"})
    EXPECT_FALSE(is_bag(other)) << other;
  folder_.write("with_metadata/metadata.yaml", "");
  folder_.write("with_file/x.mcap", "");
  folder_.write("without/x.txt", "");
  EXPECT_TRUE(is_bag(folder_.path() / "with_metadata"));
  EXPECT_TRUE(is_bag(folder_.path() / "with_file"));
  EXPECT_FALSE(is_bag(folder_.path() / "without"));
}

TEST_F(BagReaderTest, TheOrderOfFilesIsThatOfTheMetadata) {
  fs::create_directories(folder_.path() / "bag");
  fs::rename(write_bag("late", {30, 40}), folder_.path() / "bag" / "a.db3");
  fs::rename(write_bag("early", {10, 20}), folder_.path() / "bag" / "b.db3");
  EXPECT_THAT(stamps("bag"), ElementsAre(30, 40)) << "without, that of the names: the earlier are skipped";
  folder_.write("bag/metadata.yaml",
                "rosbag2_bagfile_information: {storage_identifier: sqlite3,"
                " relative_file_paths: [elsewhere/b.db3, a.db3]}\n");
  EXPECT_THAT(stamps("bag"), ElementsAre(10, 20, 30, 40)) << "files are those of the folder";
}

TEST_F(BagReaderTest, AFileThatWasUnpackedByHandIsTaken) {
  write_bag("bag", {10});
  folder_.write("bag/metadata.yaml",
                "rosbag2_bagfile_information: {storage_identifier: sqlite3, compression_format: zstd,"
                " compression_mode: FILE, relative_file_paths: [bag_0.db3.zstd]}\n");
  EXPECT_THAT(stamps("bag"), ElementsAre(10));
}

TEST_F(BagReaderTest, TellsWhenTheLastSampleWasRecorded) {
  write_bag("bag", {10, 20});
  auto reader = open("bag").value();
  EXPECT_FALSE(reader->recorded()) << "nothing was read yet";
  ASSERT_TRUE(reader->next().value());
  EXPECT_EQ(reader->recorded(), stamp_from_ns(kStart + 15));
  ASSERT_TRUE(reader->next().value());
  EXPECT_EQ(reader->recorded(), stamp_from_ns(kStart + 25));
  EXPECT_FALSE(reader->next().value());
  EXPECT_FALSE(reader->recorded());
  EXPECT_FALSE(reader->next().value()) << "the end stays the end";
}

TEST_F(BagReaderTest, ScansAreDecodedOnlyIfTheirPointsAreWanted) {
  write_bag("bag", {10});
  const auto whole = open("bag").value()->next().value();
  const auto stamp = open("bag", ScanContent::kStampOnly).value()->next().value();
  ASSERT_TRUE(whole && stamp);
  EXPECT_EQ(std::get<sensor::Scan>(*whole).points.size(), 20u);
  EXPECT_TRUE(std::get<sensor::Scan>(*stamp).points.empty());
  EXPECT_EQ(stamp_of(*stamp), stamp_of(*whole));
}

TEST_F(BagReaderTest, AFolderWithMetadataAloneHasNothingToRead) {
  folder_.write("bag/metadata.yaml", "rosbag2_bagfile_information: {storage_identifier: mcap}\n");
  const auto reader = open("bag");
  ASSERT_FALSE(reader);
  EXPECT_THAT(reader.error().message, HasSubstr("bag: has no .db3, .mcap or .bag file"));
}

}  // namespace
}  // namespace fleetmap::recording
