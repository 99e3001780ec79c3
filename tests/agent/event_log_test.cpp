#include "event_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/captured_log.hpp"

namespace fleetmap::agent {
namespace {

using bus::testing::CapturedLog;
using ::testing::HasSubstr;

const AgentId kR1 = AgentId::parse("r1").value();
const AgentId kR2 = AgentId::parse("r2").value();
const AgentId kR3 = AgentId::parse("r3").value();

std::string logged(const exchange::Event& event) {
  const CapturedLog log;
  log_event(kR1, event);
  return log.text();
}

TEST(EventLog, AConflictNamesTheItemTheLinkAndWhoHandedItOver) {
  std::string text = logged(exchange::ItemConflict{{kR2, 9}, true, messages::Reach::kShortRange, false, kR3});
  EXPECT_THAT(text, HasSubstr("error"));
  EXPECT_THAT(text, HasSubstr("another alignment came over the Wi-Fi from r3 under the name r2"));
  EXPECT_THAT(text, HasSubstr("forged"));
  text = logged(exchange::ItemConflict{{kR1, 9}, false, messages::Reach::kLongRange, true, std::nullopt});
  EXPECT_THAT(text, HasSubstr("another node came over the radio under the name r1"));
  EXPECT_THAT(text, HasSubstr("the own one is told under another name"));
  EXPECT_THAT(text, HasSubstr("revoke r1"));
}

TEST(EventLog, AnItemOfAnUnknownMakerIsAWarningAndAForgedOneAnError) {
  exchange::ItemRefused refused{
      {kR2, 9}, false, exchange::ItemProof::kUnknownMaker, messages::Reach::kLongRange, std::nullopt};
  EXPECT_THAT(logged(refused), HasSubstr("warning"));
  EXPECT_THAT(logged(refused), HasSubstr("until the certificate of r2 comes"));
  refused.proof = exchange::ItemProof::kUnsigned;
  EXPECT_THAT(logged(refused), HasSubstr("error"));
  EXPECT_THAT(logged(refused), HasSubstr("compromised"));
}

TEST(EventLog, ASenderThatMisbehavesIsNamedByTheLinkAndNotByTheMessage) {
  exchange::SenderMisbehaved event{kR2, kR3, exchange::SenderMisbehaved::Kind::kForeignName};
  EXPECT_THAT(logged(event), HasSubstr("r1: r3 sent a message of another robot under the name r2"));
  event = {kR3, kR3, exchange::SenderMisbehaved::Kind::kDigest};
  EXPECT_THAT(logged(event), HasSubstr("r3 sent a digest or a request that contradicts the rules: it is"));
  event = {kR2, std::nullopt, exchange::SenderMisbehaved::Kind::kSubmap};
  EXPECT_THAT(logged(event), HasSubstr("an unknown robot sent a submap digest or chunk"));
  EXPECT_THAT(logged(event), HasSubstr("under the name r2"));
  EXPECT_THAT(logged(event), HasSubstr("or the message is forged"));
}

TEST(EventLog, EventsThatTheAgentHandlesAreNotLogged) {
  EXPECT_EQ(logged(exchange::SessionTaken{kR2}), "");
  EXPECT_EQ(logged(exchange::CloudNeeded{{kR1, 1}, kR2}), "");
}

}  // namespace
}  // namespace fleetmap::agent
