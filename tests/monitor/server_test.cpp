#include "fleetmap/monitor/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "monitor/browser.hpp"
#include "monitor/page_files.hpp"
#include "monitor/views.hpp"
#include "point_levels.hpp"
#include "support/eventually.hpp"

namespace fleetmap::monitor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using testing::Browser;
using testing::eventually;
using ::testing::HasSubstr;
using testing::kPage;
using ::testing::Not;
using ::testing::StartsWith;
using testing::ViewMaker;

std::unique_ptr<Server> start(const ServerConfig& config = {}) {
  auto load = [](const NodeId&, const ContentHash&) {
    cloud::PointCloud cloud;
    cloud.points.assign(50, Eigen::Vector3f::Ones());
    return Result<cloud::PointCloud>(cloud);
  };
  return Server::start(config, load, kPage).value();
}

std::shared_ptr<const FleetView> view(const std::string& title = "made up") {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 5);
  fleet.view.title = title;
  return std::make_shared<const FleetView>(fleet.view);
}

TEST(Server, gives_page_state_and_points) {
  const auto server = start();
  server->publish(view());
  Browser browser(server->port());
  browser.get("/");
  EXPECT_THAT(browser.answer(),
              AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("text/html"), HasSubstr("gzip"),
                    HasSubstr("default-src 'self'"), HasSubstr("nosniff"), HasSubstr("DENY")));
  browser.get("/state.json");  // over the same connection
  EXPECT_THAT(browser.answer(), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("\"title\":\"made up\"")));
  browser.get("/submap/" + to_hex(view()->nodes[0].submap_hash) + "?from=0&count=9");
  EXPECT_THAT(browser.answer(), AllOf(HasSubstr("immutable"), HasSubstr("FMP1")));
  browser.get("/", "", "HEAD");
  EXPECT_THAT(browser.answer(), StartsWith("HTTP/1.1 200"));
}

TEST(Server, no_path_leads_to_a_file) {
  const auto server = start();
  server->publish(view());
  for (const char* path : {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
                           "/etc/passwd", "/submap/../../etc/passwd", "/./index.html", "/index.html%00.js",
                           "/store.db", "http://127.0.0.1/x"}) {
    Browser browser(server->port());
    browser.get(path);
    const std::string answer = browser.answer();
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 404") || answer.starts_with("HTTP/1.1 400"))
        << path << ": " << answer;
    EXPECT_THAT(answer, Not(HasSubstr("root:")));
  }
  EXPECT_EQ(server->stats().refused, 9u);
}

