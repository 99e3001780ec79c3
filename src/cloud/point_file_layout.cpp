#include "point_file_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace fleetmap::cloud {
namespace {

using Words = std::vector<std::string_view>;
constexpr std::size_t kMaxLine = 65536;

/// Words of the next line; nothing at the end of the file. Advances `at` past the line.
std::optional<Words> next_line(std::string_view file, std::size_t& at) {
  const std::size_t end = file.find('\n', at);
  if (end == std::string_view::npos || end - at > kMaxLine) return std::nullopt;
  const std::string_view line = file.substr(at, end - at);
  at = end + 1;
  Words words;
  for (std::size_t i = line.find_first_not_of(" \t\r"); i != std::string_view::npos;) {
    const std::size_t stop = std::min(line.find_first_of(" \t\r", i), line.size());
    words.push_back(line.substr(i, stop - i));
    i = line.find_first_not_of(" \t\r", stop);
  }
  return words;
}

std::optional<std::size_t> number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value > 0x7fffffffu) return std::nullopt;
  return value;
}

std::optional<NumberType> pcd_type(std::string_view type, std::string_view size) {
  static const std::map<std::pair<std::string_view, std::string_view>, NumberType> kTypes{
      {{"I", "1"}, NumberType::i8},  {{"U", "1"}, NumberType::u8},  {{"I", "2"}, NumberType::i16},
      {{"U", "2"}, NumberType::u16}, {{"I", "4"}, NumberType::i32}, {{"U", "4"}, NumberType::u32},
      {{"I", "8"}, NumberType::i64}, {{"U", "8"}, NumberType::u64}, {{"F", "4"}, NumberType::f32},
      {{"F", "8"}, NumberType::f64}};
  const auto found = kTypes.find({type, size});
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

std::optional<NumberType> ply_type(std::string_view type) {
  static const std::map<std::string_view, NumberType> kTypes{
      {"char", NumberType::i8},    {"int8", NumberType::i8},     {"uchar", NumberType::u8},
      {"uint8", NumberType::u8},   {"short", NumberType::i16},   {"int16", NumberType::i16},
      {"ushort", NumberType::u16}, {"uint16", NumberType::u16},  {"int", NumberType::i32},
      {"int32", NumberType::i32},  {"uint", NumberType::u32},    {"uint32", NumberType::u32},
      {"float", NumberType::f32},  {"float32", NumberType::f32}, {"double", NumberType::f64},
      {"float64", NumberType::f64}};
  const auto found = kTypes.find(type);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

void add_field(PointFileLayout& layout, std::string_view name, NumberType type, std::size_t count) {
  layout.fields.push_back({std::string(name), type, count, layout.stride});
  layout.stride += count * (layout.encoding == PointFileLayout::Encoding::ascii ? 1 : size_of(type));
}

Status check_room(const PointFileLayout& layout, std::size_t file_size) {
  const std::size_t room = file_size - layout.body;
  // A number in ascii takes a digit and a separator; the last may lack its separator.
  const std::size_t each = layout.stride * (layout.encoding == PointFileLayout::Encoding::ascii ? 2 : 1);
  if (layout.encoding == PointFileLayout::Encoding::compressed || layout.points * each <= room + 1) return {};
  return failure("truncated: the header promises " + std::to_string(layout.points) + " points, " +
                 std::to_string(room) + " bytes are there");
}

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::i8:
    case NumberType::u8:
      return 1;
    case NumberType::i16:
    case NumberType::u16:
      return 2;
    case NumberType::i32:
    case NumberType::u32:
    case NumberType::f32:
      return 4;
    default:
      return 8;
  }
}

Result<PointFileLayout> pcd_layout(std::string_view file) {
  PointFileLayout layout;
  std::map<std::string_view, Words> entries;
  while (!entries.contains("DATA")) {
    const auto line = next_line(file, layout.body);
    if (!line) return failure("not a PCD file: its header has no DATA line");
    if (line->empty() || line->front().starts_with('#')) continue;
    entries.try_emplace(line->front(), line->begin() + 1, line->end());
  }
  static const std::map<std::string_view, PointFileLayout::Encoding> kEncodings{
      {"ascii", PointFileLayout::Encoding::ascii},
      {"binary", PointFileLayout::Encoding::little_endian},
      {"binary_compressed", PointFileLayout::Encoding::compressed}};
  const auto encoding = entries["DATA"].empty() ? kEncodings.end() : kEncodings.find(entries["DATA"][0]);
  const auto count_of = [&](std::string_view key) {
    return entries[key].size() == 1 ? number(entries[key][0]) : std::nullopt;
  };
  const auto width = count_of("WIDTH");
  const auto height = count_of("HEIGHT");
  const Words& names = entries["FIELDS"];
  Words counts = entries["COUNT"];
  if (counts.empty()) counts.assign(names.size(), "1");
  if (encoding == kEncodings.end() || !width || !height || entries["SIZE"].size() != names.size() ||
      entries["TYPE"].size() != names.size() || counts.size() != names.size() || names.empty()) {
    return failure("malformed PCD header");
  }
  layout.encoding = encoding->second;
  layout.points = *width * *height;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto type = pcd_type(entries["TYPE"][i], entries["SIZE"][i]);
    const auto count = number(counts[i]);
    if (!type || !count || *count == 0 || *count > 4096)
      return failure("malformed PCD header: field " + std::string(names[i]));
    add_field(layout, names[i], *type, *count);
  }
  if (layout.points > 0x7fffffffu) return failure("malformed PCD header: too many points");
  if (auto room = check_room(layout, file.size()); !room) return failure(room.error().message);
  return layout;
}

Result<PointFileLayout> ply_layout(std::string_view file) {
  PointFileLayout layout;
  auto line = next_line(file, layout.body);
  if (!line || *line != Words{"ply"}) return failure("not a PLY file");
  static const std::map<std::string_view, PointFileLayout::Encoding> kEncodings{
      {"ascii", PointFileLayout::Encoding::ascii},
      {"binary_little_endian", PointFileLayout::Encoding::little_endian},
      {"binary_big_endian", PointFileLayout::Encoding::big_endian}};
  bool has_format = false;
  int elements = 0;  // points are the first; what follows them is of no interest
  while ((line = next_line(file, layout.body)) && *line != Words{"end_header"}) {
    const Words& words = *line;
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format" && words.size() == 3 && kEncodings.contains(words[1])) {
      layout.encoding = kEncodings.at(words[1]);
      has_format = true;
    } else if (words[0] == "element" && words.size() == 3 && has_format) {
      const auto count = number(words[2]);
      if (!count) return failure("malformed PLY header: element count");
      if (++elements == 1 && words[1] != "vertex")
        return failure("PLY files whose first element is not vertex are not supported");
      if (elements == 1) layout.points = *count;
    } else if (words[0] == "property" && elements > 1) {
      continue;
    } else if (words[0] == "property" && elements == 1 && words.size() == 3 && ply_type(words[1])) {
      add_field(layout, words[2], *ply_type(words[1]), 1);
    } else {
      return failure("malformed or unsupported PLY header: " + std::string(words[0].substr(0, 40)));
    }
  }
  if (!line || elements == 0) return failure("malformed PLY header: no vertices or no end_header");
  if (auto room = check_room(layout, file.size()); !room) return failure(room.error().message);
  return layout;
}

}  // namespace fleetmap::cloud
