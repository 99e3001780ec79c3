// A Foxglove client at the server: what it gets over its WebSocket, and what it may not do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "fleetmap/monitor/server.hpp"
#include "monitor/browser.hpp"
#include "monitor/foxglove/fleet_channels.hpp"
#include "monitor/foxglove/read_cloud.hpp"
#include "monitor/views.hpp"
#include "support/eventually.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Browser;
using testing::eventually;
using ::testing::HasSubstr;
using testing::node_id;
using ::testing::StartsWith;
using testing::ViewMaker;

constexpr const char* kOffer = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n";

std::unique_ptr<Server> start_with_points(const ServerConfig& config = {}, std::size_t points = 50) {
  auto load = [points](const NodeId&, const ContentHash&) {
    cloud::PointCloud cloud;
    for (std::size_t k = 0; k < points; ++k)
      cloud.points.emplace_back(0.001f * static_cast<float>(k), 1.0f, 2.0f);
    return Result<cloud::PointCloud>(cloud);
  };
  return Server::start(config, load, {}).value();
}

std::shared_ptr<const FleetView> two_robot_view() {
  ViewMaker fleet;
  fleet.robot("r1", 0.0).robot("r2", 50.0);
  return std::make_shared<const FleetView>(fleet.view);
}

std::shared_ptr<const LiveStatus> status_of_r2() {
  LiveStatus status;
  status.robots.emplace_back().id = node_id("r2", 0).agent;
  return std::make_shared<const LiveStatus>(status);
}

/// Goes through the handshake; the channels' ids by topic.
std::map<std::string, std::uint32_t> connect(Browser& browser, const std::string& path = "/") {
  browser.upgrade(path, kOffer);
  EXPECT_THAT(browser.answer(), StartsWith("HTTP/1.1 101"));
  EXPECT_EQ(json::parse(browser.message())["op"], "serverInfo");
  std::map<std::string, std::uint32_t> ids;
  const json advertised = json::parse(browser.message());
  EXPECT_EQ(advertised["op"], "advertise");
  for (const json& channel : advertised["channels"]) ids[channel["topic"]] = channel["id"];
  return ids;
}

void subscribe(Browser& browser, std::uint32_t id, std::uint32_t channel) {
  ASSERT_TRUE(browser.send_message(R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) +
                                   R"(,"channelId":)" + std::to_string(channel) + "}]}"));
}

struct Data {
  std::uint32_t subscription = 0;
  std::uint64_t received_ns = 0;
  Bytes message;
};
/// The next message of a channel; empty if the WebSocket closed first.
Data next_data(Browser& browser) {
  while (true) {
    const Browser::Message next = browser.any_message();
    if (next.kind == 8) return {};
    if (next.kind != 2) continue;
    EXPECT_GE(next.payload.size(), 13u);
    EXPECT_EQ(next.payload[0], 1) << "opcode of message data";
    Data data;
    std::memcpy(&data.subscription, next.payload.data() + 1, 4);
    std::memcpy(&data.received_ns, next.payload.data() + 5, 8);
    data.message.assign(next.payload.begin() + 13, next.payload.end());
    return data;
  }
}

json next_status(Browser& browser) {
  while (true) {
    const std::string text = browser.message();
    if (text.empty()) return {};
    json message = json::parse(text);
    if (message["op"] == "status") return message;
  }
}

