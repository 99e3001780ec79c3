#include "recording/sqlite_file.hpp"

#include <gtest/gtest.h>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using namespace recording::testing;

TEST(SqliteFile, GivesMessagesByTimeWithTheirTopics) {
  const TemporaryFolder folder;
  {
    auto bag = *BagWriter::create(folder.path() / "b", {.storage = BagStorage::kSqlite});
    put(bag, ros_codec::topics::points(), kStart + 2, Bytes{2});
    put(bag, ros_codec::topics::imu(), kStart + 1, Bytes{1, 1});
    put(bag, ros_codec::topics::points(), kStart + 3, Bytes{});
  }
  auto file = open_sqlite_file(folder.path() / "b" / "b_0.db3");
  ASSERT_TRUE(file) << file.error().message;
  const std::vector<BagTopic> topics{{"/points", "sensor_msgs/msg/PointCloud2"},
                                     {"/imu", "sensor_msgs/msg/Imu"}};
  EXPECT_EQ((*file)->topics(), topics);
  std::vector<std::tuple<std::string, std::int64_t, std::size_t>> rows;
  for (auto message = (*file)->next(); message && *message; message = (*file)->next())
    rows.emplace_back((*message)->topic, (*message)->received_ns - kStart, (*message)->cdr.size());
  EXPECT_EQ(rows, (decltype(rows){{"/imu", 1, 2}, {"/points", 2, 1}, {"/points", 3, 0}}));
  const auto after = (*file)->next();
  EXPECT_TRUE(after && !*after);
}

TEST(SqliteFile, ThatIsNoDatabaseIsRefused) {
  const TemporaryFolder folder;
  folder.write("a.db3", std::string(5000, 'a'));
  EXPECT_FALSE(open_sqlite_file(folder.path() / "a.db3"));
}

}  // namespace
}  // namespace fleetmap::recording
