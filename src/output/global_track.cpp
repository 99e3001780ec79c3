#include "fleetmap/output/global_track.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::output {
namespace {

constexpr const char* kTrackHeader =
    "stamp_s,latitude_deg,longitude_deg,altitude_m,qx,qy,qz,qw,sigma_e_m,sigma_n_m,sigma_u_m,sigma_yaw_deg";

bool parse(const std::string& line, GlobalPose& G) {
  long long seconds = 0;
  long long nanoseconds = 0;
  std::array<double, 11> v{};
  const int fields =
      std::sscanf(line.c_str(), "%lld.%9lld,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &seconds,
                  &nanoseconds, &v[0], &v[1], &v[2], &v[3], &v[4], &v[5], &v[6], &v[7], &v[8], &v[9], &v[10]);
  constexpr long long kMaxSeconds = 9'000'000'000;  // in 64 bits of nanoseconds
  if (fields != 13 || seconds > kMaxSeconds || seconds < -kMaxSeconds) return false;
  G.stamp = stamp_from_ns(seconds * 1'000'000'000 + nanoseconds);
  G.position = geo_point_from_degrees(v[0], v[1], v[2]);
  G.q_enu_base = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized();
  G.covariance = Matrix6d::Zero();
  for (int k = 0; k < 3; ++k)
    G.covariance(k, k) = v[7 + static_cast<std::size_t>(k)] * v[7 + static_cast<std::size_t>(k)];
  G.covariance(5, 5) = v[10] * kDegree * v[10] * kDegree;
  return is_valid(G.position) && G.q_enu_base.coeffs().allFinite() && G.covariance.allFinite();
}

}  // namespace

Result<GlobalTrackFile> GlobalTrackFile::append_to(const std::filesystem::path& file) {
  std::error_code error;
  const bool goes_on = is_there(file) && std::filesystem::file_size(file, error) > 0;
  Result<LineFile> lines = LineFile::open(file, std::ios::app, {kMaxTrackBytes, kTrackHeader});
  if (!lines) return tl::unexpected(lines.error());
  // LineFile ends a line that a kill cut off; the empty one behind it marks that line as cut off, not
  // damaged.
  if (const Status ended = goes_on ? lines->add("") : Status(); !ended) return tl::unexpected(ended.error());
  return GlobalTrackFile(std::move(*lines));
}

Status GlobalTrackFile::add(const GlobalPose& G) {
  const Eigen::Quaterniond& q = G.q_enu_base;
  const std::int64_t ns = to_ns(G.stamp);
  std::array<char, 320> line{};
  std::snprintf(line.data(), line.size(),
                "%lld.%09lld,%.10f,%.10f,%.4f,%.9f,%.9f,%.9f,%.9f,%.4f,%.4f,%.4f,%.4f",
                static_cast<long long>(ns / 1'000'000'000), static_cast<long long>(ns % 1'000'000'000),
                G.position.latitude / kDegree, G.position.longitude / kDegree, G.position.altitude, q.x(),
                q.y(), q.z(), q.w(), std::sqrt(G.covariance(0, 0)), std::sqrt(G.covariance(1, 1)),
                std::sqrt(G.covariance(2, 2)), std::sqrt(G.covariance(5, 5)) / kDegree);
  return lines_.add(line.data());
}

namespace {

Status read_part(const std::filesystem::path& file, std::vector<GlobalPose>& track) {
  std::ifstream in(file);
  if (!in) return failure(file.string() + ": cannot be read");
  std::string line;
  bool cut_off = false;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty()) {
      cut_off = false;
      continue;
    }
    if (cut_off)
      return failure(file.string() + ":" + std::to_string(number - 1) + ": not a line of a global track");
    if (line == kTrackHeader) continue;
    GlobalPose G;
    if (parse(line, G)) {
      track.push_back(G);
    } else {
      cut_off = true;
    }
  }
  return {};
}

}  // namespace

Result<std::vector<GlobalPose>> read_global_track(const std::filesystem::path& file) {
  if (!is_there(file)) return failure(file.string() + ": cannot be read");
  std::vector<GlobalPose> track;
  for (const std::filesystem::path& part : parts_of(file)) {
    if (const Status read = read_part(part, track); !read) return tl::unexpected(read.error());
  }
  return track;
}

}  // namespace fleetmap::output
