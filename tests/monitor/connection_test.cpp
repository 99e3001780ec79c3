#include "monitor/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/wired_server.hpp"

namespace fleetmap::monitor {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::WiredServer;

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(Connection, answers_requests_that_came_together_one_after_the_other) {
  WiredServer server;
  const std::string host = " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  server.send("GET /nothing" + host + "GET /state.json" + host + "GET /" + host);
  ASSERT_TRUE(server.run_until([&] { return server.got().ends_with("page"); }));
  EXPECT_EQ(count_of(server.got(), "HTTP/1.1 "), 3u);
  EXPECT_THAT(server.got(), StartsWith("HTTP/1.1 404"));
  EXPECT_LT(server.got().find("nothing is here"), server.got().find("{}"));
  EXPECT_FALSE(server.closed());
  EXPECT_EQ(server.state().requests, 3u);
  EXPECT_EQ(server.state().connections, 1u);
  server.hang_up();
  ASSERT_TRUE(server.run_until([&] { return server.closed() && server.state().connections == 0; }));
  EXPECT_EQ(server.state().cut, 0u);
}

TEST(Connection, closes_after_the_answer_where_that_is_asked_for) {
  WiredServer server;
  server.get("/", "Connection: close\r\n");
  ASSERT_TRUE(server.run_until([&] { return server.closed(); }));
  EXPECT_THAT(server.got(), EndsWith("page"));
  WiredServer old;
  old.send("GET / HTTP/1.0\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(old.run_until([&] { return old.closed(); }));
  EXPECT_THAT(old.got(), EndsWith("page"));
}

TEST(Connection, a_head_is_the_answer_without_its_body) {
  WiredServer server;
  server.get("/", "", "HEAD");
  ASSERT_TRUE(server.run_until([&] { return server.closed(); }));
  EXPECT_THAT(server.got(), HasSubstr("Content-Length: 4\r\n"));
  EXPECT_THAT(server.got(), EndsWith("\r\n\r\n"));
}

TEST(Connection, what_is_no_request_is_refused_and_ends_it) {
  for (const char* bytes : {"GET / HTTP/9\r\n\r\n", "\x16\x03\x01\r\n\r\n",
                            "POST /operator/hold HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n"}) {
    WiredServer server;
    server.send(bytes);
    ASSERT_TRUE(server.run_until([&] { return server.closed(); })) << bytes;
    EXPECT_THAT(server.got(), StartsWith("HTTP/1.1 400")) << bytes;
    EXPECT_EQ(server.state().refused, 1u);
    EXPECT_EQ(server.state().requests, 0u);
  }
}

TEST(Connection, a_header_that_never_ends_is_cut) {
  WiredServer server;
  server.get("/", "X: " + std::string(9000, 'x') + "\r\n");
  ASSERT_TRUE(server.run_until([&] { return server.closed(); }));
  EXPECT_THAT(server.got(), StartsWith("HTTP/1.1 431"));
  EXPECT_EQ(server.state().cut, 1u);
  WiredServer good;
  good.get("/", "X: " + std::string(7000, 'x') + "\r\n");
  ASSERT_TRUE(good.run_until([&] { return good.got().ends_with("page"); }));
}

TEST(Connection, who_sends_nothing_is_let_go_and_not_counted_as_cut) {
  ServerConfig config;
  config.request_timeout = std::chrono::milliseconds(1);
  WiredServer server(config);
  ASSERT_TRUE(server.run_until([&] { return server.closed() && server.state().connections == 0; }));
  EXPECT_TRUE(server.got().empty());
  EXPECT_EQ(server.state().cut + server.state().refused + server.state().requests, 0u);
}

}  // namespace
}  // namespace fleetmap::monitor
