#include "fleetmap/eval/png.hpp"

#include <png.h>

#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::eval {

Result<std::vector<std::uint8_t>> encode_png(const Image& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    return failure("the image has no pixels, or not as many as its size says");
  static_assert(sizeof(Rgb) == 3, "rows go to libpng as they are");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::uint8_t> bytes(size);
  const bool written =
      png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr) != 0;
  const std::string problem = png.message;
  png_image_free(&png);
  if (!written) return failure("the picture cannot be encoded: " + problem);
  bytes.resize(size);
  return bytes;
}

Status write_png(const std::filesystem::path& file, const Image& image) {
  const auto bytes = encode_png(image);
  if (!bytes) return failure(file.string() + ": " + bytes.error().message);
  return write_whole_file(file, *bytes);
}

}  // namespace fleetmap::eval
