#include "fleetmap/sensor/ouster_metadata.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::sensor {
namespace {

using nlohmann::json;

constexpr double kMillimetre = 1e-3;
constexpr std::size_t kMaxBeams = 256, kMaxColumns = 4096;
/// Metadata of firmware 1 states neither: these are of the first OS1.
constexpr double kFirstBeamOrigin = 12.163;  // mm
constexpr std::size_t kFirstColumnsPerPacket = 16;

/// Reads values by name, wherever they are; remembers the first that is wrong.
class MetadataFields {
 public:
  explicit MetadataFields(const json& root) : root_(root) {}

  /// A value of firmware 2 at the top, of firmware 3 in a section; null if there is none.
  const json* find(const char* key) const {
    if (root_.contains(key)) return &root_[key];
    for (const char* section : {"lidar_data_format", "data_format", "beam_intrinsics", "lidar_intrinsics",
                                "imu_intrinsics", "sensor_info", "config_params"}) {
      const auto at = root_.find(section);
      if (at != root_.end() && at->is_object() && at->contains(key)) return &(*at)[key];
    }
    return nullptr;
  }
  std::string text(const char* key, const std::string& otherwise) {
    const json* value = find(key);
    if (value == nullptr) return otherwise;
    if (value->is_string()) return value->get<std::string>();
    problem(key, "a text");
    return otherwise;
  }
  std::size_t count(const char* key, std::size_t otherwise, std::size_t limit) {
    const json* value = find(key);
    if (value == nullptr) return otherwise;
    if (value->is_number_unsigned() && value->get<std::uint64_t>() >= 1 &&
        value->get<std::uint64_t>() <= limit)
      return value->get<std::size_t>();
    problem(key, "a number from 1 to " + std::to_string(limit));
    return otherwise;
  }
  double number(const char* key, double otherwise, double limit) {
    const json* value = find(key);
    if (value == nullptr) return otherwise;
    if (value->is_number() && std::abs(value->get<double>()) <= limit) return value->get<double>();
    problem(key, "a number up to " + std::to_string(limit));
    return otherwise;
  }
  /// Empty if there are none.
  std::vector<double> numbers(const char* key, double limit) {
    const json* value = find(key);
    if (value == nullptr) return {};
    std::vector<double> found;
    if (!value->is_array() || value->size() > kMaxColumns) return problem(key, "a list of numbers"), found;
    for (const json& one : *value) {
      if (!one.is_number() || !(std::abs(one.get<double>()) <= limit))
        return problem(key, "numbers up to " + std::to_string(limit)), std::vector<double>();
      found.push_back(one.get<double>());
    }
    return found;
  }
  void problem(const std::string& key, const std::string& expected) {
    if (problem_.empty()) problem_ = key + ": expected " + expected;
  }
  const std::string& first_problem() const { return problem_; }

 private:
  const json& root_;
  std::string problem_;
};

/// A row-major matrix of 4 x 4 in mm.
Pose read_transform(MetadataFields& fields, const char* key, const Pose& otherwise) {
  constexpr double kMaxMillimetres = 1e4, kSlack = 1e-3;
  const std::vector<double> values = fields.numbers(key, kMaxMillimetres);
  if (values.empty()) return otherwise;
  if (values.size() == 16) {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> T(values.data());
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    const Eigen::Vector3d translation = T.topRightCorner<3, 1>() * kMillimetre;
    const bool rotates =
        (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < kSlack && R.determinant() > 0;
    if (rotates) return make_pose(Eigen::Quaterniond(R), translation);
  }
  fields.problem(key, "16 numbers, a rotation and a translation in mm");
  return otherwise;
}

/// Turned by half a turn, as the manual defines it, and as high as in the first OS1.
Pose usual_lidar() {
  return make_pose(Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ())),
                   {0.0, 0.0, 36.180 * kMillimetre});
}

