#include "fleetmap/core/file_uri.hpp"

#include <cstdint>

#include "fleetmap/core/paths.hpp"

namespace fleetmap {

std::string file_uri(const std::filesystem::path& file, const std::string& query) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  // An empty authority, because a path that begins with two slashes would be taken for a host.
  std::string uri = "file://";
  for (const char c : absolute_path(file).string()) {
    if (c == '%' || c == '?' || c == '#') {
      const auto octet = static_cast<std::uint8_t>(c);
      uri += {'%', kDigits[octet >> 4], kDigits[octet & 0xf]};
    } else {
      uri += c;
    }
  }
  return uri + query;
}

}  // namespace fleetmap
