#include "fleetmap/sensor/ouster_profile.hpp"

#include <gmock/gmock.h>

namespace fleetmap::sensor {
namespace {

using ::testing::HasSubstr;

/// Bytes of a packet of 128 beams and 16 columns, as the manual lists them.
TEST(OusterProfile, PacketsAreAsLargeAsTheManualStates) {
  EXPECT_EQ(ouster_profile("LEGACY")->packet_bytes(16, 128), 24'896u);
  EXPECT_EQ(ouster_profile("LEGACY")->packet_bytes(16, 64), 12'608u);
  EXPECT_EQ(ouster_profile("LEGACY")->packet_bytes(16, 32), 6'464u);
  EXPECT_EQ(ouster_profile("RNG19_RFL8_SIG16_NIR16_DUAL")->packet_bytes(16, 128), 33'024u);
  EXPECT_EQ(ouster_profile("RNG19_RFL8_SIG16_NIR16")->packet_bytes(16, 128), 24'832u);
  EXPECT_EQ(ouster_profile("RNG15_RFL8_NIR8")->packet_bytes(16, 128), 8'448u);
  EXPECT_EQ(ouster_profile("FUSA_RNG15_RFL8_NIR8_DUAL")->packet_bytes(16, 128), 16'640u);
}

TEST(OusterProfile, RangesHaveTheBitsOfTheirFormat) {
  const Bytes ones(16, 0xff);
  EXPECT_EQ(ouster_profile("LEGACY")->last_return(ones).range, 0xfffffu);
  EXPECT_EQ(ouster_profile("RNG19_RFL8_SIG16_NIR16")->last_return(ones).range, 0x7ffffu);
  EXPECT_EQ(ouster_profile("RNG15_RFL8_NIR8")->last_return(ones).range, 0x7fffu * 8);
  const Bytes low_rate{0x10, 0x80, 77, 0xff};
  EXPECT_EQ(ouster_profile("RNG15_RFL8_NIR8")->last_return(low_rate).range, 0x10u * 8);
  EXPECT_EQ(ouster_profile("RNG15_RFL8_NIR8")->last_return(low_rate).reflectivity, 77);
}

TEST(OusterProfile, OfTwoReturnsTheFartherOneIsUsed) {
  const OusterProfile dual = *ouster_profile("RNG19_RFL8_SIG16_NIR16_DUAL");
  Bytes pixel{0x10, 0x27, 0, 11, 0x20, 0x4e, 0, 22, 0, 0, 0, 0, 0, 0, 0, 0};  // 10 m and 20 m
  EXPECT_EQ(dual.last_return(pixel).range, 20'000u);
  EXPECT_EQ(dual.last_return(pixel).reflectivity, 22);
  pixel[4] = pixel[5] = 0;
  EXPECT_EQ(dual.last_return(pixel).range, 10'000u) << "there is no second one";
  EXPECT_EQ(dual.last_return(pixel).reflectivity, 11);
}

TEST(OusterProfile, OthersAreUnknown) {
  EXPECT_FALSE(ouster_profile("FIVE_WORD_PIXEL"));
  EXPECT_THAT(ouster_profile_names(), HasSubstr("LEGACY, RNG19_RFL8_SIG16_NIR16, "));
}

}  // namespace
}  // namespace fleetmap::sensor
