#include "monitor/web_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <list>
#include <stdexcept>
#include <thread>

#include "monitor/browser.hpp"
#include "support/eventually.hpp"

namespace fleetmap::monitor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Browser;
using ::testing::EndsWith;
using testing::eventually;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Sends back what comes, and ends when it is told "cut" or "throw".
class Echo : public WebSocketSession {
 public:
  Limits limits() const override { return {.message_bytes = 100, .frame_bytes = 1024}; }
  void on_open(WebSocket& socket) override { socket_ = &socket; }
  void on_message(WebSocket::Kind kind, std::string_view message) override {
    if (message == "cut") return socket_->cut();
    if (message == "throw") throw std::runtime_error("a defect");
    text_ = message;
    socket_->write(kind, {text_, "!"});
  }
  void on_written() override {}
  void on_closed() override {}

 private:
  WebSocket* socket_ = nullptr;
  std::string text_;
};

HttpResponse answer(const HttpRequest& request) {
  if (request.target == "/throw") throw std::runtime_error("a defect");
  HttpResponse response;
  if (request.upgrade) {
    response.status = 101;
    if (!request.subprotocols.empty()) response.headers.emplace_back("Sec-WebSocket-Protocol", "b");
    response.session = std::make_unique<Echo>();
    return response;
  }
  response.status = request.target == "/" ? 200 : 404;
  response.headers.emplace_back("X-Told",
                                request.origin + '|' + request.cookie + '|' + request.authorization);
  response.body = request.target == "/" ? "page" : "nothing is here";
  return response;
}

class WebServerTest : public ::testing::Test {
 protected:
  void start(const ServerConfig& config = {}) {
    config_ = config;
    server_ = std::make_unique<WebServer>(config_, counters_);
    ASSERT_TRUE(server_->listen(answer));
    thread_ = std::thread([this] { server_->run(); });
  }
  void TearDown() override {
    if (!thread_.joinable()) return;
    server_->stop();
    thread_.join();
    server_.reset();
    EXPECT_EQ(counters_.connections, 0u);
  }
  bool all_gone() {
    return eventually([&] { return counters_.connections == 0; }, seconds(20));
  }

  ServerConfig config_;
  ServerCounters counters_;
  std::unique_ptr<WebServer> server_;
  std::thread thread_;
};

TEST_F(WebServerTest, answers_requests_that_came_together_one_after_the_other) {
  start();
  {
    Browser browser(server_->port());
    const std::string host = " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    browser.send("GET /nothing" + host + "GET /" + host);
    EXPECT_THAT(browser.answer(), AllOf(StartsWith("HTTP/1.1 404"), EndsWith("nothing is here")));
    EXPECT_THAT(browser.answer(), AllOf(StartsWith("HTTP/1.1 200"), EndsWith("page")));
    EXPECT_EQ(counters_.requests, 2u);
    EXPECT_EQ(counters_.connections, 1u);
  }
  EXPECT_TRUE(all_gone());
  EXPECT_EQ(counters_.cut, 0u);
}