TEST(ClientSession, the_answer_names_the_subprotocol) {
  const auto server = start_with_points();
  const auto answer = [&](const std::string& path, const std::string& headers) {
    Browser browser(server->port());
    browser.upgrade(path, headers);
    return browser.answer();
  };
  const std::string former = "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n";
  EXPECT_THAT(answer("/", former), HasSubstr("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"));
  EXPECT_THAT(answer("/", kOffer), HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"));
  EXPECT_THAT(answer("/live", former + kOffer), HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"));
  EXPECT_THAT(answer("/live", "Sec-WebSocket-Protocol: chat\r\n"),
              ::testing::AllOf(StartsWith("HTTP/1.1 101"), ::testing::Not(HasSubstr("foxglove"))))
      << "the page's";
  EXPECT_THAT(answer("/", ""), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(answer("/", "Sec-WebSocket-Protocol: chat\r\n"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(answer("/state.json", kOffer), StartsWith("HTTP/1.1 404"));
}

TEST(ClientSession, sends_what_a_client_subscribes_to) {
  const auto server = start_with_points();
  server->publish(two_robot_view());
  server->publish(status_of_r2());
  Browser browser(server->port());
  auto ids = connect(browser);
  ASSERT_TRUE(ids.contains("/r2/status"));
  subscribe(browser, 1000, ids.at("/fleet/map"));
  const Data map = next_data(browser);
  EXPECT_EQ(map.subscription, 1000u);
  EXPECT_GT(map.received_ns, 1'700'000'000'000'000'000u);
  const auto points = testing::read_cloud(map.message);
  ASSERT_EQ(points.size(), 6u * 50u);
  EXPECT_EQ(points.back().robot, 1);
  EXPECT_NEAR(points.back().p[1], 1.0f, 1e-3f);
  for (const char* topic :
       {"/fleet/transforms", "/fleet/trajectories", "/fleet/alignments", "/r1/fix", "/r2/status"}) {
    const std::uint32_t id = ids.at(topic);
    subscribe(browser, 10 * id, id);
    const Data data = next_data(browser);
    EXPECT_EQ(data.subscription, 10 * id) << topic;
    EXPECT_GT(data.message.size(), 4u) << topic;
  }
}

TEST(ClientSession, sends_what_is_newer_and_advertises_robots_that_come) {
  const auto server = start_with_points();
  Browser browser(server->port());
  auto ids = connect(browser, "/live");
  EXPECT_EQ(ids.size(), 4u) << "those of the fleet, before there is one";
  subscribe(browser, 7, ids.at("/fleet/transforms"));
  server->publish(two_robot_view());
  const json advertised = json::parse(browser.message());
  EXPECT_EQ(advertised["op"], "advertise");
  EXPECT_EQ(advertised["channels"].size(), 2u);
  EXPECT_EQ(advertised["channels"][0]["topic"], "/r1/fix");
  EXPECT_EQ(next_data(browser).subscription, 7u);
  server->publish(two_robot_view());
  EXPECT_EQ(next_data(browser).subscription, 7u);
  browser.send_message(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  browser.send_message(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  EXPECT_THAT(next_status(browser)["message"], HasSubstr("subscription 7 does not exist"));
}

TEST(ClientSession, what_is_not_offered_or_malformed_gets_a_status) {
  const auto server = start_with_points();
  Browser browser(server->port());
  connect(browser);
  subscribe(browser, 1, 99);
  const json unknown = next_status(browser);
  EXPECT_EQ(unknown["level"], 1);
  EXPECT_THAT(unknown["message"], HasSubstr("channel 99 does not exist"));
  for (const char* operation : {"advertise", "getParameters", "fetchAsset", "no such thing"}) {
    browser.send_message(json{{"op", operation}}.dump());
    EXPECT_THAT(next_status(browser)["message"], HasSubstr(operation));
  }
  for (const std::string& text :
       {std::string("{"), std::string("[[[["), std::string("{}"), std::string(50'000, '[')}) {
    browser.send_message(text);
    EXPECT_EQ(next_status(browser)["level"], 2);
  }
  browser.send_message(std::string("\x01\x00\x00\x00\x00 data", 10), 2);
  EXPECT_THAT(next_status(browser)["message"], HasSubstr("publishing"));
  EXPECT_EQ(server->stats().viewers, 1u);
  EXPECT_EQ(server->stats().cut, 0u);
}

TEST(ClientSession, too_large_and_malformed_frames_end_it) {
  const auto server = start_with_points();
  const std::string too_large("\x81\xff\x00\x00\x00\x00\x7f\xff\xff\xff\x00\x00\x00\x00", 14);
  for (const std::string& bytes : {too_large, std::string("\x81\x02{}", 4) /* not masked */,
                                   std::string("\xf1\x80\x00\x00\x00\x00", 6) /* reserved bits */,
                                   std::string("\x81\x82\x00\x00\x00\x00\xc3\x28", 8) /* no UTF-8 */}) {
    Browser browser(server->port());
    connect(browser);
    browser.send(bytes);
    EXPECT_TRUE(browser.closed());
  }
  EXPECT_TRUE(eventually([&] { return server->stats().viewers == 0; }, seconds(10)));
  EXPECT_EQ(server->stats().cut, 4u);
  Browser after(server->port());
  connect(after);
}

TEST(ClientSession, a_client_that_reads_no_status_is_cut) {
  ServerConfig config;
  config.foxglove_points = 2'000'000;  // more than sockets take
  const auto server = start_with_points(config, 200'000);
  server->publish(two_robot_view());
  Browser deaf(server->port());
  const auto ids = connect(deaf);
  subscribe(deaf, 1, ids.at("/fleet/map"));
  // The map fills the connection, so statuses wait.
  for (int k = 0; k < 40; ++k) deaf.send_message("nonsense");
  Browser other(server->port());
  other.get("/state.json");
  EXPECT_EQ(other.status(), "200") << "nobody waits for it";
  ASSERT_TRUE(eventually(
      [&] {
        if (server->stats().viewers == 0) return true;
        deaf.send_message("nonsense");
        return false;
      },
      seconds(60)));
  EXPECT_GE(server->stats().cut, 1u);
}

TEST(ClientSession, a_client_that_answers_no_ping_is_cut) {
  ServerConfig config;
  config.idle_timeout = milliseconds(400);
  const auto server = start_with_points(config);
  Browser silent(server->port());
  connect(silent);
  EXPECT_TRUE(eventually([&] { return server->stats().viewers == 0; }, seconds(20)));
  EXPECT_EQ(server->stats().cut, 1u);
}

TEST(ClientSession, pages_and_clients_together_are_so_many_at_most) {
  ServerConfig config;
  config.max_viewers = 2;
  const auto server = start_with_points(config);
  Browser page(server->port()), client(server->port()), more(server->port());
  page.upgrade();
  ASSERT_EQ(page.status(), "101");
  connect(client);
  more.upgrade("/", kOffer);
  EXPECT_EQ(more.status(), "503");
}

TEST(ClientSession, without_a_token_other_sites_and_names_are_refused) {
  const auto server = start_with_points();
  const auto refused = [&](const std::string& headers) {
    Browser browser(server->port());
    browser.send(
        "GET / HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
        std::string(kOffer) + headers + "\r\n");
    return browser.status();
  };
  EXPECT_EQ(refused("Host: 127.0.0.1\r\nOrigin: https://app.foxglove.dev\r\n"), "403");
  EXPECT_EQ(refused("Host: evil.example\r\n"), "403");
  EXPECT_EQ(refused("Host: 127.0.0.1\r\n"), "101");
}

TEST(ClientSession, with_a_token_it_is_in_the_address) {
  ServerConfig config;
  config.token = "0123456789abcdef";
  const auto server = start_with_points(config);
  const auto asked = [&](const std::string& path, const std::string& headers = "") {
    Browser browser(server->port());
    browser.upgrade(path, kOffer + headers);
    return browser.status();
  };
  EXPECT_EQ(asked("/"), "403");
  EXPECT_EQ(asked("/?token="), "403");
  EXPECT_EQ(asked("/?token=0123456789abcdee"), "403");
  EXPECT_EQ(asked("/?token=0123456789abcdef0"), "403");
  EXPECT_EQ(asked("/?token=0123456789abcdef"), "101");
  EXPECT_EQ(asked("/live?token=0123456789abcdef"), "101");
  EXPECT_EQ(asked("/?token=0123456789abcdef", "Origin: https://app.foxglove.dev\r\n"), "101")
      << "Foxglove's app is a site of its own";
  EXPECT_EQ(asked("/?token=0123456789abcdee", "Origin: https://app.foxglove.dev\r\n"), "403");
  EXPECT_EQ(asked("/", "Authorization: Bearer 0123456789abcdef\r\n"), "101");
  const std::string cookie = "Cookie: fleetmap_" + std::to_string(server->port()) + "=0123456789abcdef\r\n";
  EXPECT_EQ(asked("/", cookie + "Origin: https://evil.example\r\n"), "403")
      << "sent by the browser, not by the site";
  Browser page(server->port());
  page.upgrade("/live?token=0123456789abcdef");
  EXPECT_EQ(page.status(), "403") << "the page has a cookie";
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
