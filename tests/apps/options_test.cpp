#include "options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

/// The error of a validator for this text; empty if it accepts it.
std::string error_of(const CLI::Validator& validator, std::string text) { return validator(text); }

TEST(Options, WholeNumbersAreDigitsWithinTheirRange) {
  const CLI::Validator port = whole_number(1, 65535), many = whole_number(3);
  for (const char* good : {"1", "80", "65535"}) EXPECT_EQ(error_of(port, good), "") << good;
  for (const char* bad :
       {"0", "65536", "-1", "+1", "1.0", "0x10", "08", "", " 1", "1 ", "99999999999999999999"})
    EXPECT_THAT(error_of(port, bad), HasSubstr("must be a whole number from 1 to 65535, is ")) << bad;
  EXPECT_EQ(error_of(many, "18446744073709551615"), "");
  EXPECT_THAT(error_of(many, "2"), HasSubstr("of at least 3, is 2"));
}

TEST(Options, NumbersAreFinite) {
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

TEST(Options, AnEmptyPathIsMostLikelyAnUnsetVariable) {
  EXPECT_EQ(error_of(some_path(), "."), "");
  EXPECT_THAT(error_of(some_path(), ""), HasSubstr("is a variable unset?"));
}

TEST(Options, OverridesAreParsedInTheirOrder) {
  const auto parsed = parse_overrides({"a.b=1", "a.b=[2, 3]"});
  ASSERT_TRUE(parsed) << parsed.error().message;
  ASSERT_EQ(parsed->size(), 2u);
  EXPECT_EQ((*parsed)[0].key, "a.b");
  EXPECT_EQ((*parsed)[0].value, "1");
  EXPECT_EQ((*parsed)[1].value, "[2, 3]");
  const auto wrong = parse_overrides({"a=1", "nonsense"});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("nonsense"));
}

TEST(Options, AFolderForResultsIsMadeAndChecked) {
  const testing::TemporaryFolder folder;
  const auto wanted = folder.path() / "a/b";
  EXPECT_FALSE(check_writable(wanted));
  EXPECT_TRUE(make_writable(wanted));
  EXPECT_TRUE(check_writable(wanted));
  EXPECT_TRUE(make_writable(wanted)) << "it is there already";
  folder.write("file", "");
  EXPECT_THAT(check_writable(folder.path() / "file").error().message, HasSubstr("is no folder"));
  EXPECT_THAT(make_writable(folder.path() / "file/below").error().message, HasSubstr("cannot be made"));
}

TEST(Options, ASignalAsksForTheEnd) {
  const std::atomic<bool>& stop = stop_on_signals();
  EXPECT_FALSE(stop);
  std::raise(SIGTERM);
  EXPECT_TRUE(stop);
}

}  // namespace
}  // namespace fleetmap::apps
