#include "preview_maker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "monitor/fake_loop.hpp"
#include "monitor/views.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::monitor {
namespace {

using testing::FakeLoop;
using testing::ViewMaker;

class PreviewMakerTest : public ::testing::TestWithParam<bool> {
 protected:
  PreviewMakerTest() {
    fleet_.robot("r1", 0, 30);
    for (std::size_t k = 0; k < 30; ++k)
      fleet_.view.nodes[k].submap_hash[0] = static_cast<std::uint8_t>(k + 1);
    content_.show(fleet_.view);
  }
  /// Does what is posted until all previews are there.
  void run() {
    while (kept() < fleet_.view.nodes.size() && loop_.wait_and_run_one(std::chrono::seconds(300))) {
    }
  }
  std::size_t kept() {
    std::size_t all = 0;
    for (const graph::Node& node : fleet_.view.nodes)
      all += content_.has_preview(to_hex(node.submap_hash)) ? 1 : 0;
    return all;
  }

  Content content() {
    return {{},
            [this](const NodeId&, const ContentHash&) -> Result<cloud::PointCloud> {
              ++loads_;
              gate_.wait(false);
              const int now = ++at_once_;
              int most = most_at_once_;
              while (now > most && !most_at_once_.compare_exchange_weak(most, now)) {
              }
              cloud::PointCloud cloud;
              for (int k = 0; k < 2000; ++k)
                cloud.points.emplace_back(static_cast<float>(k % 50), static_cast<float>(k / 50), 0.0f);
              --at_once_;
              return cloud;
            },
            1 << 20};
  }
  /// Starts anew, shows the fleet with the previews of `file`, and returns how many submaps are decoded.
  int decoded_with(const std::filesystem::path& file, std::vector<std::filesystem::path> others = {}) {
    content_ = content();
    loads_ = 0;
    PreviewMaker previews(loop_, content_, 2, GetParam(), file, std::move(others));
    content_.show(fleet_.view);
    previews.refresh();
    run();
    EXPECT_EQ(kept(), fleet_.view.nodes.size());
    return loads_;
  }

  ViewMaker fleet_;
  testing::TemporaryFolder folder_;
  std::atomic<bool> gate_ = true;  ///< decoding waits while it is closed
  std::atomic<int> loads_ = 0, at_once_ = 0, most_at_once_ = 0;
  Content content_ = content();
  FakeLoop loop_;
};

TEST_P(PreviewMakerTest, every_preview_is_made_once_on_so_many_threads_at_most) {
  PreviewMaker previews(loop_, content_, 2, GetParam(), {});
  previews.refresh();
  previews.refresh();  // a newer state while the first ones are made
  run();
  EXPECT_EQ(kept(), 30u);
  EXPECT_EQ(loads_, 30);
  EXPECT_LE(most_at_once_, 2);
}

TEST_P(PreviewMakerTest, its_end_waits_for_those_at_work_alone) {
  gate_ = false;
  {
    PreviewMaker previews(loop_, content_, 2, GetParam(), {});
    previews.refresh();
    while (loads_ < 2) std::this_thread::yield();
    previews.stop();
    gate_ = true;
    gate_.notify_all();
  }
  EXPECT_EQ(loads_, 2) << "of 16 that were handed out";
}

TEST_P(PreviewMakerTest, what_its_file_holds_is_not_decoded_again) {
  const std::filesystem::path file = folder_ / "store.db.previews";
  EXPECT_EQ(decoded_with(file), 30);
  EXPECT_EQ(decoded_with(file), 0);
  std::filesystem::resize_file(file, 5000);
  EXPECT_EQ(decoded_with(file), 30) << "it was damaged";
  EXPECT_EQ(decoded_with(file), 0) << "and was written again";
  EXPECT_EQ(decoded_with(folder_ / "none" / "store.db.previews"), 30)
      << "one that cannot be written is no end";
}

TEST_P(PreviewMakerTest, what_other_files_hold_is_not_decoded_either) {
  const std::filesystem::path of_run = folder_ / "monitor.previews", own = folder_ / "store.db.previews";
  decoded_with(of_run);
  EXPECT_EQ(decoded_with(own, {folder_ / "none.previews", of_run}), 0);
  EXPECT_FALSE(std::filesystem::exists(own)) << "nothing was made";
  std::filesystem::resize_file(of_run, 5000);
  EXPECT_EQ(decoded_with(own, {of_run}), 30) << "it was damaged";
  EXPECT_TRUE(std::filesystem::exists(own));
}

TEST_P(PreviewMakerTest, its_file_is_written_again_when_an_eighth_of_it_is_new) {
  const std::filesystem::path file = folder_ / "store.db.previews";
  decoded_with(file);
  const auto bytes = std::filesystem::file_size(file);
  fleet_.robot("r2", 0, 4);
  for (std::size_t k = 30; k < 34; ++k)
    fleet_.view.nodes[k].submap_hash[0] = static_cast<std::uint8_t>(k + 1);
  EXPECT_EQ(decoded_with(file), 4);
  EXPECT_EQ(std::filesystem::file_size(file), bytes);
  fleet_.robot("r3", 0, 1);
  fleet_.view.nodes[34].submap_hash[0] = 35;
  EXPECT_EQ(decoded_with(file), 5);
  EXPECT_GT(std::filesystem::file_size(file), bytes);
  EXPECT_EQ(decoded_with(file), 0);
}

TEST_P(PreviewMakerTest, ends_while_it_is_at_work) {
  PreviewMaker previews(loop_, content_, 2, GetParam(), {});
  previews.refresh();
}

TEST(PreviewMaker, without_threads_nothing_is_decoded_before_it_is_asked_for) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 3);
  Content content(
      {},
      [](const NodeId&, const ContentHash&) -> Result<cloud::PointCloud> { return failure("nobody asked"); },
      1000);
  content.show(fleet.view);
  FakeLoop loop;
  PreviewMaker previews(loop, content, 0, false, {});
  previews.refresh();
  EXPECT_TRUE(content.misses_previews());
}

INSTANTIATE_TEST_SUITE_P(Priorities, PreviewMakerTest, ::testing::Bool());

}  // namespace
}  // namespace fleetmap::monitor
