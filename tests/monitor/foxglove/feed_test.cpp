#include "monitor/foxglove/feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/fake_loop.hpp"
#include "monitor/foxglove/read_cloud.hpp"
#include "monitor/views.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using ::testing::ElementsAre;
using testing::FakeLoop;
using ::testing::HasSubstr;
using testing::node_id;
using testing::read_cloud;
using testing::ViewMaker;

class FakeClient : public Client {
 public:
  void wake() override { ++wakes; }
  bool wants_map() const override { return wants; }
  void warn(const std::string& text) override { warnings.push_back(text); }

  int wakes = 0;
  bool wants = true;
  std::vector<std::string> warnings;
};

class FeedTest : public ::testing::Test {
 protected:
  FeedTest() { clients_.insert(&client_); }
  Feed feed(std::chrono::milliseconds period = std::chrono::hours(1)) {
    return Feed(loop_, content_, clients_, {100, period});
  }
  std::shared_ptr<const FleetView> view(int nodes) {
    ViewMaker fleet;
    fleet.robot("r1", 0.0, nodes);
    // Submaps of the page's cache go by their content.
    for (int k = 0; k < nodes; ++k)
      fleet.view.nodes[static_cast<std::size_t>(k)].submap_hash.fill(static_cast<std::uint8_t>(k));
    return std::make_shared<const FleetView>(fleet.view);
  }
  static std::size_t points(Feed& feed) {
    const auto message = feed.message(FleetChannels::kMapChannel);
    return message ? read_cloud(*message).size() : 0;
  }

  std::vector<NodeId> loaded_;
  bool readable_ = true;
  FakeLoop loop_;
  Content content_{{},
                   [this](const NodeId& id, const ContentHash&) -> Result<cloud::PointCloud> {
                     loaded_.push_back(id);
                     if (!readable_) return failure("disk error");
                     cloud::PointCloud cloud;
                     for (int k = 0; k < 10; ++k)
                       cloud.points.emplace_back(static_cast<float>(k), 0.0f, 0.0f);
                     return cloud;
                   },
                   1 << 20};
  std::set<Client*> clients_;
  FakeClient client_;
};

TEST_F(FeedTest, the_map_is_built_between_other_work) {
  Feed feed = this->feed();
  feed.show(view(3));
  EXPECT_TRUE(loaded_.empty()) << "the caller does not wait for it";
  loop_.run_one();
  EXPECT_EQ(loaded_.size(), 1u);
  bool served = false;
  loop_.post([&] { served = true; });
  while (!served) loop_.run_one();
  EXPECT_LT(loaded_.size(), 3u) << "others are served between two submaps";
  EXPECT_EQ(points(feed), 0u);
  loop_.run();
  EXPECT_EQ(points(feed), 30u);
  EXPECT_EQ(client_.wakes, 2) << "for the view and for the map";
}

TEST_F(FeedTest, nobody_builds_a_map_that_no_client_wants) {
  Feed feed = this->feed();
  client_.wants = false;
  feed.show(view(3));
  loop_.run();
  EXPECT_TRUE(loaded_.empty());
  client_.wants = true;
  feed.build_map();
  loop_.run_one();
  client_.wants = false;
  loop_.run();
  EXPECT_EQ(loaded_.size(), 1u) << "it stops when the last client leaves";
  client_.wants = true;
  feed.build_map();
  loop_.run();
  EXPECT_EQ(points(feed), 30u);
}

TEST_F(FeedTest, a_map_of_a_newer_view_waits_for_the_period) {
  Feed feed = this->feed();
  feed.show(view(1));
  loop_.run();
  feed.show(view(2));
  loop_.run();
  EXPECT_EQ(loaded_.size(), 1u);
  EXPECT_EQ(points(feed), 10u) << "the map before, for an hour";
}

TEST_F(FeedTest, a_newer_view_is_built_after_the_period_and_loads_what_is_new) {
  Feed feed = this->feed(std::chrono::minutes(2));
  feed.show(view(1));
  loop_.run();
  feed.show(view(2));
  const auto wait = loop_.skip_wait();
  EXPECT_GT(wait, std::chrono::minutes(1));
  EXPECT_LE(wait, std::chrono::minutes(2));
  loop_.run();
  EXPECT_EQ(points(feed), 20u);
  EXPECT_THAT(loaded_, ElementsAre(node_id("r1", 0), node_id("r1", 1)));
}

TEST_F(FeedTest, clients_of_the_map_are_told_of_submaps_that_are_missing) {
  readable_ = false;
  Feed feed = this->feed();
  FakeClient other;
  other.wants = false;
  clients_.insert(&other);
  feed.show(view(2));
  loop_.run();
  EXPECT_THAT(client_.warnings, ElementsAre(HasSubstr("2 submaps cannot be read")));
  EXPECT_TRUE(other.warnings.empty());
  EXPECT_EQ(points(feed), 0u);
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
