#include "keys_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "fleetmap/core/utc.hpp"
#include "fleetmap/trust/key_store.hpp"
#include "section_problems.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct KeysReading {
  agent::AgentConfig agent;
  bus::DdsBusConfig dds;
  std::string problems;
};

KeysReading keys_of(const std::string& yaml, bool of_fleet, const std::string& id) {
  KeysReading result;
  result.agent.id = AgentId::parse(id).value();
  result.problems =
      problems_of(yaml, [&](Section& top) { read_keys(top, of_fleet, result.agent, result.dds); });
  return result;
}

/// Keys of r1 in the folder's r1, valid now.
class KeysSection : public ::testing::Test {
 protected:
  KeysSection() {
    const auto now = system_now();
    auto store = trust::KeyStore::init(folder_.path(), now);
    EXPECT_TRUE(store &&
                store->add(AgentId::parse("r1").value(), trust::Role::kRobot, std::chrono::days(365), now));
  }
  std::string keys(const std::string& folder) const {
    return "keys: " + (folder_.path() / folder).string() + "\n";
  }

  testing::TemporaryFolder folder_;
};

TEST_F(KeysSection, WithoutTheKeyNothingIsSigned) {
  const KeysReading r = keys_of("{}", false, "r1");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.dds.keys, nullptr);
  EXPECT_EQ(r.agent.exchange.authenticator, nullptr);
}

TEST_F(KeysSection, TheRobotsKeysSealTheRadioAndSignItems) {
  const KeysReading r = keys_of(keys("r1"), false, "r1");
  EXPECT_EQ(r.problems, "");
  ASSERT_NE(r.dds.keys, nullptr);
  EXPECT_EQ(r.dds.keys->certificate.name.str(), "r1");
  EXPECT_NE(r.agent.exchange.authenticator, nullptr);
  EXPECT_GT(r.agent.exchange.long_range.overhead_bytes, exchange::LongRangeConfig{}.overhead_bytes)
      << "seals count against the radio's budget";
}

TEST_F(KeysSection, AFleetsFolderHoldsOneForEachRobot) {
  EXPECT_EQ(keys_of(keys(""), true, "r1").problems, "");
  EXPECT_THAT(keys_of(keys(""), true, "r2").problems, HasSubstr("robot.yaml:1: keys: "));
}

TEST_F(KeysSection, AnotherRobotsKeysAreRefused) {
  const KeysReading r = keys_of(keys("r1"), false, "r2");
  EXPECT_THAT(r.problems, HasSubstr("is the folder of r1; expected that of r2"));
  EXPECT_EQ(r.dds.keys, nullptr);
}

}  // namespace
}  // namespace fleetmap::config
