#include <gmock/gmock.h>
#include <sqlite3.h>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace recording::testing;
namespace fs = std::filesystem;

/// Reads on to the error that must come.
std::string failure_of(const fs::path& path) {
  auto reader = open(path);
  if (!reader) return reader.error().message;
  while (true) {
    auto sample = (*reader)->next();
    if (!sample) {
      const auto after = (*reader)->next();
      EXPECT_TRUE(after && !*after) << "after an error comes the end";
      return sample.error().message;
    }
    if (!*sample) return "read to its end";
  }
}

TEST(Bag, OneDatabaseFileIsARecording) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b", {.storage = BagStorage::kSqlite});
    put_drive(bag, 1);
  }
  auto reader = open(folder.path() / "b" / "b_0.db3");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 71u);
}

TEST(Bag, SplitsAreReadInOrder) {
  const TemporaryFolder folder;
  for (int k = 0; k < 12; ++k) {
    const std::string name = "part" + std::to_string(k);
    {
      auto bag = *BagWriter::create(folder.path() / name, {.storage = BagStorage::kSqlite});
      put(bag, ros_codec::topics::points(), kStart + k, ros_codec::encode(scan_at(kStart + k)));
    }
    fs::create_directories(folder.path() / "b");
    fs::rename(folder.path() / name / (name + "_0.db3"),
               folder.path() / "b" / ("b_" + std::to_string(k) + ".db3"));
  }
  auto reader = open(folder.path() / "b");
  ASSERT_TRUE(reader) << reader.error().message;
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 12u);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(to_ns(stamp_of(samples[static_cast<std::size_t>(k)])), kStart + k);
}

TEST(Bag, MessagesComeInTheOrderOfReception) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b");
    for (const int k : {3, 1, 2})
      put(bag, ros_codec::topics::points(), kStart + k, ros_codec::encode(scan_at(kStart + k)));
  }
  auto reader = open(folder.path() / "b");
  EXPECT_EQ(read_all(**reader).size(), 3u);
  EXPECT_EQ((*reader)->counters().time_backwards, 0u);
}

TEST(Bag, TimeRunningBackwardsIsSkippedAndCounted) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b");
    for (const int stamp : {10, 20, 15, 20, 30}) {
      static std::int64_t received = kStart;
      put(bag, ros_codec::topics::points(), ++received, ros_codec::encode(scan_at(kStart + stamp)));
    }
    put(bag, ros_codec::topics::imu(), kStart + 100, ros_codec::encode(imu_at(kStart + 1)));
  }
  auto reader = open(folder.path() / "b");
  EXPECT_EQ(read_all(**reader).size(), 4u) << "another kind keeps its own time";
  EXPECT_EQ((*reader)->counters().time_backwards, 2u);
}

TEST(Bag, AClockThatWasSetBackIsFollowedAfterTwoSamples) {
  const TemporaryFolder folder;
  constexpr std::int64_t kSecond = 1'000'000'000;
  {
    auto bag = *BagWriter::create(folder.path() / "b");
    std::int64_t received = kStart;
    // One stray sample from long ago is no clock that was set.
    for (const int stamp : {100, 101, 7, 102, 60, 61, 62, 63, 64}) {
      put(bag, ros_codec::topics::points(), ++received, ros_codec::encode(scan_at(kStart + stamp * kSecond)));
    }
  }
  auto reader = open(folder.path() / "b");
  EXPECT_EQ(read_all(**reader).size(), 6u);
  EXPECT_EQ((*reader)->counters().time_backwards, 3u);
  EXPECT_EQ((*reader)->counters().clocks_set_back, 1u);
}

TEST(Bag, BadMessagesAreSkippedAndCounted) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b");
    const Bytes good = ros_codec::encode(scan_at(kStart));
    put(bag, ros_codec::topics::points(), kStart, good);
    put(bag, ros_codec::topics::points(), kStart + 1, Bytes(good.begin(), good.begin() + 100));
    put(bag, ros_codec::topics::points(), kStart + 2, Bytes{});
    auto empty = scan_at(kStart + 3);
    empty.points.clear();
    put(bag, ros_codec::topics::points(), kStart + 3, ros_codec::encode(empty));
    auto holes = scan_at(kStart + 4);
    holes.points[0].position.x() = std::nanf("");
    holes.points[1].position.setZero();
    holes.points[2].position.setZero();
    put(bag, ros_codec::topics::points(), kStart + 4, ros_codec::encode(holes));
    auto imu = imu_at(kStart + 5);
    imu.angular_velocity.x() = std::nan("");
    put(bag, ros_codec::topics::imu(), kStart + 5, ros_codec::encode(imu));
  }
  auto reader = open(folder.path() / "b");
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(std::get<sensor::Scan>(samples[1]).points.size(), 17u);
  const Counters& counters = (*reader)->counters();
  EXPECT_EQ(counters.undecodable_messages, 3u);
  EXPECT_EQ(counters.empty_scans, 1u);
  EXPECT_EQ(counters.non_finite_points, 1u);
  EXPECT_EQ(counters.origin_points, 2u);
}

