#include "sim/embree_functions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

TEST(EmbreeFunctions, AreFoundInTheLibraryOfDebian) {
  const auto embree = load_embree();
  ASSERT_TRUE(embree) << embree.error().message;
  const RTCDevice device = embree->new_device("threads=1");
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(embree->device_error(device), RTC_ERROR_NONE);
  embree->release_device(device);
}

TEST(EmbreeFunctions, ALibraryThatIsMissingNamesThePackageThatBringsIt) {
  const auto none = load_embree("libembree0.so.0");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("libembree0.so.0"));
  EXPECT_THAT(none.error().message, HasSubstr("fleetmap-twin"));
}

TEST(EmbreeFunctions, AnotherLibraryIsRefusedByTheFunctionThatItLacks) {
  const auto other = load_embree("libm.so.6");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("libm.so.6 lacks rtcNewDevice"));
}

}  // namespace
}  // namespace fleetmap::sim
