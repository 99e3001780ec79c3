#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/mesh.hpp"

namespace fleetmap::sim {

inline tl::unexpected<Error> failure_at_line(std::size_t line, const std::string& what) {
  std::string where = ":";
  where += std::to_string(line);
  return failure(where.append(": ").append(what));
}
inline tl::unexpected<Error> failure_at_byte(std::size_t byte, const std::string& what) {
  std::string where = ": byte ";
  where += std::to_string(byte);
  return failure(where.append(": ").append(what));
}

/// Quotes a file's content for a message: at most 40 characters.
inline std::string in_quotes(std::string_view text) {
  std::string result = "'";
  return result.append(text.substr(0, 40)).append("'");
}

/// The lines of a text, without their ends, counted from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Cuts the next word off the front of `line`; empty at its end.
inline std::string_view next_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos) {
    line = {};
    return {};
  }
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(word.size());
  return word;
}

/// The whole word as a number.
template <class T>
std::optional<T> number_from(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// A coordinate that float32 holds to better than a centimetre.
inline bool is_coordinate(double value) { return std::isfinite(value) && std::abs(value) <= 1e5; }
inline constexpr const char* kCoordinateRule =
    "a coordinate is not a number within 100 km of the origin; give the mesh in metres of the site's local "
    "frame (east, north, up)";

/// The polygon as a fan around its first corner.
inline void add_fan(Mesh& mesh, std::uint32_t first, std::uint32_t previous, std::uint32_t corner,
                    Material material) {
  mesh.triangles.push_back({first, previous, corner});
  mesh.materials.push_back(material);
}

}  // namespace fleetmap::sim
