#include "monitor/http_answer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/foxglove/client_session.hpp"
#include "monitor/page_files.hpp"
#include "monitor/viewer.hpp"

namespace fleetmap::monitor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kPage;

using Method = HttpRequest::Method;

constexpr const char* kToken = "0123456789abcdef";

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
            config(token), [](const NodeId&, const ContentHash&) { return Result<cloud::PointCloud>(); },
            kPage) {
    state_.cookie = "fleetmap_80";
  }
  static HttpRequest request(Method method, const std::string& target) {
    HttpRequest request;
    request.method = method;
    request.target = target;
    request.host = "127.0.0.1:80";
    return request;
  }
  static HttpRequest upgrade(const std::string& target) {
    HttpRequest asks = request(Method::get, target);
    asks.upgrade = true;
    return asks;
  }
  unsigned status(const HttpRequest& asks) { return answer(state_, asks).status; }

  ServerState state_;
};

TEST_F(HttpAnswer, a_page_comes_with_headers_that_keep_other_sites_out) {
  const HttpResponse page = answer(state_, request(Method::get, "/"));
  EXPECT_EQ(page.status, 200u);
  EXPECT_EQ(page.header("Content-Type"), "text/html");
  EXPECT_EQ(page.header("Content-Encoding"), "gzip");
  EXPECT_EQ(page.header("Cache-Control"), "no-store");
  EXPECT_EQ(page.body, std::string({1, 2, 3}));
  const std::string policy(page.header("Content-Security-Policy"));
  for (const char* rule : {"default-src 'self';", "connect-src 'self' ws://127.0.0.1:80;",
                           "frame-ancestors 'none';", "base-uri 'none'", "form-action 'none'"})
    EXPECT_THAT(policy, HasSubstr(rule));
  EXPECT_EQ(page.header("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(page.header("X-Frame-Options"), "DENY");
  EXPECT_EQ(page.header("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(page.header("Cross-Origin-Resource-Policy"), "same-origin");
  EXPECT_EQ(state_.counters.refused, 0u);
}

TEST_F(HttpAnswer, what_is_not_there_and_what_would_change_something_is_refused_and_counted) {
  EXPECT_EQ(status(request(Method::get, "/nothing")), 404u);
  EXPECT_EQ(status(request(Method::other, "/")), 405u);
  EXPECT_EQ(status(request(Method::post, "/")), 405u);
  EXPECT_EQ(status(request(Method::head, "/")), 200u);
  HttpRequest foreign = request(Method::get, "/");
  foreign.host = "evil.example";
  const HttpResponse refused = answer(state_, foreign);
  EXPECT_EQ(refused.status, 403u);
  EXPECT_EQ(refused.body, "the Host is no address of this program\n");
  EXPECT_EQ(status(request(Method::get, "/?token=")), 200u) << "without a token there is none to exchange";
  EXPECT_EQ(state_.counters.refused, 4u);
}

TEST_F(HttpAnswer, a_web_socket_is_opened_at_its_place_for_so_many) {
  EXPECT_EQ(status(upgrade("/live")), 101u);
  EXPECT_EQ(status(upgrade("/")), 404u);
  EXPECT_EQ(status(request(Method::get, "/live")), 426u) << "no page is there";
  const HttpResponse opened = answer(state_, upgrade("/live"));
  EXPECT_NE(opened.session, nullptr);
  EXPECT_EQ(status(upgrade("/live")), 503u) << "while one is open";
  EXPECT_EQ(state_.counters.refused, 3u);
}

TEST_F(HttpAnswer, a_page_learns_why_its_web_socket_was_refused) {
  EXPECT_EQ(status(request(Method::get, "/live")), 426u);
  state_.counters.viewers = 1;
  const HttpResponse full = answer(state_, request(Method::get, "/live"));
  EXPECT_EQ(full.status, 503u);
  EXPECT_EQ(full.body, "too many pages are open; close one\n");
}

TEST_F(HttpAnswer, a_web_socket_is_that_of_the_page_or_of_a_client_by_its_subprotocol) {
  EXPECT_NE(dynamic_cast<Viewer*>(answer(state_, upgrade("/live")).session.get()), nullptr);
  HttpRequest asks = upgrade("/");
  asks.subprotocols = "chat,foxglove.websocket.v1,";
  const HttpResponse opened = answer(state_, asks);
  EXPECT_NE(dynamic_cast<foxglove::ClientSession*>(opened.session.get()), nullptr);
  EXPECT_EQ(opened.header("Sec-WebSocket-Protocol"), "foxglove.websocket.v1");
}

TEST_F(HttpAnswer, nobody_gives_orders_without_a_token) {
  state_.give_order = [](const OrderRequest&) -> Status { return {}; };
  HttpRequest order = request(Method::post, "/operator/hold");
  order.origin = "http://127.0.0.1:80";
  EXPECT_EQ(status(order), 403u);
}

class HttpAnswerWithToken : public HttpAnswer {
 protected:
  HttpAnswerWithToken() : HttpAnswer(kToken) {}
  static HttpRequest with_cookie(HttpRequest asks) {
    asks.cookie = std::string("fleetmap_80=") + kToken;
    return asks;
  }
};

TEST_F(HttpAnswerWithToken, the_token_of_the_address_becomes_a_cookie) {
  const HttpResponse first = answer(state_, request(Method::get, std::string("/?token=") + kToken));
  EXPECT_EQ(first.status, 303u);
  EXPECT_EQ(first.header("Location"), "/");
  EXPECT_EQ(first.header("Set-Cookie"), "fleetmap_80=0123456789abcdef; HttpOnly; SameSite=Lax; Path=/");
  EXPECT_EQ(status(request(Method::get, "/?token=0123456789abcdee")), 403u);
  EXPECT_EQ(status(request(Method::get, "/")), 403u);
  EXPECT_EQ(status(upgrade("/live")), 403u);
  EXPECT_EQ(status(with_cookie(request(Method::get, "/"))), 200u);
  EXPECT_EQ(status(with_cookie(upgrade("/live"))), 101u);
  HttpRequest foreign = request(Method::get, std::string("/?token=") + kToken);
  foreign.host = "evil.example";
  EXPECT_EQ(status(foreign), 403u) << "the cookie would go to a foreign name";
}

TEST_F(HttpAnswerWithToken, orders_are_passed_on_and_what_becomes_of_them_is_told) {
  HttpRequest order = with_cookie(request(Method::post, "/operator/resume?robot=r2"));
  order.origin = "http://127.0.0.1:80";
  EXPECT_EQ(status(order), 403u) << "a finished run has no robot that would obey";
  std::vector<std::string> received;
  state_.give_order = [&](const OrderRequest& order) -> Status {
    received.push_back((order.kind == OrderRequest::Kind::kHold ? "hold " : "resume ") +
                       (order.robot ? order.robot->str() : "all"));
    return received.size() > 1 ? failure("no radio") : Status{};
  };
  EXPECT_EQ(status(order), 202u);
  order.target = "/operator/hold";
  const HttpResponse failed = answer(state_, order);
  EXPECT_EQ(failed.status, 503u);
  EXPECT_EQ(failed.body, "no radio\n");
  order.origin.clear();
  EXPECT_EQ(status(order), 403u) << "who hides the page that posts";
  order.cookie.clear();
  order.authorization = std::string("Bearer ") + kToken;
  EXPECT_EQ(status(order), 503u) << "a program shows the token itself";
  EXPECT_EQ(status(with_cookie(request(Method::get, "/operator/hold"))), 404u);
  EXPECT_THAT(received, ElementsAre("resume r2", "hold all", "hold all"));
}

}  // namespace
}  // namespace fleetmap::monitor
