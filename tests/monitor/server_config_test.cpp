#include "fleetmap/monitor/server_config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/field_bounds.hpp"

namespace fleetmap::monitor {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;

using Config = ServerConfig;

const std::string kShortestToken(16, 'x');

TEST(ServerConfig, WithoutATokenOnlyThisMachineIsServed) {
  expect_accepted(Config{}, &Config::address, {"127.0.0.1", "::1"});
  expect_refused(Config{}, &Config::address, {"0.0.0.0", "192.168.1.7", "::"}, "a token is needed");
  Config with_token;
  with_token.token = kShortestToken;
  expect_accepted(with_token, &Config::address, {"0.0.0.0", "192.168.1.7", "::"});
}

TEST(ServerConfig, TheAddressIsOneAndTheTokenIsLong) {
  expect_refused(Config{}, &Config::address, {"", "localhost", "127.0.0.1:80"}, "is no IP address");
  expect_refused(Config{}, &Config::token, {"x", kShortestToken.substr(1)}, "shorter than 16");
  expect_accepted(Config{}, &Config::token, {"", kShortestToken});
}

TEST(ServerConfig, SomebodyIsServed) {
  expect_accepted(Config{}, &Config::max_viewers, {1});
  expect_refused(Config{}, &Config::max_viewers, {0}, "max_viewers");
  expect_accepted(Config{}, &Config::max_connections, {1});
  expect_refused(Config{}, &Config::max_connections, {0}, "max_connections");
}

}  // namespace
}  // namespace fleetmap::monitor
