#include "fleetmap/recording/reader.hpp"

#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace recording::testing;

TEST(Reader, OpensEveryKindByItsContent) {
  const fleetmap::testing::TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "bag", {.storage = BagStorage::kSqlite}).value();
    put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
  }
  const float point[4] = {1, 2, 3, 0};
  const std::string scan(reinterpret_cast<const char*>(point), sizeof(point));
  folder.write("raw/velodyne_points/data/0.bin", scan);
  folder.write("benchmark/velodyne/0.bin", scan);
  folder.write("benchmark/times.txt", "0\n");
  folder.write("bare/0.bin", scan);
  for (const char* name : {"bag", "bag/bag_0.db3", "raw", "benchmark", "bare"}) {
    auto reader = open(folder.path() / name);
    ASSERT_TRUE(reader) << name << ": " << reader.error().message;
    EXPECT_EQ(read_all(**reader).size(), 1u) << name;
    EXPECT_EQ((*reader)->counters().scans, 1u) << name;
    EXPECT_EQ((*reader)->recorded().has_value(), false) << name << " is at its end";
  }
}

TEST(Reader, ABagIsPreferredToTheScansBesideIt) {
  const fleetmap::testing::TemporaryFolder folder;
  folder.write("both/0.bin", "");
  folder.write("both/a.mcap", "no mcap");
  EXPECT_THAT(refusal(folder.path() / "both"), HasSubstr("a.mcap: this is no mcap file"));
}

TEST(Reader, SaysWhatAPathIsNot) {
  const fleetmap::testing::TemporaryFolder folder;
  const auto text = folder.write("notes.txt", "a drive");
  EXPECT_THAT(refusal(text), AllOf(StartsWith(text.string() + ": is neither a rosbag2 folder"),
                                   EndsWith("nor a folder of .bin or .pcd scans")));
  const auto none = folder.path() / "none.db3";
  EXPECT_EQ(refusal(none), none.string() + ": there is no such recording");
}

TEST(Reader, ChecksItsConfigurationBeforeThePath) {
  ReaderConfig config;
  config.kitti.nominal_rate = 0.0;
  EXPECT_THAT(refusal("/none", config), HasSubstr("must be a positive number of frames per second"));
}

}  // namespace
}  // namespace fleetmap::recording
