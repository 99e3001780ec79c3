#include "fleetmap/eval/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>

#include "support/temporary_folder.hpp"

namespace fleetmap::eval {
namespace {

Image decoded(const std::vector<std::uint8_t>& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0);
  png.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.pixels.resize(png.width * png.height);
  EXPECT_NE(png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr), 0);
  return image;
}

TEST(Png, AnImageIsReadUnchanged) {
  Image image{67, 31, {}};
  for (int k = 0; k < 67 * 31; ++k) {
    image.pixels.push_back(
        {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k / 7), static_cast<std::uint8_t>(k * k)});
  }
  const auto bytes = encode_png(image);
  ASSERT_TRUE(bytes);
  const Image read = decoded(*bytes);
  EXPECT_EQ(read.width, 67);
  EXPECT_EQ(read.pixels, image.pixels);
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "a.png", image));
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "a.png"), bytes->size());
  EXPECT_FALSE(write_png(folder.path() / "none" / "a.png", image));
  EXPECT_FALSE(encode_png({}));
  EXPECT_FALSE(encode_png({5, 5, {}}));
}

}  // namespace
}  // namespace fleetmap::eval
