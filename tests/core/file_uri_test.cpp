#include "fleetmap/core/file_uri.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(FileUri, SignsThatAreOfAUriAreEscapedAndTheQueryIsNot) {
  EXPECT_EQ(file_uri("/run/r 1/store.db", "?immutable=1"), "file:///run/r 1/store.db?immutable=1");
  EXPECT_EQ(file_uri("/a%20b?c#d.db", ""), "file:///a%2520b%3Fc%23d.db");
}

TEST(FileUri, IsAbsoluteAndHasNoHost) {
  EXPECT_EQ(file_uri("store.db", ""), file_uri(std::filesystem::current_path() / "store.db", ""));
  EXPECT_EQ(file_uri("//media/store.db", ""), "file:////media/store.db");
}

}  // namespace
}  // namespace fleetmap
