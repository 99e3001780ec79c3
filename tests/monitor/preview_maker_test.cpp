#include "preview_maker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <chrono>

#include "monitor/views.hpp"

namespace fleetmap::monitor {
namespace {

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
    const auto working = boost::asio::make_work_guard(io_);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(300);
    while (kept() < 30 && std::chrono::steady_clock::now() < end) io_.run_one_until(end);
  }
  std::size_t kept() {
    std::size_t all = 0;
    for (const graph::Node& node : fleet_.view.nodes)
      all += content_.has_preview(to_hex(node.submap_hash)) ? 1 : 0;
    return all;
  }

  ViewMaker fleet_;
  std::atomic<int> loads_ = 0, at_once_ = 0, most_at_once_ = 0;
  Content content_{{},
                   [this](const NodeId&) -> Result<cloud::PointCloud> {
                     ++loads_;
                     const int now = ++at_once_;
                     int most = most_at_once_;
                     while (now > most && !most_at_once_.compare_exchange_weak(most, now)) {
                     }
                     cloud::PointCloud cloud;
                     for (int k = 0; k < 2000; ++k)
                       cloud.points.emplace_back(static_cast<float>(k % 50), static_cast<float>(k / 50),
                                                 0.0f);
                     --at_once_;
                     return cloud;
                   },
                   1 << 20};
  boost::asio::io_context io_;
};

TEST_P(PreviewMakerTest, every_preview_is_made_once_on_so_many_threads_at_most) {
  PreviewMaker previews(io_, content_, 2, GetParam());
  previews.refresh();
  previews.refresh();  // a newer state while the first ones are made
  run();
  EXPECT_EQ(kept(), 30u);
  EXPECT_EQ(loads_, 30);
  EXPECT_LE(most_at_once_, 2);
}

TEST_P(PreviewMakerTest, ends_while_it_is_at_work) {
  PreviewMaker previews(io_, content_, 2, GetParam());
  previews.refresh();
}

TEST(PreviewMaker, without_threads_nothing_is_decoded_before_it_is_asked_for) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 3);
  Content content(
      {}, [](const NodeId&) -> Result<cloud::PointCloud> { return failure("nobody asked"); }, 1000);
  content.show(fleet.view);
  boost::asio::io_context io;
  PreviewMaker previews(io, content, 0, false);
  previews.refresh();
  EXPECT_TRUE(content.misses_previews());
}

INSTANTIATE_TEST_SUITE_P(Priorities, PreviewMakerTest, ::testing::Bool());

}  // namespace
}  // namespace fleetmap::monitor
