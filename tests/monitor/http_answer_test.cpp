#include "monitor/http_answer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/viewer.hpp"

namespace fleetmap::monitor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kToken = "0123456789abcdef";
constexpr std::uint8_t kFile[] = {1, 2, 3};
constexpr PageFile kPage[] = {{"/index.html", "text/html", kFile}};

class HttpAnswer : public ::testing::Test {
 protected:
  static ServerConfig config(const std::string& token) {
    ServerConfig config;
    config.token = token;
    config.max_viewers = 1;
    return config;
  }
  explicit HttpAnswer(const std::string& token = "")
      : state_(
            config(token), [](const NodeId&) { return Result<cloud::PointCloud>(); }, kPage) {
    state_.cookie = "fleetmap_80";
  }
  static Request request(http::verb method, const std::string& target) {
    Request request(method, target, 11);
    request.set(http::field::host, "127.0.0.1:80");
    return request;
  }
  static Request upgrade(const std::string& target) {
    Request asks = request(http::verb::get, target);
    asks.set(http::field::connection, "Upgrade");
    asks.set(http::field::upgrade, "websocket");
    asks.set(http::field::sec_websocket_version, "13");
    asks.set(http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
    return asks;
  }
  unsigned status(const Request& asks) { return answer(state_, asks).result_int(); }

  ServerState state_;
};

TEST_F(HttpAnswer, a_page_comes_with_headers_that_keep_other_sites_out) {
  const Response page = answer(state_, request(http::verb::get, "/"));
  EXPECT_EQ(page.result_int(), 200u);
  EXPECT_EQ(page[http::field::content_type], "text/html");
  EXPECT_EQ(page[http::field::content_encoding], "gzip");
  EXPECT_EQ(page[http::field::cache_control], "no-store");
  EXPECT_EQ(page.body(), std::string({1, 2, 3}));
  const auto policy_header = page["Content-Security-Policy"];
  const std::string policy(policy_header.data(), policy_header.size());
  for (const char* rule : {"default-src 'self';", "connect-src 'self' ws://127.0.0.1:80;",
                           "frame-ancestors 'none';", "base-uri 'none'", "form-action 'none'"})
    EXPECT_THAT(policy, HasSubstr(rule));
  EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
  EXPECT_EQ(page["X-Frame-Options"], "DENY");
  EXPECT_EQ(page["Referrer-Policy"], "no-referrer");
  EXPECT_EQ(page["Cross-Origin-Resource-Policy"], "same-origin");
  EXPECT_EQ(state_.refused, 0u);
}

TEST_F(HttpAnswer, what_is_not_there_and_what_would_change_something_is_refused_and_counted) {
  EXPECT_EQ(status(request(http::verb::get, "/nothing")), 404u);
  EXPECT_EQ(status(request(http::verb::put, "/")), 405u);
  EXPECT_EQ(status(request(http::verb::post, "/")), 405u);
  EXPECT_EQ(status(request(http::verb::head, "/")), 200u);
  Request foreign = request(http::verb::get, "/");
  foreign.set(http::field::host, "evil.example");
  const Response refused = answer(state_, foreign);
  EXPECT_EQ(refused.result_int(), 403u);
  EXPECT_EQ(refused.body(), "the Host is no address of this program\n");
  EXPECT_EQ(status(request(http::verb::get, "/?token=")), 200u)
      << "without a token there is none to exchange";
  EXPECT_EQ(state_.refused, 4u);
}

TEST_F(HttpAnswer, a_web_socket_is_opened_at_its_place_for_so_many) {
  EXPECT_EQ(status(upgrade("/live")), 101u);
  EXPECT_EQ(status(upgrade("/")), 404u);
  EXPECT_EQ(status(request(http::verb::get, "/live")), 404u) << "no page is there";
  Viewer one(state_, beast::tcp_stream(state_.io), std::make_shared<CountedConnection>(state_));
  state_.viewers.insert(&one);
  ++state_.viewers_now;
  EXPECT_EQ(status(upgrade("/live")), 503u);
  EXPECT_EQ(state_.refused, 3u);
}

TEST_F(HttpAnswer, nobody_gives_orders_without_a_token) {
  state_.give_order = [](const OrderRequest&) -> Status { return {}; };
  Request order = request(http::verb::post, "/operator/hold");
  order.set(http::field::origin, "http://127.0.0.1:80");
  EXPECT_EQ(status(order), 403u);
}

class HttpAnswerWithToken : public HttpAnswer {
 protected:
  HttpAnswerWithToken() : HttpAnswer(kToken) {}
  static Request with_cookie(Request asks) {
    asks.set(http::field::cookie, std::string("fleetmap_80=") + kToken);
    return asks;
  }
};

TEST_F(HttpAnswerWithToken, the_token_of_the_address_becomes_a_cookie) {
  const Response first = answer(state_, request(http::verb::get, std::string("/?token=") + kToken));
  EXPECT_EQ(first.result_int(), 303u);
  EXPECT_EQ(first[http::field::location], "/");
  EXPECT_EQ(first[http::field::set_cookie],
            "fleetmap_80=0123456789abcdef; HttpOnly; SameSite=Strict; Path=/");
  EXPECT_EQ(status(request(http::verb::get, "/?token=0123456789abcdee")), 403u);
  EXPECT_EQ(status(request(http::verb::get, "/")), 403u);
  EXPECT_EQ(status(upgrade("/live")), 403u);
  EXPECT_EQ(status(with_cookie(request(http::verb::get, "/"))), 200u);
  EXPECT_EQ(status(with_cookie(upgrade("/live"))), 101u);
  Request foreign = request(http::verb::get, std::string("/?token=") + kToken);
  foreign.set(http::field::host, "evil.example");
  EXPECT_EQ(status(foreign), 403u) << "the cookie would go to a foreign name";
}

TEST_F(HttpAnswerWithToken, orders_are_passed_on_and_what_becomes_of_them_is_told) {
  Request order = with_cookie(request(http::verb::post, "/operator/resume?robot=r2"));
  order.set(http::field::origin, "http://127.0.0.1:80");
  EXPECT_EQ(status(order), 403u) << "a finished run has no robot that would obey";
  std::vector<std::string> received;
  state_.give_order = [&](const OrderRequest& order) -> Status {
    received.push_back((order.kind == OrderRequest::Kind::kHold ? "hold " : "resume ") +
                       (order.robot ? order.robot->str() : "all"));
    return received.size() > 1 ? failure("no radio") : Status{};
  };
  EXPECT_EQ(status(order), 202u);
  order.target("/operator/hold");
  const Response failed = answer(state_, order);
  EXPECT_EQ(failed.result_int(), 503u);
  EXPECT_EQ(failed.body(), "no radio\n");
  order.erase(http::field::origin);
  EXPECT_EQ(status(order), 403u) << "who hides the page that posts";
  order.erase(http::field::cookie);
  order.set(http::field::authorization, std::string("Bearer ") + kToken);
  EXPECT_EQ(status(order), 503u) << "a program shows the token itself";
  EXPECT_EQ(status(with_cookie(request(http::verb::get, "/operator/hold"))), 404u);
  EXPECT_THAT(received, ElementsAre("resume r2", "hold all", "hold all"));
}

}  // namespace
}  // namespace fleetmap::monitor