void read_beams(MetadataFields& fields, OusterMetadata& out) {
  const std::vector<double> altitudes = fields.numbers("beam_altitude_angles", 89.0);
  const std::vector<double> azimuths = fields.numbers("beam_azimuth_angles", 180.0);
  if (altitudes.empty() || altitudes.size() > kMaxBeams || azimuths.size() != altitudes.size())
    return fields.problem("beam_altitude_angles, beam_azimuth_angles",
                          "as many of one as of the other, 1 to 256");
  if (fields.count("pixels_per_column", altitudes.size(), kMaxBeams) != altitudes.size())
    return fields.problem("pixels_per_column", "the number of beam_altitude_angles");
  for (std::size_t k = 0; k < altitudes.size(); ++k) {
    const double altitude = altitudes[k] * kDegree, azimuth = -azimuths[k] * kDegree;
    const Eigen::Vector3d beam(std::cos(azimuth) * std::cos(altitude), std::sin(azimuth) * std::cos(altitude),
                               std::sin(altitude));
    out.beams.push_back(beam.cast<float>());
  }
  constexpr double kMaxMillimetres = 1e3;
  const Eigen::Vector3d along(
      fields.number("lidar_origin_to_beam_origin_mm", kFirstBeamOrigin, kMaxMillimetres), 0.0, 0.0);
  const Pose origin = read_transform(fields, "beam_to_lidar_transform",
                                     make_pose(Eigen::Quaterniond::Identity(), along * kMillimetre));
  out.beam_origin = origin.translation().cast<float>();
}

/// "1024x10": columns and turns a second.
std::size_t columns_of_mode(const std::string& mode) {
  std::size_t columns = 0;
  for (const char digit : mode.substr(0, std::min<std::size_t>(mode.find('x'), 4))) {
    if (digit < '0' || digit > '9') return 0;
    columns = columns * 10 + static_cast<std::size_t>(digit - '0');
  }
  return columns;
}

void read_format(MetadataFields& fields, OusterMetadata& out) {
  const std::string profile = fields.text("udp_profile_lidar", "LEGACY");
  if (const auto known = ouster_profile(profile)) {
    out.profile = *known;
  } else {
    fields.problem("udp_profile_lidar", "one of " + ouster_profile_names() + ", not '" + profile +
                                            "'; set it in the sensor's web page");
  }
  out.has_imu_packets = fields.text("udp_profile_imu", "LEGACY") == "LEGACY";
  out.columns_per_packet = fields.count("columns_per_packet", kFirstColumnsPerPacket, kMaxColumns);
  const std::size_t of_mode = columns_of_mode(fields.text("lidar_mode", ""));
  out.columns_per_frame = fields.count("columns_per_frame", of_mode, kMaxColumns);
  if (out.columns_per_frame == 0)
    return fields.problem("columns_per_frame", "it, or lidar_mode, e.g. 1024x10");
  out.last_column = out.columns_per_frame - 1;
  const std::vector<double> window = fields.numbers("column_window", kMaxColumns);
  if (window.size() == 2 && window[0] >= 0.0 && window[0] < window[1] &&
      window[1] < static_cast<double>(out.columns_per_frame)) {
    out.first_column = static_cast<std::size_t>(window[0]);
    out.last_column = static_cast<std::size_t>(window[1]);
  }
}

}  // namespace

std::size_t OusterMetadata::lidar_packet_bytes() const {
  return profile.packet_bytes(columns_per_packet, beams.size());
}

Result<OusterMetadata> read_ouster_metadata(std::string_view text) {
  const json root = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_object()) return failure("this is no JSON object");
  MetadataFields fields(root);
  OusterMetadata out;
  read_beams(fields, out);
  read_format(fields, out);
  out.T_sensor_lidar = read_transform(fields, "lidar_to_sensor_transform", usual_lidar());
  out.T_sensor_imu = read_transform(fields, "imu_to_sensor_transform", Pose::Identity());
  out.imu_port = static_cast<std::uint16_t>(fields.count("udp_port_imu", out.imu_port, 65535));
  out.device = fields.text("prod_line", "Ouster LiDAR") + " " + fields.text("prod_sn", "");
  if (!fields.first_problem().empty()) return failure(fields.first_problem());
  return out;
}

Result<OusterMetadata> load_ouster_metadata(const std::filesystem::path& file) {
  std::error_code none;
  std::ifstream in(file, std::ios::binary);
  if (std::filesystem::is_directory(file, none))
    return failure(file.string() + ": is a folder; expected the metadata's file");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return failure(file.string() + ": cannot be read");
  auto metadata = read_ouster_metadata(text);
  if (!metadata) return failure(file.string() + ": " + metadata.error().message);
  return metadata;
}

}  // namespace fleetmap::sensor
