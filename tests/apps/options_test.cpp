#include "options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

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