TEST_F(WebServerTest, closes_after_the_answer_if_the_client_asks_for_it) {
  start();
  Browser browser(server_->port());
  browser.get("/", "Connection: close\r\n");
  EXPECT_THAT(browser.answer(), EndsWith("page"));
  EXPECT_TRUE(browser.closed());
  Browser old(server_->port());
  old.send("GET / HTTP/1.0\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(old.answer(), EndsWith("page"));
  EXPECT_TRUE(old.closed());
}

TEST_F(WebServerTest, a_head_is_the_answer_without_its_body) {
  start();
  Browser browser(server_->port());
  browser.send("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string all = browser.rest();
  EXPECT_THAT(all, HasSubstr("Content-Length: 4\r\n"));
  EXPECT_THAT(all, EndsWith("\r\n\r\n"));
}

TEST_F(WebServerTest, malformed_requests_are_refused_and_end_the_connection) {
  start();
  std::uint64_t refused = 0;
  for (const char* bytes : {"GET / HTTP/9\r\n\r\n", "\x16\x03\x01\r\n\r\n",
                            "POST /operator/hold HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n"}) {
    Browser browser(server_->port());
    browser.send(bytes);
    EXPECT_THAT(browser.answer(), StartsWith("HTTP/1.1 400")) << bytes;
    EXPECT_TRUE(browser.closed());
    EXPECT_EQ(counters_.refused, ++refused);
  }
  EXPECT_EQ(counters_.requests, 0u);
}

TEST_F(WebServerTest, a_request_for_two_hosts_is_refused) {
  start();
  Browser browser(server_->port());
  browser.get("/", "Host: elsewhere.example\r\n");
  EXPECT_THAT(browser.answer(), StartsWith("HTTP/1.1 400"));
  EXPECT_TRUE(browser.closed());
  EXPECT_EQ(counters_.refused, 1u);
}

TEST_F(WebServerTest, who_opens_many_and_says_nothing_keeps_nobody_out) {
  ServerConfig config;
  config.max_connections = 3;
  start(config);
  std::list<Browser> idle;
  for (int k = 0; k < 9; ++k) idle.emplace_back(server_->port());
  Browser viewer(server_->port());
  viewer.get("/");
  EXPECT_EQ(viewer.status(), "200");
  EXPECT_TRUE(idle.front().closed());
}

TEST_F(WebServerTest, where_all_are_at_work_a_further_one_is_closed) {
  ServerConfig config;
  config.max_connections = 1;
  start(config);
  Browser viewer(server_->port());
  viewer.upgrade();
  ASSERT_EQ(viewer.status(), "101");
  EXPECT_TRUE(Browser(server_->port()).closed());
  EXPECT_EQ(counters_.cut, 1u);
}

TEST_F(WebServerTest, a_header_that_never_ends_is_cut) {
  start();
  Browser browser(server_->port());
  browser.get("/", "X: " + std::string(9000, 'x') + "\r\n");
  EXPECT_THAT(browser.answer(), StartsWith("HTTP/1.1 431"));
  EXPECT_EQ(counters_.cut, 1u);
  Browser good(server_->port());
  good.get("/", "X: " + std::string(7000, 'x') + "\r\n");
  EXPECT_THAT(good.answer(), EndsWith("page"));
}

TEST_F(WebServerTest, who_sends_nothing_is_let_go_and_not_counted_as_cut) {
  ServerConfig config;
  config.request_timeout = milliseconds(1);
  start(config);
  Browser browser(server_->port());
  EXPECT_TRUE(browser.closed());
  EXPECT_TRUE(all_gone());
  EXPECT_EQ(counters_.cut + counters_.refused + counters_.requests, 0u);
}

TEST_F(WebServerTest, an_exception_ends_one_connection_alone) {
  start();
  Browser other(server_->port()), unlucky(server_->port());
  other.get("/");
  EXPECT_EQ(other.status(), "200");
  unlucky.get("/throw");
  EXPECT_TRUE(unlucky.closed());
  EXPECT_TRUE(eventually([&] { return counters_.cut == 1; }, seconds(20)));
  other.get("/");
  EXPECT_EQ(other.status(), "200");
}

TEST_F(WebServerTest, a_web_socket_carries_messages_both_ways_until_its_session_ends_it) {
  start();
  Browser browser(server_->port());
  browser.upgrade("/live", "Sec-WebSocket-Protocol: a, b\r\n");
  EXPECT_THAT(browser.answer(),
              AllOf(StartsWith("HTTP/1.1 101"), HasSubstr("Sec-WebSocket-Protocol: b\r\n")));
  browser.send_message("text", 1);
  Browser::Message back = browser.any_message();
  EXPECT_EQ(back.kind, 1);
  EXPECT_EQ(back.payload, "text!");
  browser.send_message("bytes", 2);
  back = browser.any_message();
  EXPECT_EQ(back.kind, 2);
  EXPECT_EQ(back.payload, "bytes!");
  browser.send_message("cut");
  EXPECT_TRUE(browser.closed());
  EXPECT_TRUE(all_gone());
  EXPECT_EQ(counters_.cut, 0u) << "a session counts what it cuts";
}

TEST_F(WebServerTest, a_web_socket_without_subprotocol_names_none) {
  start();
  Browser browser(server_->port());
  browser.upgrade();
  EXPECT_THAT(browser.answer(),
              AllOf(StartsWith("HTTP/1.1 101"), ::testing::Not(HasSubstr("Sec-WebSocket-Protocol"))));
}

TEST_F(WebServerTest, too_long_a_message_is_cut_and_counted) {
  start();
  {
    Browser browser(server_->port());
    browser.upgrade();
    ASSERT_EQ(browser.status(), "101");
    browser.send_message(std::string(101, 'x'));
    EXPECT_TRUE(browser.closed());
  }
  EXPECT_TRUE(all_gone());
  EXPECT_EQ(counters_.cut, 1u);
}

TEST_F(WebServerTest, a_web_socket_that_answers_no_ping_is_cut_and_counted) {
  ServerConfig config;
  config.idle_timeout = milliseconds(200);
  start(config);
  Browser browser(server_->port());
  browser.upgrade();
  ASSERT_EQ(browser.status(), "101");
  EXPECT_TRUE(browser.closed());
  EXPECT_TRUE(all_gone());
  EXPECT_EQ(counters_.cut, 1u);
}

TEST_F(WebServerTest, tasks_run_on_its_thread_in_their_order_and_not_before_their_time) {
  start();
  std::promise<void> done;
  std::string order;
  std::thread::id thread;
  const auto begin = EventLoop::Clock::now();
  EventLoop::Clock::time_point ran;
  server_->post([&] {
    thread = std::this_thread::get_id();
    server_->post_at(begin + milliseconds(30), [&] {
      ran = EventLoop::Clock::now();
      order += 'c';
      done.set_value();
    });
    order += 'a';
  });
  server_->post([&] { order += 'b'; });
  ASSERT_EQ(done.get_future().wait_for(seconds(60)), std::future_status::ready);
  EXPECT_EQ(order, "abc");
  EXPECT_EQ(thread, thread_.get_id());
  EXPECT_GE(ran - begin, milliseconds(30));
}

TEST(ParseRequest, keeps_the_headers_that_decide_about_an_answer) {
  const auto request = parse_request(
      "POST /a?b=c HTTP/1.1\r\nHost: h\r\nOrigin: o\r\nCookie: k\r\nAuthorization: z\r\nUpgrade: "
      "websocket\r\n"
      "Connection: upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Protocol: a, b\r\nSec-WebSocket-Protocol: c\r\n\r\n");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->method, HttpRequest::Method::post);
  EXPECT_EQ(request->target, "/a?b=c");
  EXPECT_EQ(request->host + request->origin + request->cookie + request->authorization, "hokz");
  EXPECT_EQ(request->subprotocols, "a, b,c,");
  EXPECT_FALSE(request->upgrade) << "only a GET is upgraded";
  EXPECT_EQ(parse_request("PUT / HTTP/1.1\r\n\r\n")->method, HttpRequest::Method::other);
  EXPECT_EQ(parse_request("HEAD / HTTP/1.1\r\n\r\n")->method, HttpRequest::Method::head);
  for (const char* none : {"", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", "GET / HTTP/1.1\r\n",
                           "GET / HTTP/1.1\r\nContent-Length: 1\r\n\r\nx", "GET\r\n\r\n"})
    EXPECT_FALSE(parse_request(none)) << none;
}

}  // namespace
}  // namespace fleetmap::monitor
