#include "preview_file.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <tuple>
#include <utility>

#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::monitor {
namespace {

/// To be raised when previews of the same submap become others.
constexpr std::string_view kMagic = "FMPREV1\n";
constexpr std::size_t kNameDigits = 2 * std::tuple_size_v<ContentHash>;
static_assert(kPreviewHeaderBytes == kMagic.size() + std::tuple_size_v<ContentHash>);
constexpr std::uintmax_t kMaxBytes = 1u << 30;

}  // namespace

Bytes encoded_previews(const Previews& previews) {
  Bytes parts;
  for (const auto& [hash, cloud] : previews) {
    const Bytes points = encoded_points(*cloud, 0, cloud->size());
    parts.insert(parts.end(), hash.begin(), hash.end());
    parts.insert(parts.end(), points.begin(), points.end());
  }
  const ContentHash print = content_hash(parts);
  Bytes bytes(kMagic.begin(), kMagic.end());
  bytes.reserve(kPreviewHeaderBytes + parts.size());
  bytes.insert(bytes.end(), print.begin(), print.end());
  bytes.insert(bytes.end(), parts.begin(), parts.end());
  return bytes;
}

Previews decoded_previews(ByteView bytes) {
  if (bytes.size() < kPreviewHeaderBytes || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    return {};
  ByteView rest = bytes.subspan(kPreviewHeaderBytes);
  const ContentHash print = content_hash(rest);
  if (!std::equal(print.begin(), print.end(), bytes.begin() + kMagic.size())) return {};
  Previews previews;
  while (!rest.empty()) {
    if (rest.size() < kNameDigits) return {};
    const std::string hash(rest.begin(), rest.begin() + kNameDigits);
    rest = rest.subspan(kNameDigits);
    auto cloud = decoded_points(rest);
    if (!cloud) return {};
    rest = rest.subspan(kPointHeaderBytes + cloud->values.size() * sizeof(std::int16_t));
    previews[hash] = std::make_shared<const QuantisedCloud>(std::move(*cloud));
  }
  return previews;
}

Previews read_previews(const std::filesystem::path& file) {
  std::error_code missing;
  const auto size = std::filesystem::file_size(file, missing);
  if (missing || size > kMaxBytes) return {};
  Bytes bytes(size);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) return {};
  return decoded_previews(bytes);
}

Status write_previews(const std::filesystem::path& file, const Previews& previews) {
  return write_whole_file(file, encoded_previews(previews));
}

}  // namespace fleetmap::monitor