TEST(Server, other_sites_and_foreign_names_are_refused) {
  const auto server = start();
  const auto asked = [&](const std::string& request) {
    Browser browser(server->port());
    browser.send(request);
    return browser.status();
  };
  EXPECT_EQ(asked("GET /state.json HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "403");
  EXPECT_EQ(asked("GET /state.json HTTP/1.1\r\n\r\n"), "403") << "no Host";
  EXPECT_EQ(asked("GET /state.json HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://evil.example\r\n\r\n"),
            "403");
  EXPECT_EQ(asked("GET /state.json HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n\r\n"), "200");
  EXPECT_EQ(asked("POST /state.json HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), "405");
  EXPECT_EQ(asked("DELETE / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), "405");
  Browser socket(server->port());
  socket.upgrade("/live", "Origin: http://evil.example\r\n");
  EXPECT_EQ(socket.status(), "403");
  EXPECT_EQ(server->stats().viewers, 0u);
}

TEST(Server, malformed_requests_are_answered_and_cut) {
  const auto server = start();
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02TLS hello\r\n\r\n"), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("GET / HTTP/1.1\r\nHost 127\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9999999\r\n\r\nx")}) {
    Browser browser(server->port());
    browser.send(bytes);
    EXPECT_THAT(browser.status(), ::testing::AnyOf("400", "413", "403")) << bytes;
    EXPECT_TRUE(browser.closed()) << bytes;
  }
  EXPECT_EQ(server->stats().refused, 5u);
}

TEST(Server, a_long_header_is_refused) {
  const auto server = start();
  Browser browser(server->port());
  browser.get("/", "X-Long: " + std::string(9000, 'x') + "\r\n");
  EXPECT_EQ(browser.status(), "431");
  EXPECT_TRUE(browser.closed());
  EXPECT_EQ(server->stats().cut, 1u);
}

TEST(Server, who_sends_too_slowly_is_cut) {
  ServerConfig config;
  config.request_timeout = milliseconds(200);
  const auto server = start(config);
  Browser browser(server->port());
  ASSERT_TRUE(browser.send("GET / HTTP/1.1\r\nHos"));
  EXPECT_TRUE(browser.closed());
  EXPECT_TRUE(eventually([&] { return server->stats().cut == 1; }, seconds(10)));
}

TEST(Server, viewers_get_the_state_at_once_and_every_newer_one) {
  const auto server = start();
  server->publish(view("first"));
  Browser browser(server->port());
  browser.upgrade("/live", "Origin: http://" + browser.host() + "\r\n");
  ASSERT_EQ(browser.status(), "101");
  EXPECT_EQ(nlohmann::json::parse(browser.message())["title"], "first");
  EXPECT_EQ(server->stats().viewers, 1u);
  server->publish(view("second"));
  EXPECT_EQ(nlohmann::json::parse(browser.message())["title"], "second");
}

std::shared_ptr<const LiveStatus> status(double lost_after_s = 60.0) {
  LiveStatus status;
  status.self = testing::node_id("r1", 0).agent;
  status.lost_after_s = lost_after_s;
  return std::make_shared<const LiveStatus>(status);
}

TEST(Server, viewers_get_the_live_status_also_before_any_state) {
  const auto server = start();
  Browser before(server->port());
  before.get("/live.json");
  EXPECT_THAT(before.answer(), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("{}"))) << "of no live robot";
  server->publish(status());
  Browser browser(server->port());
  browser.upgrade();
  ASSERT_EQ(browser.status(), "101");
  EXPECT_EQ(browser.message(), "{}");
  EXPECT_EQ(nlohmann::json::parse(browser.message())["live"]["lost_after_s"], 60.0);
  server->publish(status(90.0));
  EXPECT_EQ(nlohmann::json::parse(browser.message())["live"]["lost_after_s"], 90.0);
  server->publish(view("the state"));
  EXPECT_EQ(nlohmann::json::parse(browser.message())["title"], "the state");
  before.get("/live.json");
  EXPECT_THAT(before.answer(), AllOf(HasSubstr("\"lost_after_s\":90.0"), HasSubstr("\"operated\":false")));
}

/// A server with a token and what it was ordered.
class OperatedServer : public ::testing::Test {
 protected:
  std::string post(const std::string& path, const std::string& headers) {
    Browser browser(server_->port());
    browser.get(path, headers + "Content-Length: 0\r\n", "POST");
    return browser.status();
  }
  std::string cookie(const std::string& token) const {
    return "Cookie: fleetmap_" + std::to_string(server_->port()) + "=" + token + "\r\n";
  }
  std::string origin() const {
    return "Origin: http://127.0.0.1:" + std::to_string(server_->port()) + "\r\n";
  }
  static ServerConfig with_token() {
    ServerConfig config;
    config.token = kToken;
    return config;
  }
  void operate() {
    server_->set_operator([this](const OrderRequest& order) -> Status {
      if (order.robot && order.robot->str() != "r2") return failure("no such robot");
      ordered_.push_back((order.kind == OrderRequest::Kind::kHold ? "hold " : "resume ") +
                         (order.robot ? order.robot->str() : "all"));
      return {};
    });
  }

  static constexpr const char* kToken = "0123456789abcdef";
  std::vector<std::string> ordered_;  ///< on the server's thread; read after its answer
  std::unique_ptr<Server> server_ = start(with_token());
};

TEST_F(OperatedServer, passes_on_orders_of_a_page_with_the_token) {
  operate();
  EXPECT_EQ(post("/operator/hold", cookie(kToken) + origin()), "202");
  EXPECT_EQ(post("/operator/resume?robot=r2", cookie(kToken) + origin()), "202");
  EXPECT_EQ(post("/operator/hold", std::string("Authorization: Bearer ") + kToken + "\r\n"), "202");
  EXPECT_THAT(ordered_, ::testing::ElementsAre("hold all", "resume r2", "hold all"));
  EXPECT_EQ(post("/operator/hold?robot=r9", cookie(kToken) + origin()), "503");
  EXPECT_EQ(server_->stats().refused, 1u);
}

TEST_F(OperatedServer, refuses_wrong_tokens_and_other_sites) {
  operate();
  EXPECT_EQ(post("/operator/hold", origin()), "403") << "no token";
  EXPECT_EQ(post("/operator/hold", cookie("0123456789abcdee") + origin()), "403");
  EXPECT_EQ(post("/operator/hold?token=0123456789abcdef", origin()), "403");
  EXPECT_EQ(post("/operator/hold", cookie(kToken)), "403") << "a page that hides where it is from";
  EXPECT_EQ(post("/operator/hold", cookie(kToken) + "Origin: http://evil.example\r\n"), "403");
  EXPECT_EQ(post("/operator/hold?robot=../r2", cookie(kToken) + origin()), "405");
  Browser reader(server_->port());
  reader.get("/operator/hold", cookie(kToken));
  EXPECT_EQ(reader.status(), "404") << "a link gives no order";
  EXPECT_TRUE(ordered_.empty());
}

TEST_F(OperatedServer, without_a_token_or_a_robot_it_reads_only) {
  EXPECT_EQ(post("/operator/hold", cookie(kToken) + origin()), "403") << "a finished run";
  server_ = start();
  operate();
  EXPECT_EQ(post("/operator/hold", origin()), "403");
  server_->publish(status());
  Browser browser(server_->port());
  browser.get("/live.json");
  EXPECT_THAT(browser.answer(), HasSubstr("\"operated\":false")) << "the page shows no button";
  EXPECT_TRUE(ordered_.empty());
}

TEST(Server, only_so_many_viewers_at_once) {
  ServerConfig config;
  config.max_viewers = 2;
  const auto server = start(config);
  server->publish(view());
  Browser third(server->port());
  {
    Browser first(server->port()), second(server->port());
    for (Browser* browser : {&first, &second}) {
      browser->upgrade();
      ASSERT_EQ(browser->status(), "101");
      browser->message();
    }
    third.upgrade();
    EXPECT_EQ(third.status(), "503");
  }
  // Those who left make room.
  ASSERT_TRUE(eventually([&] { return server->stats().viewers == 0; }, seconds(10)));
  third.upgrade();
  EXPECT_EQ(third.status(), "101");
}

TEST(Server, only_so_many_connections_at_once) {
  ServerConfig config;
  config.max_connections = 3;
  const auto server = start(config);
  Browser a(server->port()), b(server->port()), c(server->port());
  for (Browser* browser : {&a, &b, &c}) {
    browser->get("/");
    ASSERT_EQ(browser->status(), "200");
  }
  // The one that has waited for longest gives way.
  Browser more(server->port());
  more.get("/");
  EXPECT_EQ(more.status(), "200");
  EXPECT_TRUE(a.closed());
  EXPECT_EQ(server->stats().cut, 1u);
  b.get("/");
  EXPECT_EQ(b.status(), "200");
}

TEST(Server, a_viewer_that_reads_nothing_is_dropped_and_holds_nobody_up) {
  ServerConfig config;
  config.idle_timeout = milliseconds(400);
  const auto server = start(config);
  ViewMaker fleet;
  fleet.robot("r1", 0, 20'000);  // some megabytes: more than sockets take
  server->publish(std::make_shared<const FleetView>(fleet.view));
  Browser deaf(server->port());
  deaf.upgrade();
  ASSERT_TRUE(eventually([&] { return server->stats().viewers == 1; }, seconds(20)));
  server->publish(view("meanwhile"));
  Browser other(server->port());
  other.get("/state.json");
  EXPECT_THAT(other.answer(), HasSubstr("meanwhile"));
  EXPECT_TRUE(eventually([&] { return server->stats().viewers == 0; }, seconds(20)));
  EXPECT_EQ(server->stats().cut, 1u);
}

TEST(Server, a_viewer_that_tells_more_than_a_little_is_cut) {
  const auto server = start();
  Browser browser(server->port());
  browser.upgrade();
  ASSERT_EQ(browser.status(), "101");
  ASSERT_TRUE(eventually([&] { return server->stats().viewers == 1; }, seconds(10)));
  const std::string head("\x82\xff\x00\x00\x00\x00\x7f\xff\xff\xff\x00\x00\x00\x00", 14);  // announces 2 GB
  browser.send(head + std::string(2000, 'x'));
  EXPECT_TRUE(eventually([&] { return server->stats().viewers == 0; }, seconds(10)));
  EXPECT_EQ(server->stats().cut, 1u);
}

TEST(Server, a_token_is_exchanged_for_a_cookie_once) {
  ServerConfig config;
  config.token = "0123456789abcdef";
  const auto server = start(config);
  const auto asked = [&](const std::string& path, const std::string& headers = "") {
    Browser browser(server->port());
    browser.get(path, headers);
    return browser.answer();
  };
  EXPECT_THAT(asked("/"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(asked("/?token=0123456789abcdee"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(server->url(), HasSubstr("/?token=0123456789abcdef"));
  const std::string cookie = "fleetmap_" + std::to_string(server->port()) + "=0123456789abcdef";
  EXPECT_THAT(asked("/?token=0123456789abcdef"),
              AllOf(StartsWith("HTTP/1.1 303"), HasSubstr("Location: /\r\n"),
                    HasSubstr(cookie + "; HttpOnly; SameSite=Lax")));
  EXPECT_THAT(asked("/", "Cookie: " + cookie + "\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(asked("/state.json", "Authorization: Bearer 0123456789abcdef\r\n"), StartsWith("HTTP/1.1 200"));
  Browser socket(server->port());
  socket.upgrade();
  EXPECT_EQ(socket.status(), "403");
}

TEST(Server, a_port_in_use_is_an_error_that_names_it) {
  const auto server = start();
  ServerConfig config;
  config.port = server->port();
  const auto second = Server::start(config, {}, kPage);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message,
              AllOf(HasSubstr(std::to_string(server->port())), HasSubstr("another port")));
}

}  // namespace
}  // namespace fleetmap::monitor
