#include "monitor/viewer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

namespace fleetmap::monitor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::shared_ptr<const std::string> text(const std::string& content) {
  return std::make_shared<const std::string>(content);
}

class FakeSocket : public WebSocket {
 public:
  void write(Kind kind, Parts parts) override {
    EXPECT_EQ(kind, Kind::text);
    EXPECT_FALSE(writing_) << "one message after the other";
    writing_ = true;
    messages.push_back(std::string(parts[0]) + std::string(parts[1]));
  }
  void cut() override { is_cut = true; }
  /// The other side took what is being written.
  void take(WebSocketSession& session) {
    writing_ = false;
    session.on_written();
  }

  std::vector<std::string> messages;
  bool is_cut = false;

 private:
  bool writing_ = false;
};

class ViewerTest : public ::testing::Test {
 protected:
  ViewerTest() { viewer_.emplace(state_); }
  void open() {
    viewer_->on_open(socket_);
    socket_.take(*viewer_);
  }

  ServerState state_{
      ServerConfig{}, [](const NodeId&, const ContentHash&) { return Result<cloud::PointCloud>(); }, {}};
  FakeSocket socket_;
  std::optional<Viewer> viewer_;
};

TEST_F(ViewerTest, gets_the_present_state_when_it_opens) {
  viewer_->send(Viewer::kState, text("before it is open"));
  EXPECT_THAT(socket_.messages, IsEmpty());
  open();
  EXPECT_THAT(socket_.messages, ElementsAre("{}")) << "and no live status, as there is none yet";
  state_.content.show(LiveStatus{}, false);
  FakeSocket other;
  Viewer second(state_);
  second.on_open(other);
  other.take(second);
  ASSERT_EQ(other.messages.size(), 2u);
  EXPECT_EQ(other.messages[1], *state_.content.live());
}

TEST_F(ViewerTest, is_counted_as_long_as_it_exists) {
  EXPECT_THAT(state_.viewers, ElementsAre(&*viewer_));
  EXPECT_EQ(state_.counters.viewers, 1u);
  viewer_.reset();
  EXPECT_THAT(state_.viewers, IsEmpty());
  EXPECT_EQ(state_.counters.viewers, 0u);
}

TEST_F(ViewerTest, that_is_slow_misses_states_and_gets_the_newest_of_each_kind) {
  open();
  viewer_->send(Viewer::kState, text("under way"));
  viewer_->send(Viewer::kState, text("missed"));
  viewer_->send(Viewer::kLive, text("live"));
  viewer_->send(Viewer::kState, text("newest"));
  for (int k = 0; k < 3; ++k) socket_.take(*viewer_);
  EXPECT_THAT(socket_.messages, ElementsAre("{}", "under way", "live", "newest"));
}

TEST_F(ViewerTest, an_empty_text_is_not_sent) {
  open();
  viewer_->send(Viewer::kLive, text(""));
  viewer_->send(Viewer::kState, text("a"));
  EXPECT_THAT(socket_.messages, ElementsAre("{}", "a"));
}

TEST_F(ViewerTest, that_tells_a_little_stays_and_that_tells_more_is_cut) {
  open();
  viewer_->on_message(WebSocket::Kind::text, std::string(600, 'x'));
  EXPECT_FALSE(socket_.is_cut);
  viewer_->on_message(WebSocket::Kind::binary, std::string(600, 'x'));
  EXPECT_TRUE(socket_.is_cut);
  EXPECT_EQ(state_.counters.cut, 1u);
  viewer_->send(Viewer::kState, text("too late"));
  EXPECT_THAT(socket_.messages, ElementsAre("{}"));
  EXPECT_LE(viewer_->limits().message_bytes, 1024u) << "or one long message would fill the memory";
}

TEST_F(ViewerTest, that_has_gone_gets_nothing) {
  open();
  viewer_->on_closed();
  viewer_->send(Viewer::kState, text("too late"));
  EXPECT_THAT(socket_.messages, ElementsAre("{}"));
  EXPECT_EQ(state_.counters.cut, 0u);
}

}  // namespace
}  // namespace fleetmap::monitor
