#include "fleetmap/trust/fleet_keys.hpp"

#include <charconv>
#include <sstream>

#include "openssl.hpp"

namespace fleetmap::trust {
namespace {

constexpr char kDigits[] = "0123456789abcdef";

bool parse_key(const std::string& text, SecretKey& key) {
  if (text.size() != 2 * key.size()) return false;
  for (std::size_t k = 0; k < key.size(); ++k) {
    const char* first = text.data() + 2 * k;
    const auto [end, error] = std::from_chars(first, first + 2, key[k], 16);
    if (error != std::errc{} || end != first + 2) return false;
  }
  return true;
}

}  // namespace

FleetKeys with_new_epoch(FleetKeys keys) {
  SecretKey key{};
  fill_random(key);
  keys.emplace(static_cast<std::uint16_t>(keys.empty() ? 1 : keys.rbegin()->first + 1), key);
  return keys;
}

std::string to_text(const FleetKeys& keys) {
  std::string text = "# Keys that all members of the fleet share: epoch, key. Secret: mode 0600.\n";
  for (const auto& [epoch, key] : keys) {
    text += std::to_string(epoch) + ' ';
    for (const std::uint8_t byte : key) {
      text += kDigits[byte >> 4];
      text += kDigits[byte & 0xf];
    }
    text += '\n';
  }
  return text;
}

Result<FleetKeys> parse_fleet_keys(const std::string& text) {
  FleetKeys keys;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    const std::string wrong = "line " + std::to_string(number) + " is no epoch and key";
    const std::size_t space = line.find(' ');
    std::uint16_t epoch = 0;
    const char* end_of_epoch = line.data() + std::min(space, line.size());
    const auto [end, error] = std::from_chars(line.data(), end_of_epoch, epoch);
    SecretKey key{};
    if (space == std::string::npos || error != std::errc{} || end != end_of_epoch || epoch == 0 ||
        !parse_key(line.substr(space + 1), key))
      return failure(wrong);
    keys[epoch] = key;
  }
  if (keys.empty()) return failure("holds no key");
  return keys;
}

}  // namespace fleetmap::trust
