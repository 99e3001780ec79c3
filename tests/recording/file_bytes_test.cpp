#include "file_bytes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "recording/compressed.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::xz;

std::string noise(std::size_t size) {
  std::mt19937 random(1);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

std::string file_error(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  return bytes ? "no error" : bytes.error().message;
}

TEST(FileBytes, AreTheContentOrWhatItUnpacksTo) {
  const TemporaryFolder folder;
  // Lengths around the step of 1 MiB in which the file is unpacked, and few enough different bytes to be
  // packed at once.
  for (const std::size_t size : {0u, 1u, (1u << 20) - 1, 1u << 20, (1u << 20) + 1}) {
    std::string text(size, '\0');
    for (std::size_t k = 0; k < size; ++k) text[k] = static_cast<char>(k / 1000 % 251);
    const Bytes expected(text.begin(), text.end());
    EXPECT_TRUE(read_file(folder.write("a.bin", text)).value() == expected) << size;
    EXPECT_TRUE(read_file(folder.write("a.bin.xz", xz(text))).value() == expected) << size;
  }
}

TEST(FileBytes, OnlyTheNameTellsThatAFileIsPacked) {
  const TemporaryFolder folder;
  const std::string packed = xz("points");
  EXPECT_EQ(read_file(folder.write("a.bin", packed)).value(), Bytes(packed.begin(), packed.end()));
  EXPECT_THAT(file_error(folder.write("a.xz", "points of a scan that nobody packed")),
              HasSubstr("a.xz: the xz file is damaged"));
}

TEST(FileBytes, PackedFilesOneBehindTheOtherAreOne) {
  const TemporaryFolder folder;
  const Bytes both = read_file(folder.write("a.xz", xz("one,") + xz("two"))).value();
  EXPECT_EQ(std::string(both.begin(), both.end()), "one,two");
}

TEST(FileBytes, DamageIsTold) {
  const TemporaryFolder folder;
  const std::string packed = xz(noise(1000));
  for (const std::size_t kept : {std::size_t{0}, std::size_t{5}, packed.size() / 2, packed.size() - 1})
    EXPECT_THAT(file_error(folder.write("a.xz", packed.substr(0, kept))),
                HasSubstr("a.xz: the xz file is truncated"));
  std::string flipped = packed;
  flipped[packed.size() / 2] ^= 1;
  EXPECT_THAT(file_error(folder.write("a.xz", flipped)), HasSubstr("a.xz: the xz file is damaged"));
  EXPECT_THAT(file_error(folder.path() / "none.bin"), HasSubstr("none.bin: cannot be read: "));
  EXPECT_THAT(file_error(folder.path()), HasSubstr(folder.path().string() + ": cannot be read"));
}

TEST(FileBytes, FileLargerThanAnyScanIsNotRead) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.bin", "");
  std::filesystem::resize_file(file, (256u << 20) + 1);  // a hole: no disk is needed
  EXPECT_THAT(file_error(file), HasSubstr("a.bin: is larger than 256 MiB"));
}

}  // namespace
}  // namespace fleetmap::recording
