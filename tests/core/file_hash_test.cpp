#include "fleetmap/core/file_hash.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

TEST(FileHash, IsTheHashOfItsBytes) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(1);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{5}, std::size_t{1} << 20, std::size_t{2'500'000}}) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const auto hash = file_hash(folder.write("file", bytes));
    ASSERT_TRUE(hash) << hash.error().message;
    EXPECT_EQ(*hash, content_hash(Bytes(bytes.begin(), bytes.end()))) << size;
  }
}

TEST(FileHash, OfAFileThatCannotBeReadIsAnErrorThatNamesIt) {
  const testing::TemporaryFolder folder;
  EXPECT_THAT(file_hash(folder.path() / "none").error().message, ::testing::HasSubstr("none"));
  EXPECT_THAT(file_hash(folder.path()).error().message, ::testing::HasSubstr(folder.path().string()));
}

}  // namespace
}  // namespace fleetmap
