#include "page/monitor_access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

AccessOptions access_at(const std::string& address) {
  AccessOptions access;
  access.port = 8080;
  access.address = address;
  return access;
}

TEST(AccessOptions, OnThisMachineAloneNoTokenIsNeeded) {
  const auto config = server_config(access_at("127.0.0.1"));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->token, "");
  EXPECT_EQ(config->port, 8080);
  EXPECT_EQ(config->max_viewers, 8u);
}

TEST(AccessOptions, OthersNeedARandomToken) {
  const auto one = server_config(access_at("0.0.0.0")), other = server_config(access_at("0.0.0.0"));
  ASSERT_TRUE(one && other);
  EXPECT_GE(one->token.size(), 16u);
  EXPECT_NE(one->token, other->token);
}

TEST(AccessOptions, TheTokenOfAFileIsUsedWithoutItsLineEnd) {
  const testing::TemporaryFolder folder;
  AccessOptions access = access_at("0.0.0.0");
  access.token_file = (folder.path() / "token").string();
  folder.write("token", "abcdefgh12345678\r\n");
  const auto config = server_config(access);
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->token, "abcdefgh12345678");
  for (const char* bad : {"", "short", "abcdefgh 12345678", "abcdefgh12345678\nx", "abcdefgh-12345678"}) {
    folder.write("token", bad);
    const auto refused = server_config(access);
    ASSERT_FALSE(refused) << bad;
    EXPECT_THAT(refused.error().message, HasSubstr(access.token_file + ": expected a token of at least 16"));
  }
  access.token_file = (folder.path() / "none").string();
  EXPECT_FALSE(server_config(access));
}

TEST(AccessOptions, WithoutAPortThereIsNoPageButWrongOptionsAreRefused) {
  AccessOptions access = access_at("127.0.0.1");
  access.port.reset();
  const auto none = config_of_page(access);
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  EXPECT_TRUE(config_of_page(access_at("127.0.0.1")).value());
  access.address = "nowhere";
  EXPECT_FALSE(config_of_page(access));
}

TEST(AccessOptions, OptionsHaveTheirPrefixAndBounds) {
  AccessOptions access;
  CLI::App app;
  add_page_options(app, access, "of it");
  app.parse("--monitor 0 --monitor-address 10.0.0.1 --monitor-viewers 64");
  EXPECT_EQ(access.port, 0);
  EXPECT_EQ(access.address, "10.0.0.1");
  EXPECT_EQ(access.viewers, 64u);
  for (const char* bad : {"--monitor 65536", "--monitor -1", "--monitor-viewers 0", "--monitor-viewers 65"})
    EXPECT_THROW(app.parse(bad), CLI::ParseError) << bad;
}

}  // namespace
}  // namespace fleetmap::apps
