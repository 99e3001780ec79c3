#include "monitor/foxglove/protocol.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "monitor/views.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using nlohmann::json;

TEST(Protocol, the_present_name_of_the_subprotocol_is_preferred) {
  EXPECT_EQ(accepted_subprotocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(accepted_subprotocol("foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(accepted_subprotocol("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(accepted_subprotocol("chat ,\tfoxglove.websocket.v1 "), "foxglove.websocket.v1");
  for (const char* other : {"", ",", " , ,", "foxglove.websocket.v2", "foxglove.sdk.v1x", "xfoxglove.sdk.v1",
                            "foxglove.websocket", "foxglove.sdk.v1 foxglove.websocket.v1", "FOXGLOVE.SDK.V1"})
    EXPECT_EQ(accepted_subprotocol(other), "") << other;
}

TEST(Protocol, subscriptions_are_read) {
  const auto request = parse_client_text(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":5}]})");
  ASSERT_TRUE(request);
  const auto& subscriptions = std::get<Subscribe>(*request).subscriptions;
  ASSERT_EQ(subscriptions.size(), 2u);
  EXPECT_EQ(subscriptions[0].id, 0u);
  EXPECT_EQ(subscriptions[0].channel, 3u);
  EXPECT_EQ(subscriptions[1].id, 4294967295u);
  const auto end = parse_client_text(R"({"op":"unsubscribe","subscriptionIds":[7,8]})");
  ASSERT_TRUE(end);
  EXPECT_EQ(std::get<Unsubscribe>(*end).ids, (std::vector<std::uint32_t>{7, 8}));
}

TEST(Protocol, other_operations_are_not_offered) {
  for (const char* name : {"advertise", "unadvertise", "getParameters", "setParameters",
                           "subscribeParameterUpdates", "subscribeConnectionGraph", "fetchAsset", ""}) {
    const auto request = parse_client_text(json{{"op", name}}.dump());
    ASSERT_TRUE(request) << name;
    EXPECT_EQ(std::get<NotOffered>(*request).operation, name);
  }
  const auto request = parse_client_text(json{{"op", std::string(5000, 'x')}}.dump());
  ASSERT_TRUE(request);
  EXPECT_LT(std::get<NotOffered>(*request).operation.size(), 100u) << "it is repeated in the status";
}

TEST(Protocol, hostile_texts_are_errors) {
  for (const std::string& text :
       {std::string(),
        std::string("{"),
        std::string("[]"),
        std::string("null"),
        std::string("1e999"),
        std::string("\0\xff\xfe", 3),
        std::string("{\"op\":\"\xc3\x28\"}"),
        std::string("{}"),
        std::string(R"({"op":1})"),
        std::string(R"({"op":"subscribe"})"),
        std::string(R"({"op":"subscribe","subscriptions":{}})"),
        std::string(R"({"op":"subscribe","subscriptions":[1]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":"1","channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":99999999999999999999}]})"),
        std::string(R"({"op":"unsubscribe","subscriptionIds":[null]})"),
        std::string(R"({"op":"unsubscribe","subscriptionIds":7})"),
        std::string(30'000, '['),
        R"({"op":"subscribe","subscriptions":)" + std::string(30'000, '[') + std::string(30'000, ']') +
            "}"}) {
    const auto request = parse_client_text(text);
    ASSERT_FALSE(request) << text.substr(0, 80);
    EXPECT_FALSE(request.error().message.empty());
  }
}

TEST(Protocol, the_server_offers_no_more_than_channels) {
  const json info = json::parse(server_info("abc"));
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_TRUE(info["name"].is_string());
  EXPECT_EQ(info["capabilities"], json::array());
  EXPECT_EQ(info["sessionId"], "abc");
}

TEST(Protocol, channels_are_advertised_with_their_schemas) {
  const std::vector<Channel> channels = {
      {3, "/fleet/map", ChannelKind::map, {}, 0},
      {5, "/r1/fix", ChannelKind::fix, testing::node_id("r1", 0).agent, 0}};
  const json text = json::parse(advertise(channels));
  EXPECT_EQ(text["op"], "advertise");
  ASSERT_EQ(text["channels"].size(), 2u);
  const json& map = text["channels"][0];
  EXPECT_EQ(map["id"], 3);
  EXPECT_EQ(map["topic"], "/fleet/map");
  EXPECT_EQ(map["encoding"], "cdr");
  EXPECT_EQ(map["schemaEncoding"], "omgidl");
  EXPECT_EQ(map["schemaName"], "foxglove::PointCloud");
  EXPECT_NE(map["schema"].get<std::string>().find("struct PointCloud"), std::string::npos);
  EXPECT_EQ(text["channels"][1]["schemaName"], "foxglove::LocationFix");
}

TEST(Protocol, a_status_is_text_of_any_bytes) {
  const json text = json::parse(status(StatusLevel::error, "bad \xff \"text\""));
  EXPECT_EQ(text["op"], "status");
  EXPECT_EQ(text["level"], 2);
  EXPECT_NE(text["message"].get<std::string>().find("\"text\""), std::string::npos);
}

TEST(Protocol, the_header_of_a_message_is_little_endian) {
  const auto header = message_header(0x01020304, stamp_from_ns(0x1122334455667788));
  const std::array<std::uint8_t, 13> expected = {1,    4,    3,    2,    1,    0x88, 0x77,
                                                 0x66, 0x55, 0x44, 0x33, 0x22, 0x11};
  EXPECT_EQ(header, expected);
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
