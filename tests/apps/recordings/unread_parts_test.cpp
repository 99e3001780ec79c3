#include "recordings/unread_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(UnreadParts, AreASentenceForEachKind) {
  recording::Counters counters;
  counters.scans = 90;
  EXPECT_THAT(unread_parts(counters), IsEmpty());
  counters.damaged_parts = 1;
  counters.undecodable_messages = 3;
  EXPECT_THAT(unread_parts(counters), ElementsAre(HasSubstr("1 part of the recording is damaged or cut off"),
                                                  HasSubstr("3 messages are truncated")));
}

TEST(UnreadParts, DamageIsOfTheRecordingAndNotOfADriver) {
  recording::Counters counters;
  counters.undecodable_messages = 3;
  EXPECT_FALSE(is_damaged(counters));
  for (const auto count : {&recording::Counters::damaged_parts, &recording::Counters::unreadable_scan_files,
                           &recording::Counters::malformed_oxts_frames}) {
    recording::Counters damaged;
    damaged.*count = 1;
    EXPECT_TRUE(is_damaged(damaged));
  }
}

TEST(NoScan, NamesWhatWasLeftOut) {
  recording::Counters counters;
  EXPECT_THAT(no_scan(counters), HasSubstr("no scan: the LiDAR was off, or its topic"));
  counters.undecodable_messages = 3;
  counters.empty_scans = 2;
  EXPECT_THAT(no_scan(counters),
              HasSubstr("left out are 3 messages that cannot be decoded, 2 scans without a point"));
}

}  // namespace
}  // namespace fleetmap::apps
