#include "fleetmap/monitor/preview_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "fleetmap/cloud/codec.hpp"
#include "monitor/content.hpp"
#include "store/items.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::monitor {
namespace {

class PreviewWriterTest : public ::testing::Test {
 protected:
  PreviewWriterTest() {
    for (std::uint32_t seq = 0; seq < 3; ++seq) {
      const Bytes submap = cloud::encode(cloud_of(seq), {}).value();
      const graph::Node node = testing::make_node(testing::agent("r1"), seq, submap, 5.0 * seq);
      EXPECT_TRUE(store_.put_node_with_submap(node, submap));
      nodes_.push_back(node);
    }
  }
  static cloud::PointCloud cloud_of(std::uint32_t seq) {
    cloud::PointCloud cloud;
    for (std::uint32_t k = 0; k < 2000; ++k)
      cloud.points.emplace_back(static_cast<float>(k % 50), static_cast<float>(k / 50),
                                static_cast<float>(seq));
    return cloud;
  }
  static std::filesystem::file_time_type age(const std::filesystem::path& file) {
    const auto long_ago = std::filesystem::last_write_time(file) - std::chrono::hours(1);
    std::filesystem::last_write_time(file, long_ago);
    return long_ago;
  }
  void write(std::size_t nodes) {
    PreviewWriter previews(file_);
    const store::SubmapLoader load = previews.loader(store_);
    for (std::size_t k = 0; k < nodes; ++k) EXPECT_EQ(load(nodes_[k].id).value().size(), 2000u);
    ASSERT_TRUE(previews.write());
  }

  testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "store.db.previews";
  store::Store store_ = store::Store::open(folder_ / "store.db", testing::agent("r1")).value();
  std::vector<graph::Node> nodes_;
};

TEST_F(PreviewWriterTest, WritesTheFirstPointsOfAllThatWasDecoded) {
  write(2);
  const Previews read = read_previews(file_);
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const QuantisedCloud& kept = *read.at(to_hex(nodes_[k].submap_hash));
    const auto decoded = cloud::decode(store_.submap(nodes_[k].id).value()).value();
    EXPECT_EQ(kept.values, quantised_prefix(decoded, Content::kCoarsePoints).values)
        << "as a page makes them";
    EXPECT_EQ(kept.whole, 2000u);
  }
}

TEST_F(PreviewWriterTest, AFileThatHoldsAllIsLeftAsItIs) {
  write(2);
  const auto before = age(file_);
  write(2);
  write(1);
  EXPECT_EQ(std::filesystem::last_write_time(file_), before);
  EXPECT_EQ(read_previews(file_).size(), 2u);
  write(3);
  EXPECT_EQ(read_previews(file_).size(), 3u);
}

TEST_F(PreviewWriterTest, ADamagedFileIsMadeAgain) {
  write(3);
  std::filesystem::resize_file(file_, 5000);
  write(3);
  EXPECT_EQ(read_previews(file_).size(), 3u);
}

TEST_F(PreviewWriterTest, SubmapsOfOtherFilesAreKnownAndThoseThatAreNotKeptLeftOut) {
  write(2);
  const std::filesystem::path merged = folder_ / "merged.db.previews";
  PreviewWriter previews(merged, std::array{file_, folder_ / "none.previews"});
  EXPECT_TRUE(previews.keep(nodes_[1].submap_hash));
  EXPECT_TRUE(previews.keep(nodes_[1].submap_hash)) << "a second node may have the same submap";
  EXPECT_FALSE(previews.keep(nodes_[2].submap_hash));
  ASSERT_TRUE(previews.write());
  const Previews read = read_previews(merged);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read.begin()->first, to_hex(nodes_[1].submap_hash));
}

TEST_F(PreviewWriterTest, WithoutASubmapThereIsNoFile) {
  PreviewWriter previews(file_);
  EXPECT_FALSE(previews.loader(store_)({testing::agent("r9"), 7})) << "the loader's error is the store's";
  ASSERT_TRUE(previews.write());
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(PreviewWriterTest, WhereNoneCanBeWrittenTheReasonIsTold) {
  PreviewWriter previews(folder_ / "none" / "store.db.previews");
  previews.add(nodes_[0].submap_hash, cloud_of(0));
  const Status written = previews.write();
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("store.db.previews"), std::string::npos) << written.error().message;
}

}  // namespace
}  // namespace fleetmap::monitor
