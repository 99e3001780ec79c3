#include "validators.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

/// The error of a validator for this text; empty if it accepts it.
std::string error_of(const CLI::Validator& validator, std::string text) { return validator(text); }

TEST(Validators, WholeNumbersAreDigitsWithinTheirRange) {
  const CLI::Validator port = whole_number(1, 65535), many = whole_number(3);
  for (const char* good : {"1", "80", "65535"}) EXPECT_EQ(error_of(port, good), "") << good;
  for (const char* bad :
       {"0", "65536", "-1", "+1", "1.0", "0x10", "08", "", " 1", "1 ", "99999999999999999999"})
    EXPECT_THAT(error_of(port, bad), HasSubstr("must be a whole number from 1 to 65535, is ")) << bad;
  EXPECT_EQ(error_of(many, "18446744073709551615"), "");
  EXPECT_THAT(error_of(many, "2"), HasSubstr("of at least 3, is 2"));
}

TEST(Validators, NumbersAreFinite) {
  const CLI::Validator positive = positive_number(), non_negative = non_negative_number();
  for (const char* good : {"1e-9", "0.5", "1e9"}) {
    EXPECT_EQ(error_of(positive, good), "") << good;
    EXPECT_EQ(error_of(non_negative, good), "") << good;
  }
  EXPECT_NE(error_of(positive, "0"), "");
  EXPECT_EQ(error_of(non_negative, "0"), "");
  for (const char* bad : {"-1", "nan", "inf", "1e999", "", "1s", "one"}) {
    EXPECT_NE(error_of(positive, bad), "") << bad;
    EXPECT_NE(error_of(non_negative, bad), "") << bad;
  }
}

TEST(Validators, NumbersWithinARangeAreThoseAtItsEndsToo) {
  const CLI::Validator cell = number_within(0.05, 1000.0);
  for (const char* good : {"0.05", "1", "1e3"}) EXPECT_EQ(error_of(cell, good), "") << good;
  for (const char* bad : {"0", "0.0499", "-1", "1001", "nan", "", "1 m"})
    EXPECT_EQ(error_of(cell, bad), std::string("must be a number from 0.05 to 1000, is ") + bad);
}

TEST(Validators, AnEmptyPathIsMostLikelyAnUnsetVariable) {
  EXPECT_EQ(error_of(some_path(), "."), "");
  EXPECT_THAT(error_of(some_path(), ""), HasSubstr("is a variable unset?"));
}

}  // namespace
}  // namespace fleetmap::apps
