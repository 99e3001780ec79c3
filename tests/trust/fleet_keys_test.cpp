#include "fleetmap/trust/fleet_keys.hpp"

#include <gtest/gtest.h>

namespace fleetmap::trust {
namespace {

SecretKey filled(std::uint8_t value) {
  SecretKey key{};
  key.fill(value);
  return key;
}

const std::string kDigits = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

TEST(FleetKeys, EachEpochAddsAKeyAndKeepsTheOlderOnes) {
  const FleetKeys first = with_new_epoch({});
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first.begin()->first, 1);
  EXPECT_NE(first.at(1), SecretKey());
  const FleetKeys second = with_new_epoch(first);
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second.at(1), first.at(1));
  EXPECT_NE(second.at(2), first.at(1));
  EXPECT_EQ(with_new_epoch({{7, filled(1)}}).rbegin()->first, 8) << "older ones may be gone";
}

TEST(FleetKeys, AreALineEach) {
  EXPECT_EQ(to_text({{2, filled(0xa0)}, {300, filled(0x0f)}}),
            "# Keys that all members of the fleet share: epoch, key. Secret: mode 0600.\n2 " +
                std::string("a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0a0\n300 ") +
                "0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f\n");
}

TEST(FleetKeys, CommentsAndEmptyLinesAreNone) {
  const auto keys = parse_fleet_keys("# first\n\n65535 " + kDigits + "\n#2 " + kDigits + "\n3 " + kDigits);
  ASSERT_TRUE(keys) << keys.error().message;
  ASSERT_EQ(keys->size(), 2u);
  EXPECT_EQ(keys->at(3), keys->at(65535));
  EXPECT_EQ(keys->at(3)[1], 0x23);
  EXPECT_EQ(keys->at(3)[7], 0xef);
}

TEST(FleetKeys, TheWrongLineIsNamed) {
  const std::string good = "1 " + kDigits + "\n";
  for (const std::string& bad :
       {kDigits, "1" + kDigits, "0 " + kDigits, "-1 " + kDigits, "65536 " + kDigits, "1x " + kDigits,
        " " + kDigits, "2  " + kDigits, "2 " + kDigits + " ", "2 " + kDigits + "\r", "2 " + kDigits.substr(2),
        "2 +" + kDigits.substr(1), "2 0x" + kDigits.substr(2), std::string("2 "), std::string("2")}) {
    const auto keys = parse_fleet_keys("# comment\n" + good + bad + "\n");
    ASSERT_FALSE(keys) << bad;
    EXPECT_EQ(keys.error().message, "line 3 is no epoch and key") << bad;
  }
  EXPECT_EQ(parse_fleet_keys("# none\n\n").error().message, "holds no key");
}

}  // namespace
}  // namespace fleetmap::trust
