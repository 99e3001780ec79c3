#include "fleetmap/cloud/file_io.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "fleetmap/cloud/cloud_writer.hpp"
#include "point_file_format.hpp"
#include "point_file_layout.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;
using Encoding = PointFileLayout::Encoding;
using Field = PointFileLayout::Field;
static_assert(std::endian::native == std::endian::little, "files are read in the machine's byte order");

Result<std::string> whole_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return failure("no such file");
  std::ifstream in(file, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(fs::file_size(file, error)), '\0');
  if (error || !in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    return failure("cannot be read");
  return bytes;
}

/// A file mapped into memory, which the system loads as it is read and drops again.
class MappedFile {
 public:
  static Result<MappedFile> open(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return failure("no such file");
    const std::size_t size = fs::file_size(file, error);
    const int descriptor = error || size == 0 ? -1 : ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    void* data = descriptor < 0 ? MAP_FAILED : ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (descriptor >= 0) ::close(descriptor);
    if (data == MAP_FAILED) return failure("cannot be read");
    ::madvise(data, size, MADV_SEQUENTIAL);
    return MappedFile(std::string_view(static_cast<const char*>(data), size));
  }
  MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
  }
  std::string_view bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::string_view bytes) : bytes_(bytes) {}
  std::string_view bytes_;
};

float number_at(const char* raw, NumberType type, bool swap) {
  const auto as = [raw, swap](auto value) {
    std::array<char, sizeof value> bytes{};
    std::copy_n(raw, bytes.size(), bytes.begin());
    if (swap) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), bytes.size());
    return static_cast<float>(value);
  };
  switch (type) {
    case NumberType::i8:
      return as(std::int8_t{});
    case NumberType::u8:
      return as(std::uint8_t{});
    case NumberType::i16:
      return as(std::int16_t{});
    case NumberType::u16:
      return as(std::uint16_t{});
    case NumberType::i32:
      return as(std::int32_t{});
    case NumberType::u32:
      return as(std::uint32_t{});
    case NumberType::i64:
      return as(std::int64_t{});
    case NumberType::u64:
      return as(std::uint64_t{});
    case NumberType::f32:
      return as(float{});
    case NumberType::f64:
      return as(double{});
  }
  return 0.0f;
}

std::size_t step_of(std::size_t points, std::size_t max_points) {
  return std::max<std::size_t>(1, (points + max_points - 1) / std::max<std::size_t>(1, max_points));
}

/// The fields that make a cloud.
struct Wanted {
  std::array<const Field*, 3> xyz{};
  const Field* intensity = nullptr;
};

Result<Wanted> wanted_fields(const PointFileLayout& layout) {
  const auto named = [&](std::string_view name) -> const Field* {
    const auto found = std::find_if(layout.fields.begin(), layout.fields.end(), [&](const Field& field) {
      return field.name == name && field.count == 1;
    });
    return found == layout.fields.end() ? nullptr : &*found;
  };
  Wanted wanted{{named("x"), named("y"), named("z")}, named("intensity")};
  for (const char* name : {"scalar_intensity", "scalar_Intensity"}) {  // CloudCompare's
    if (wanted.intensity == nullptr) wanted.intensity = named(name);
  }
  if (std::count(wanted.xyz.begin(), wanted.xyz.end(), nullptr) > 0) return failure("has no fields x, y, z");
  return wanted;
}

/// Every `step`-th point. `get(point, field)` returns a number and handles column order (compressed PCD) or
/// row order.
template <class Get>
PointCloud gather(const PointFileLayout& layout, const Wanted& wanted, Get get, std::size_t step = 1) {
  PointCloud cloud;
  cloud.points.reserve(layout.points / step + 1);
  for (std::size_t i = 0; i < layout.points; i += step) {
    cloud.points.emplace_back(get(i, *wanted.xyz[0]), get(i, *wanted.xyz[1]), get(i, *wanted.xyz[2]));
    if (wanted.intensity != nullptr) cloud.intensities.push_back(get(i, *wanted.intensity));
  }
  return cloud;
}

Result<PointCloud> from_ascii(const std::string& file, const PointFileLayout& layout, const Wanted& wanted) {
  std::vector<float> numbers;
  numbers.reserve(layout.points * layout.stride);
  const char* at = file.c_str() + layout.body;
  while (numbers.size() < layout.points * layout.stride) {
    char* end = nullptr;
    numbers.push_back(std::strtof(at, &end));
    if (end == at)
      return failure("damaged or truncated after " + std::to_string(numbers.size() / layout.stride) +
                     " points");
    at = end;
  }
  return gather(layout, wanted,
                [&](std::size_t i, const Field& field) { return numbers[i * layout.stride + field.offset]; });
}

