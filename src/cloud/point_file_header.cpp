#include "point_file_header.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fleetmap::cloud {
namespace {

constexpr std::size_t kMaxHeaderBytes = 65536;
constexpr std::uint64_t kMaxPoints = std::numeric_limits<std::int32_t>::max();

struct Opened {
  std::ifstream stream;
  std::uint64_t size = 0;
};

Result<Opened> open(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return failure("no such file");
  const std::uint64_t size = std::filesystem::file_size(file, error);
  Opened opened{std::ifstream(file, std::ios::binary), size};
  if (error || !opened.stream) return failure("cannot be opened");
  return opened;
}

/// Words of the next header line; empty at the end of the header's allowance.
std::optional<std::vector<std::string>> next_line(std::ifstream& in) {
  std::string line;
  char c = 0;
  while (in.get(c) && c != '\n') {
    line.push_back(c);
    if (line.size() > 4096) return std::nullopt;
  }
  if (!in || in.tellg() > static_cast<std::streamoff>(kMaxHeaderBytes)) return std::nullopt;
  std::istringstream words(line);
  std::vector<std::string> split;
  for (std::string word; words >> word;) split.push_back(word);
  return split;
}

std::optional<std::uint64_t> number(const std::string& text) {
  if (text.empty() || text.size() > 10 ||
      !std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; })) {
    return std::nullopt;
  }
  return std::stoull(text);
}

/// Sum of size x count over the fields of a PCD, 0 where they do not fit together.
std::uint64_t pcd_point_bytes(const std::map<std::string, std::vector<std::string>>& entries) {
  const auto words = [&](const char* key) {
    const auto found = entries.find(key);
    return found == entries.end() ? std::vector<std::string>{} : found->second;
  };
  const auto fields = words("FIELDS");
  const auto sizes = words("SIZE");
  auto counts = words("COUNT");
  if (counts.empty()) counts.assign(fields.size(), "1");
  if (fields.empty() || sizes.size() != fields.size() || counts.size() != fields.size() ||
      words("TYPE").size() != fields.size()) {
    return 0;
  }
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto size = number(sizes[i]);
    const auto count = number(counts[i]);
    if (!size || !count || (*size != 1 && *size != 2 && *size != 4 && *size != 8) || *count == 0 ||
        *count > 4096) {
      return 0;
    }
    bytes += *size * *count;
  }
  return bytes;
}

}  // namespace

Status check_pcd_header(const std::filesystem::path& file) {
  auto opened = open(file);
  if (!opened) return failure(opened.error().message);
  std::map<std::string, std::vector<std::string>> entries;
  while (!entries.contains("DATA")) {
    auto line = next_line(opened->stream);
    if (!line) return failure("not a PCD file: its header has no DATA line");
    if (line->empty() || line->front().starts_with('#')) continue;
    if (!entries.try_emplace(line->front(), line->begin() + 1, line->end()).second) {
      return failure("PCD header names " + line->front() + " twice");
    }
  }
  const std::uint64_t point_bytes = pcd_point_bytes(entries);
  const auto value = [&](const char* key) {
    const auto& words = entries[key];
    return words.size() == 1 ? number(words[0]) : std::nullopt;
  };
  const auto width = value("WIDTH");
  const auto height = value("HEIGHT");
  const auto points = value("POINTS");
  if (point_bytes == 0 || !width || !height || (!entries["POINTS"].empty() && !points) ||
      *width > kMaxPoints || *height > kMaxPoints || *width * *height > kMaxPoints ||
      (points && *points != *width * *height)) {
    return failure("malformed PCD header");
  }
  const std::uint64_t count = *width * *height;
  const auto start = static_cast<std::uint64_t>(opened->stream.tellg());
  const std::uint64_t body = opened->size - std::min(start, opened->size);
  const std::string encoding = entries["DATA"].empty() ? "" : entries["DATA"].front();
  if (encoding == "binary" && body >= count * point_bytes) return {};
  if (encoding == "ascii" && body + 1 >= 2 * count) return {};
  if (encoding == "binary_compressed") {
    std::array<std::uint32_t, 2> sizes{};  // compressed, uncompressed
    opened->stream.read(reinterpret_cast<char*>(sizes.data()), sizeof sizes);
    if (opened->stream && body >= 8 && sizes[0] <= body - 8 && sizes[1] == count * point_bytes) return {};
  }
  return failure("truncated or malformed: " + std::to_string(count) + " points promised, " +
                 std::to_string(body) + " bytes there");
}

Status check_ply_header(const std::filesystem::path& file) {
  static const std::map<std::string, std::uint64_t> kTypeBytes{
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  auto opened = open(file);
  if (!opened) return failure(opened.error().message);
  auto line = next_line(opened->stream);
  if (!line || *line != std::vector<std::string>{"ply"}) return failure("not a PLY file");
  std::string encoding;
  std::uint64_t needed = 0;
  std::uint64_t element_count = 0;
  std::string element;
  bool has_vertices = false;
  while ((line = next_line(opened->stream))) {
    if (line->empty()) return failure("malformed PLY header: empty line");
    const auto& words = *line;
    if (words[0] == "end_header") break;
    if (words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format" && words.size() == 3) {
      encoding = words[1];
    } else if (words[0] == "element" && words.size() == 3) {
      const auto count = number(words[2]);
      if (!count || *count > kMaxPoints) return failure("malformed PLY header: element count");
      element = words[1];
      element_count = *count;
      has_vertices = has_vertices || element == "vertex";
    } else if (words[0] == "property" && words.size() == 3 && kTypeBytes.contains(words[1])) {
      needed += element_count * (encoding == "ascii" ? 2 : kTypeBytes.at(words[1]));
    } else if (words[0] == "property" && words.size() == 5 && words[1] == "list" &&
               kTypeBytes.contains(words[2]) && kTypeBytes.contains(words[3])) {
      if (element == "vertex") return failure("PLY vertices with list properties are not supported");
      needed += element_count * (encoding == "ascii" ? 2 : kTypeBytes.at(words[2]));
    } else {
      return failure("malformed PLY header: " + words[0]);
    }
  }
  if (!line || encoding.empty() || !has_vertices) return failure("malformed PLY header");
  const auto start = static_cast<std::uint64_t>(opened->stream.tellg());
  if (opened->size + 1 < start + needed) {
    return failure("truncated: " + std::to_string(needed) + " bytes promised, " +
                   std::to_string(opened->size - start) + " there");
  }
  return {};
}

}  // namespace fleetmap::cloud
