#include "calibration_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::apps {
namespace {

using nlohmann::ordered_json;

std::string fixed(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// Two digits of the sigma are shown, and as many of the value.
int digits_for(double sigma) {
  return std::clamp(static_cast<int>(std::ceil(1.0 - std::log10(std::max(sigma, 1e-9)))), 0, 4);
}

std::string sentence(const CalibratedQuantity& one) {
  const std::string subject = one.sensor + ": " + one.name;
  if (!one.observable) return subject + " is not observable on this drive: " + one.remedy;
  const int digits = digits_for(one.estimate.sigma);
  std::string text = subject + " is " + fixed(one.estimate.value, digits) + ' ' + one.unit + ", sigma " +
                     fixed(one.estimate.sigma, digits);
  if (one.differs()) {
    const double sigmas = std::abs(one.estimate.value - one.in_use) / one.estimate.sigma;
    text += "; in use is " + fixed(one.in_use, digits) + ", " + fixed(sigmas, 0) + " sigmas off";
  }
  return text;
}

std::string list(const Eigen::Vector3d& v, int digits) {
  const Eigen::Vector3d shown = v.array() + 0.0;  // no -0.0
  return '[' + fixed(shown.x(), digits) + ", " + fixed(shown.y(), digits) + ", " + fixed(shown.z(), digits) +
         ']';
}

Eigen::Vector3d rpy_deg(const Pose& T) { return rpy_from_rotation(T.linear()) / kDegree; }

void print_yaml(std::ostream& out, const CalibratedPlace& place) {
  out << place.section << ":\n";
  if (!place.kept.empty()) out << "  # not observable, as in use: " << place.kept << '\n';
  out << "  translation: " << list(place.T_base_sensor.translation(), 3) << '\n';
  if (place.with_rotation) out << "  rotation_rpy_deg: " << list(rpy_deg(place.T_base_sensor), 2) << '\n';
}

ordered_json calibration_json(const CalibratedQuantity& one) {
  ordered_json json{
      {"sensor", one.sensor}, {"quantity", one.name}, {"unit", one.unit}, {"observable", one.observable}};
  if (!one.observable) {
    json["remedy"] = one.remedy;
    return json;
  }
  json["value"] = one.estimate.value;
  json["sigma"] = one.estimate.sigma;
  json["in_use"] = one.in_use;
  json["differs"] = one.differs();
  return json;
}

ordered_json calibration_json(const CalibratedPlace& place) {
  const Eigen::Vector3d t = place.T_base_sensor.translation(), rpy = rpy_deg(place.T_base_sensor);
  ordered_json json{{"translation", {t.x(), t.y(), t.z()}}};
  if (place.with_rotation) json["rotation_rpy_deg"] = {rpy.x(), rpy.y(), rpy.z()};
  json["not_observable"] = place.kept;
  ordered_json rows = ordered_json::array();
  for (Eigen::Index row = 0; row < place.covariance.rows(); ++row) {
    rows.push_back(ordered_json::array());
    for (Eigen::Index column = 0; column < place.covariance.cols(); ++column)
      rows.back().push_back(place.covariance(row, column));
  }
  json["covariance"] = std::move(rows);
  return json;
}

}  // namespace

void print_calibration(std::ostream& out, const CalibratedMounts& mounts) {
  out << fixed(mounts.metres, 1) << " m and " << fixed(mounts.turned / kDegree, 0)
      << " deg of turns; numbers are in base_link as the LiDAR's mount in use places it\n";
  for (const CalibratedQuantity& one : mounts.quantities) out << sentence(one) << '\n';
  for (const std::string& one : mounts.skipped) out << one << '\n';
  if (mounts.places.empty()) return;
  const bool by_wheels = mounts.places.front().section == "lidar";
  out << "\n# base_link as " << (by_wheels ? "the wheels drive" : "the LiDAR's mount in use places it")
      << '\n';
  for (const CalibratedPlace& place : mounts.places) print_yaml(out, place);
}

void print_calibration_json(std::ostream& out, const CalibratedMounts& mounts) {
  ordered_json json{{"driven_m", mounts.metres}, {"turned_deg", mounts.turned / kDegree}};
  json["quantities"] = ordered_json::array();
  for (const CalibratedQuantity& one : mounts.quantities) json["quantities"].push_back(calibration_json(one));
  json["skipped"] = mounts.skipped;
  json["mounts"] = ordered_json::object();
  for (const CalibratedPlace& place : mounts.places) json["mounts"][place.section] = calibration_json(place);
  out << json.dump(2) << '\n';
}

}  // namespace fleetmap::apps
