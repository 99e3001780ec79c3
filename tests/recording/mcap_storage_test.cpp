#include "recording/mcap_storage.hpp"

#include <gmock/gmock.h>

#include "recording/mcap_file.hpp"
#include "recording/mcap_records.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class McapStorageTest : public ::testing::Test {
 protected:
  std::unique_ptr<StorageFile> create(ChunkCompression compression) {
    auto storage = std::move(create_mcap_storage(file_, compression).value());
    EXPECT_TRUE(storage->add_topic({"/tf_static", "tf2_msgs/msg/TFMessage", "- durability: 1"}));
    EXPECT_TRUE(storage->add_topic({"/tf", "tf2_msgs/msg/TFMessage", "- durability: 2"}));
    EXPECT_TRUE(storage->add_topic({"/own", "fleetmap/msg/GlobalPose", "- durability: 2"}));
    return storage;
  }
  std::vector<std::string> read() const {
    std::vector<std::string> all;
    auto file = open_mcap_file(file_).value();
    topics_ = file->topics().value();
    for (auto message = file->next(); message && *message; message = file->next())
      all.push_back((*message)->topic + ' ' + std::to_string((*message)->received_ns) + ' ' +
                    std::to_string((*message)->cdr.size()));
    return all;
  }

  fleetmap::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.mcap";
  mutable std::vector<BagTopic> topics_;
};

TEST_F(McapStorageTest, ItsOwnReaderReadsItByTimeWhateverItsCompression) {
  for (const auto compression : {ChunkCompression::kZstd, ChunkCompression::kLz4, ChunkCompression::kNone}) {
    const auto storage = create(compression);
    ASSERT_TRUE(storage->write(1, 30, Bytes(5)));
    ASSERT_TRUE(storage->write(0, 10, Bytes(1'000)));
    ASSERT_TRUE(storage->flush());
    ASSERT_TRUE(storage->flush()) << "an empty chunk is none";
    ASSERT_TRUE(storage->write(2, 20, Bytes(7)));
    ASSERT_TRUE(storage->close());
    EXPECT_THAT(read(), ElementsAre("/tf_static 10 1000", "/own 20 7", "/tf 30 5"));
    EXPECT_THAT(topics_, ElementsAre(BagTopic{"/tf_static", "tf2_msgs/msg/TFMessage"},
                                     BagTopic{"/tf", "tf2_msgs/msg/TFMessage"},
                                     BagTopic{"/own", "fleetmap/msg/GlobalPose"}));
  }
}

TEST_F(McapStorageTest, HoldsDefinitionsAndProfiles) {
  ASSERT_TRUE(create(ChunkCompression::kZstd)->close());
  const std::string text = fleetmap::testing::file_text(file_);
  EXPECT_THAT(text, HasSubstr("MSG: geometry_msgs/TransformStamped\n"));
  EXPECT_THAT(text, HasSubstr("offered_qos_profiles"));
  EXPECT_THAT(text, HasSubstr("- durability: 1"));
  EXPECT_TRUE(read().empty());
}

TEST_F(McapStorageTest, WhatWasFlushedIsReadWithoutAnEnd) {
  const auto storage = create(ChunkCompression::kLz4);
  ASSERT_TRUE(storage->write(1, 10, Bytes(5)));
  ASSERT_TRUE(storage->flush());
  ASSERT_TRUE(storage->write(1, 20, Bytes(5)));
  EXPECT_THAT(read(), ElementsAre("/tf 10 5"));
}

TEST_F(McapStorageTest, AFullDiskIsNamed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  auto storage = create_mcap_storage("/dev/full", ChunkCompression::kNone);
  ASSERT_TRUE(storage);
  ASSERT_TRUE((*storage)->write(0, 1, Bytes(100)));
  EXPECT_THAT((*storage)->flush().error().message, HasSubstr("is the disk full?"));
  const Status later = (*storage)->write(0, 2, Bytes(100));
  ASSERT_FALSE(later) << "it would be kept in memory for ever";
  EXPECT_THAT(later.error().message, HasSubstr("is the disk full?"));
  EXPECT_THAT(create_mcap_storage(folder_.path() / "none/a.mcap", ChunkCompression::kNone).error().message,
              HasSubstr("none/a.mcap: cannot be written"));
}

}  // namespace
}  // namespace fleetmap::recording