/// LZF as in compressed PCD files: fills exactly `size` bytes, or fails.
std::optional<std::string> lzf_decompressed(std::string_view in, std::size_t size) {
  std::string out;
  std::size_t at = 0;
  const auto byte = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(in[at++])); };
  while (at < in.size()) {
    const std::size_t control = byte();
    if (control < 32) {
      const std::size_t length = control + 1;
      if (at + length > in.size() || out.size() + length > size) return std::nullopt;
      out.append(in.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7 && at < in.size()) length += byte();
    if (at >= in.size()) return std::nullopt;
    const std::size_t back = ((control & 31u) << 8) + byte() + 1;
    length += 2;
    if (back > out.size() || out.size() + length > size) return std::nullopt;
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
  }
  return out.size() == size ? std::optional(std::move(out)) : std::nullopt;
}

Result<PointCloud> from_compressed(const std::string& file, const PointFileLayout& layout,
                                   const Wanted& wanted) {
  std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
  if (file.size() - layout.body < sizeof sizes) return failure("truncated");
  std::memcpy(sizes.data(), file.data() + layout.body, sizeof sizes);
  const std::string_view packed = std::string_view(file).substr(layout.body + sizeof sizes);
  // LZF makes at most 264 bytes of 3.
  if (sizes[0] > packed.size() || sizes[1] != layout.points * layout.stride || sizes[1] / 88 > sizes[0]) {
    return failure("truncated or damaged");
  }
  const auto columns = lzf_decompressed(packed.substr(0, sizes[0]), sizes[1]);
  if (!columns) return failure("damaged");
  return gather(layout, wanted, [&](std::size_t i, const Field& field) {
    return number_at(columns->data() + field.offset * layout.points + i * size_of(field.type), field.type,
                     false);
  });
}

Result<PointFileLayout> layout_of(std::string_view file, PointFileFormat format) {
  return format == PointFileFormat::ply ? ply_layout(file) : pcd_layout(file);
}

Result<PointCloud> from_binary(std::string_view file, const PointFileLayout& layout, const Wanted& wanted,
                               std::size_t step = 1) {
  if (layout.points * layout.stride > file.size() - layout.body) return failure("truncated");
  const bool swap = layout.encoding == Encoding::big_endian;
  const auto get = [&](std::size_t i, const Field& field) {
    return number_at(file.data() + layout.body + i * layout.stride + field.offset, field.type, swap);
  };
  return gather(layout, wanted, get, step);
}

Result<PointCloud> parse(const std::string& file, PointFileFormat format) {
  const auto layout = layout_of(file, format);
  if (!layout) return failure(layout.error().message);
  const auto wanted = wanted_fields(*layout);
  if (!wanted) return failure(wanted.error().message);
  if (layout->encoding == Encoding::ascii) return from_ascii(file, *layout, *wanted);
  if (layout->encoding == Encoding::compressed) return from_compressed(file, *layout, *wanted);
  return from_binary(file, *layout, *wanted);
}

/// Reads a binary file thinned to `max_points`; nullopt for files of another encoding.
Result<std::optional<ThinnedCloud>> mapped(const fs::path& path, std::size_t max_points) {
  const auto format = format_of(path);
  if (!format) return failure(format.error().message);
  const auto file = MappedFile::open(path);
  if (!file) return failure(file.error().message);
  const auto layout = layout_of(file->bytes(), *format);
  if (!layout) return failure(layout.error().message);
  if (layout->encoding == Encoding::ascii || layout->encoding == Encoding::compressed)
    return std::optional<ThinnedCloud>();
  const auto wanted = wanted_fields(*layout);
  if (!wanted) return failure(wanted.error().message);
  auto cloud = from_binary(file->bytes(), *layout, *wanted, step_of(layout->points, max_points));
  if (!cloud) return failure(cloud.error().message);
  return std::optional(ThinnedCloud{std::move(*cloud), layout->points});
}

PointCloud thinned(const PointCloud& cloud, std::size_t step) {
  PointCloud kept;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    kept.points.push_back(cloud.points[i]);
    if (cloud.has_intensities()) kept.intensities.push_back(cloud.intensities[i]);
  }
  return kept;
}

}  // namespace

Result<PointCloud> read_cloud(const fs::path& file) {
  const auto read = [&]() -> Result<PointCloud> {
    const auto format = format_of(file);
    if (!format) return failure(format.error().message);
    const auto bytes = whole_file(file);
    if (!bytes) return failure(bytes.error().message);
    return parse(*bytes, *format);
  };
  auto cloud = read();
  if (!cloud) return failure(file.string() + ": " + cloud.error().message);
  return cloud;
}

Result<ThinnedCloud> read_thinned_cloud(const fs::path& file, std::size_t max_points) {
  auto binary = mapped(file, max_points);
  if (!binary) return failure(file.string() + ": " + binary.error().message);
  if (*binary) return std::move(**binary);
  auto cloud = read_cloud(file);
  if (!cloud) return tl::unexpected(cloud.error());
  return ThinnedCloud{thinned(*cloud, step_of(cloud->size(), max_points)), cloud->size()};
}

Status write_cloud(const fs::path& file, const PointCloud& cloud) {
  auto writer = CloudWriter::create(file, cloud.has_intensities());
  if (!writer) return tl::unexpected(writer.error());
  if (const Status added = writer->add(cloud); !added) return added;
  return writer->finish();
}

}  // namespace fleetmap::cloud