TEST(Bag, MessagesWithoutAStampTakeTheTimeOfRecording) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b");
    for (int k = 1; k <= 3; ++k)
      put(bag, ros_codec::topics::points(), kStart + k, ros_codec::encode(scan_at(0)));
  }
  auto reader = open(folder.path() / "b");
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(to_ns(stamp_of(samples[2])), kStart + 3);
  EXPECT_EQ((*reader)->counters().unstamped_messages, 3u);
}

TEST(Bag, ATruncatedFileIsAnErrorThatSaysSo) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b", {.storage = BagStorage::kSqlite});
    put_drive(bag, 20);
  }
  const auto file = folder.path() / "b" / "b_0.db3";
  const auto size = fs::file_size(file);
  for (const auto part :
       {size / 2, size / 10, std::uintmax_t{4096}, std::uintmax_t{1000}, std::uintmax_t{50}}) {
    fs::resize_file(file, part);
    const std::string message = failure_of(folder.path() / "b");
    EXPECT_THAT(message, HasSubstr("b_0.db3")) << part;
    EXPECT_THAT(message, ::testing::AnyOf(HasSubstr("damaged or truncated"),
                                          HasSubstr("this is no rosbag2 sqlite3 file")))
        << part;
  }
  fs::resize_file(file, 0);
  EXPECT_THAT(failure_of(folder.path() / "b"), HasSubstr("no such table: topics"));
}

TEST(Bag, UnreadableBagsNameTheRemedy) {
  const TemporaryFolder folder;
  folder.write("other_storage/metadata.yaml", "rosbag2_bagfile_information:\n  storage_identifier: rocks\n");
  EXPECT_THAT(refusal(folder.path() / "other_storage"),
              HasSubstr("'rocks' is not read here; sqlite3 and mcap are"));
  folder.write("bare_mcap/a.mcap", "");
  EXPECT_THAT(refusal(folder.path() / "bare_mcap"), HasSubstr("a.mcap: this is no mcap file of version 0"));
  folder.write("zstd/a_0.db3.zstd", "");
  EXPECT_THAT(refusal(folder.path() / "zstd"), HasSubstr("a_0.db3.zstd: the zstd file is cut"));
  folder.write("bad/metadata.yaml", "rosbag2_bagfile_information:\n  - [\n");
  EXPECT_THAT(refusal(folder.path() / "bad"), HasSubstr("metadata.yaml:"));
  folder.write("other/metadata.yaml", "a: 1\n");
  EXPECT_THAT(refusal(folder.path() / "other"), HasSubstr("is this a rosbag2 folder?"));
  folder.write(
      "gone/metadata.yaml",
      "rosbag2_bagfile_information:\n  storage_identifier: sqlite3\n  relative_file_paths: [x_0.db3]\n");
  EXPECT_THAT(refusal(folder.path() / "gone"),
              HasSubstr("x_0.db3: is named in metadata.yaml but is not there"));
  folder.write("text.db3", std::string(5000, 'a'));
  EXPECT_THAT(refusal(folder.path() / "text.db3"), HasSubstr("this is no rosbag2 sqlite3 file"));
  folder.write("one.bag", "#ROSBAG V1.2\n");
  EXPECT_THAT(refusal(folder.path() / "one.bag"), HasSubstr("no ROS 1 bag of format 2.0"));
  EXPECT_THAT(refusal(folder.path() / "nowhere"), HasSubstr("there is no such recording"));
  folder.write("empty/readme", "");
  EXPECT_THAT(refusal(folder.path() / "empty"), HasSubstr("is neither a rosbag2 folder"));
}

}  // namespace
}  // namespace fleetmap::recording
