#include "scan_file.hpp"

#include <charconv>
#include <cstring>
#include <sstream>

#include "file_bytes.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

/// The name without ".xz".
fs::path unpacked_name(const fs::path& file) {
  return file.extension() == ".xz" ? file.stem() : file.filename();
}

void add_point(ros_codec::DecodedScan& out, const Eigen::Vector3f& position, float intensity) {
  if (!position.allFinite()) {
    ++out.non_finite_points;
  } else if (position.isZero(0.0f)) {
    ++out.origin_points;
  } else {
    out.scan.points.push_back({position, intensity, 0.0f, 0});
  }
}

Result<ros_codec::DecodedScan> read_bin(const Bytes& bytes, const std::string& file) {
  constexpr std::size_t kPoint = 4 * sizeof(float);
  if (bytes.size() % kPoint != 0) {
    return failure(file + ": " + std::to_string(bytes.size()) +
                   " bytes are no whole number of points of 16 bytes; the file is truncated");
  }
  ros_codec::DecodedScan out;
  out.scan.points.reserve(bytes.size() / kPoint);
  for (std::size_t at = 0; at < bytes.size(); at += kPoint) {
    float values[4];
    std::memcpy(values, bytes.data() + at, kPoint);
    add_point(out, {values[0], values[1], values[2]}, values[3]);
  }
  return out;
}

/// Positions of fields by a PCD header.
struct PcdHeader {
  std::size_t points = 0;
  std::size_t step = 0;              ///< bytes of a point
  std::size_t columns = 0;           ///< numbers of a point
  int offset[4] = {-1, -1, -1, -1};  ///< bytes, of x, y, z, intensity
  int column[4] = {-1, -1, -1, -1};
  std::string data;  ///< "binary", "ascii", "binary_compressed"
  std::size_t data_begin = 0;
};

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> out;
  for (std::string word; stream >> word;) out.push_back(word);
  return out;
}

std::size_t to_count(const std::string& word) {
  std::size_t value = 0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

Status lay_out(PcdHeader& header, const std::vector<std::string>& fields,
               const std::vector<std::string>& sizes, const std::vector<std::string>& types,
               const std::vector<std::string>& counts, const std::string& file) {
  constexpr const char* kWanted[] = {"x", "y", "z", "intensity"};
  if (sizes.size() != fields.size() || types.size() != fields.size()) {
    return failure(file + ": PCD header: FIELDS, SIZE and TYPE differ in length");
  }
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const std::size_t size = to_count(sizes[k]);
    const std::size_t count = k < counts.size() ? to_count(counts[k]) : 1;
    if (size == 0 || size > 8 || count == 0 || count > 4096)
      return failure(file + ": PCD header: field " + fields[k] + " has an absurd size");
    for (std::size_t wanted = 0; wanted < 4; ++wanted) {
      if (fields[k] != kWanted[wanted] || size != 4 || types[k] != "F") continue;
      header.offset[wanted] = static_cast<int>(header.step);
      header.column[wanted] = static_cast<int>(header.columns);
    }
    header.step += size * count;
    header.columns += count;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (header.offset[axis] < 0)
      return failure(file + ": PCD header: no field " + kWanted[axis] + " of float32");
  }
  return {};
}

Result<PcdHeader> read_header(const Bytes& bytes, const std::string& file) {
  if (bytes.empty()) return failure(file + ": is empty");
  PcdHeader header;
  std::vector<std::string> fields, sizes, types, counts;
  std::size_t at = 0;
  while (header.data.empty()) {
    const auto* newline =
        static_cast<const std::uint8_t*>(std::memchr(bytes.data() + at, '\n', bytes.size() - at));
    if (newline == nullptr || at > 65536)
      return failure(file + ": PCD header has no DATA line; the file is truncated or no PCD");
    const auto end = static_cast<std::size_t>(newline - bytes.data());
    auto line = words(std::string(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                  bytes.begin() + static_cast<std::ptrdiff_t>(end)));
    at = end + 1;
    if (line.size() < 2) continue;
    const std::string key = line.front();
    line.erase(line.begin());
    if (key == "FIELDS") fields = line;
    if (key == "SIZE") sizes = line;
    if (key == "TYPE") types = line;
    if (key == "COUNT") counts = line;
    if (key == "POINTS") header.points = to_count(line[0]);
    if (key == "DATA") header.data = line[0];
  }
  header.data_begin = at;
  if (auto status = lay_out(header, fields, sizes, types, counts, file); !status)
    return tl::unexpected(status.error());
  return header;
}

Result<ros_codec::DecodedScan> read_pcd_binary(const Bytes& bytes, const PcdHeader& header,
                                               const std::string& file) {
  const std::size_t there = (bytes.size() - header.data_begin) / header.step;
  if (there < header.points) {
    return failure(file + ": has " + std::to_string(there) + " of " + std::to_string(header.points) +
                   " points; the file is truncated");
  }
  ros_codec::DecodedScan out;
  out.scan.points.reserve(header.points);
  const std::uint8_t* point = bytes.data() + header.data_begin;
  for (std::size_t k = 0; k < header.points; ++k, point += header.step) {
    float values[4] = {0, 0, 0, 0};
    for (std::size_t f = 0; f < 4; ++f) {
      if (header.offset[f] >= 0) std::memcpy(&values[f], point + header.offset[f], sizeof(float));
    }
    add_point(out, {values[0], values[1], values[2]}, values[3]);
  }
  return out;
}

Result<ros_codec::DecodedScan> read_pcd_ascii(const Bytes& bytes, const PcdHeader& header,
                                              const std::string& file) {
  std::istringstream stream(
      std::string(bytes.begin() + static_cast<std::ptrdiff_t>(header.data_begin), bytes.end()));
  ros_codec::DecodedScan out;
  for (std::size_t k = 0; k < header.points; ++k) {
    float values[4] = {0, 0, 0, 0};
    for (std::size_t column = 0; column < header.columns; ++column) {
      std::string word;
      if (!(stream >> word)) {
        return failure(file + ": has " + std::to_string(k) + " of " + std::to_string(header.points) +
                       " points; the file is truncated");
      }
      for (std::size_t f = 0; f < 4; ++f) {
        if (header.column[f] == static_cast<int>(column)) values[f] = std::strtof(word.c_str(), nullptr);
      }
    }
    add_point(out, {values[0], values[1], values[2]}, values[3]);
  }
  return out;
}

Result<ros_codec::DecodedScan> read_pcd(const Bytes& bytes, const std::string& file) {
  const auto header = read_header(bytes, file);
  if (!header) return tl::unexpected(header.error());
  if (header->data == "binary") return read_pcd_binary(bytes, *header, file);
  if (header->data == "ascii") return read_pcd_ascii(bytes, *header, file);
  return failure(file + ": PCD data '" + header->data +
                 "' is not read; convert it with `pcl_convert_pcd_ascii_binary IN OUT 1`");
}

}  // namespace

bool is_scan_file(const fs::path& file) {
  const auto extension = unpacked_name(file).extension();
  return extension == ".bin" || extension == ".pcd";
}

Result<ros_codec::DecodedScan> read_scan_file(const fs::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return tl::unexpected(bytes.error());
  return unpacked_name(file).extension() == ".bin" ? read_bin(*bytes, file.string())
                                                   : read_pcd(*bytes, file.string());
}

}  // namespace fleetmap::recording
