#include "monitor/viewer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/wired_server.hpp"

namespace fleetmap::monitor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using testing::WiredServer;

std::shared_ptr<const std::string> text(const std::string& content) {
  return std::make_shared<const std::string>(content);
}

class ViewerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    server_.get("/live",
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n");
    ASSERT_TRUE(server_.run_until([&] { return !messages().empty(); }));
    server_.wait_until_idle();
    ASSERT_EQ(server_.state().viewers.size(), 1u);
  }
  Viewer& viewer() { return **server_.state().viewers.begin(); }

  /// Short text frames behind the handshake (RFC 6455, 5.2).
  std::vector<std::string> messages() const {
    std::vector<std::string> all;
    std::size_t at = server_.got().find("\r\n\r\n");
    if (at == std::string::npos) return all;
    for (at += 4; at + 2 <= server_.got().size();) {
      const auto length = static_cast<unsigned char>(server_.got()[at + 1]);
      EXPECT_EQ(static_cast<unsigned char>(server_.got()[at]), 0x81) << "a whole text";
      EXPECT_LT(length, 126);
      all.push_back(server_.got().substr(at + 2, length));
      at += 2u + length;
    }
    return all;
  }
  /// One masked text frame, as browsers send.
  void say(std::size_t size) {
    std::string frame = "\x81\xfe";
    frame.push_back(static_cast<char>(size >> 8));
    frame.push_back(static_cast<char>(size));
    server_.send(frame + std::string(4, '\0') + std::string(size, 'x'));
  }
  bool ended() {
    return server_.run_until([&] { return server_.closed() && server_.state().connections == 0; });
  }

  WiredServer server_;
};

TEST_F(ViewerTest, gets_the_present_state_when_it_opens) {
  EXPECT_THAT(server_.got(), StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(messages(), ElementsAre("{}")) << "and no live status, as there is none yet";
  EXPECT_EQ(server_.state().viewers_now, 1u);
}

TEST_F(ViewerTest, that_is_slow_misses_states_and_gets_the_newest_of_each_kind) {
  viewer().send(Viewer::kState, text("under way"));
  viewer().send(Viewer::kState, text("missed"));
  viewer().send(Viewer::kLive, text("live"));
  viewer().send(Viewer::kState, text("newest"));
  ASSERT_TRUE(server_.run_until([&] { return messages().size() >= 4; }));
  server_.wait_until_idle();
  EXPECT_THAT(messages(), ElementsAre("{}", "under way", "live", "newest"));
}

TEST_F(ViewerTest, an_empty_text_is_not_sent) {
  viewer().send(Viewer::kLive, text(""));
  viewer().send(Viewer::kState, text("a"));
  ASSERT_TRUE(server_.run_until([&] { return messages().size() >= 2; }));
  EXPECT_THAT(messages(), ElementsAre("{}", "a"));
}

TEST_F(ViewerTest, that_tells_a_little_stays_and_that_tells_more_is_cut) {
  say(600);
  server_.wait_until_idle();
  viewer().send(Viewer::kState, text("still there"));
  ASSERT_TRUE(server_.run_until([&] { return messages().size() >= 2; }));
  EXPECT_EQ(server_.state().cut, 0u);
  say(600);
  ASSERT_TRUE(ended());
  EXPECT_EQ(server_.state().cut, 1u);
  EXPECT_THAT(server_.state().viewers, IsEmpty());
  EXPECT_EQ(server_.state().viewers_now, 0u);
}

TEST_F(ViewerTest, that_goes_without_a_word_is_forgotten) {
  server_.hang_up();
  ASSERT_TRUE(ended());
  EXPECT_THAT(server_.state().viewers, IsEmpty());
  EXPECT_EQ(server_.state().viewers_now, 0u);
}

}  // namespace
}  // namespace fleetmap::monitor
