#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fleetmap::testing {

/// A LAS 1.4 file, read by the offsets in the tables of the specification; shares no code with the writer.
struct LasFile {
  struct Point {
    Eigen::Vector3d position;
    std::uint16_t intensity = 0, source = 0;
    std::uint8_t returns = 0, flags = 0, classification = 0;
    double gps_time = 0.0;
  };
  std::string bytes, signature, system, software;
  std::uint16_t global_encoding = 0, day_of_year = 0, year = 0;
  std::array<std::uint8_t, 16> project{};
  int major = 0, minor = 0, format = 0;
  std::uint32_t legacy_points = 0;
  Eigen::Vector3d scale, offset, min, max;
  std::uint64_t count = 0, first_returns = 0;
  std::map<std::pair<std::string, int>, std::string>
      records;  ///< by user ID and record ID, without their zero
  std::vector<Point> points;

  std::string wkt() const { return records.at({"LASF_Projection", 2112}); }
  std::string text() const { return records.at({"LASF_Spec", 3}); }
};

class LasReader {
 public:
  explicit LasReader(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    file_.bytes.assign(std::istreambuf_iterator<char>(in), {});
    read_header();
    read_records();
    read_points();
  }
  const LasFile& file() const { return file_; }

 private:
  template <class T>
  T at(std::size_t offset) const {
    if (offset + sizeof(T) > file_.bytes.size()) throw std::runtime_error("LAS file is cut off");
    T value;
    std::memcpy(&value, file_.bytes.data() + offset, sizeof(T));
    return value;
  }
  std::string text(std::size_t offset, std::size_t width) const {
    const std::string field = file_.bytes.substr(offset, width);
    return field.substr(0, field.find('\0'));
  }
  void read_header() {
    file_.signature = text(0, 4);
    file_.global_encoding = at<std::uint16_t>(6);
    file_.project = at<std::array<std::uint8_t, 16>>(8);
    file_.major = at<std::uint8_t>(24);
    file_.minor = at<std::uint8_t>(25);
    file_.system = text(26, 32);
    file_.software = text(58, 32);
    file_.day_of_year = at<std::uint16_t>(90);
    file_.year = at<std::uint16_t>(92);
    file_.format = at<std::uint8_t>(104);
    file_.legacy_points = at<std::uint32_t>(107);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      file_.scale[k] = at<double>(131 + 8 * axis);
      file_.offset[k] = at<double>(155 + 8 * axis);
      file_.max[k] = at<double>(179 + 16 * axis);
      file_.min[k] = at<double>(187 + 16 * axis);
    }
    file_.count = at<std::uint64_t>(247);
    file_.first_returns = at<std::uint64_t>(255);
  }
  void read_records() {
    std::size_t begin = at<std::uint16_t>(94);
    for (std::uint32_t k = 0; k < at<std::uint32_t>(100); ++k) {
      const std::size_t length = at<std::uint16_t>(begin + 20);
      const std::string content = file_.bytes.substr(begin + 54, length);
      if (content.empty() || content.back() != '\0') throw std::runtime_error("a string has no end");
      file_.records[{text(begin + 2, 16), at<std::uint16_t>(begin + 18)}] =
          content.substr(0, content.size() - 1);
      begin += 54 + length;
    }
    if (begin != at<std::uint32_t>(96)) throw std::runtime_error("points do not begin behind the records");
  }
  void read_points() {
    const std::size_t size = at<std::uint16_t>(105);
    for (std::size_t begin = at<std::uint32_t>(96); begin < file_.bytes.size(); begin += size) {
      LasFile::Point point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<Eigen::Index>(axis);
        point.position[k] = at<std::int32_t>(begin + 4 * axis) * file_.scale[k] + file_.offset[k];
      }
      point.intensity = at<std::uint16_t>(begin + 12);
      point.returns = at<std::uint8_t>(begin + 14);
      point.flags = at<std::uint8_t>(begin + 15);
      point.classification = at<std::uint8_t>(begin + 16);
      point.source = at<std::uint16_t>(begin + 20);
      point.gps_time = at<double>(begin + 22);
      file_.points.push_back(point);
    }
  }

  LasFile file_;
};

inline LasFile read_las(const std::filesystem::path& path) { return LasReader(path).file(); }

}  // namespace fleetmap::testing
