#include "fleetmap/output/trajectory_file.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>

#include "fleetmap/core/paths.hpp"
#include "pose_text.hpp"

namespace fleetmap::output {

namespace {

std::optional<std::int64_t> integer_of(const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Seconds to nanoseconds without a detour over double, which cannot hold a Unix time to the nanosecond.
std::optional<Stamp> stamp_of(const std::string& text) {
  if (const auto value = finite_number(text); !value || std::abs(*value) > 9e9) return std::nullopt;
  const std::size_t dot = text.find('.');
  if (text.find_first_of("eE") != std::string::npos || dot == std::string::npos)
    return Stamp{from_seconds(*finite_number(text))};
  std::string digits = text.substr(0, dot) + text.substr(dot + 1, 9);
  digits.append(9 - std::min<std::size_t>(9, text.size() - dot - 1), '0');
  const auto ns = integer_of(digits);
  if (!ns) return std::nullopt;
  return stamp_from_ns(*ns);
}

/// Empty when the line is not a pose.
std::optional<StampedPose> stamped_pose_of(const std::string& line) {
  std::istringstream fields(line);
  std::string stamp_text, text;
  std::array<double, 7> v{};
  fields >> stamp_text;
  for (double& value : v) {
    if (!(fields >> text)) return std::nullopt;
    const auto number = finite_number(text);
    if (!number) return std::nullopt;
    value = *number;
  }
  const auto stamp = stamp_of(stamp_text);
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!stamp || fields >> text || !(std::abs(q.norm() - 1.0) < 0.1)) return std::nullopt;
  return StampedPose{*stamp, make_pose(q, Eigen::Vector3d(v[0], v[1], v[2]))};
}

Status read_lines(const std::filesystem::path& file, bool complete, Trajectory& trajectory) {
  std::ifstream in(file);
  if (!in) return failure(file.string() + ": cannot be read");
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    const auto pose = stamped_pose_of(line);
    const std::string where = file.string() + ":" + std::to_string(number);
    if (!pose) {
      if (!complete && in.peek() == std::ifstream::traits_type::eof()) break;
      return failure(where +
                     ": expected 'stamp_s x y z qx qy qz qw': eight finite numbers, the last four a unit "
                     "quaternion");
    }
    if (complete && !trajectory.empty() && pose->stamp < trajectory.back().stamp)
      return failure(where + ": the stamp is before that of the line above; sort the file by time");
    trajectory.push_back(*pose);
  }
  return {};
}

/// `complete`: the file has an end; stamps are in order.
Result<Trajectory> read_parts(const std::filesystem::path& file, bool complete) {
  if (!is_there(file)) return failure(file.string() + ": cannot be read");
  Trajectory trajectory;
  for (const std::filesystem::path& part : parts_of(file)) {
    if (const Status read = read_lines(part, complete, trajectory); !read)
      return tl::unexpected(read.error());
  }
  return trajectory;
}

}  // namespace

std::filesystem::path odometry_file(const std::filesystem::path& directory, std::size_t index) {
  return directory / (index == 0 ? "odometry.tum" : "odometry-" + std::to_string(index) + ".tum");
}

std::string tum_line(const StampedPose& pose) {
  const std::int64_t ns = to_ns(pose.stamp);
  std::array<char, 64> stamp{};
  // The stamp is written from its integer: a double would round a Unix time to 100 ns.
  std::snprintf(stamp.data(), stamp.size(), "%s%lld.%09lld ", ns < 0 ? "-" : "",
                static_cast<long long>(std::abs(ns) / 1'000'000'000),
                static_cast<long long>(std::abs(ns) % 1'000'000'000));
  return stamp.data() + pose_text(pose.T_w_base, 6, 9);
}

Result<Trajectory> read_tum(const std::filesystem::path& file) { return read_parts(file, true); }

Result<Trajectory> read_growing_tum(const std::filesystem::path& file) { return read_parts(file, false); }

Status write_tum(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::ofstream out(file, std::ios::trunc);
  for (const StampedPose& pose : trajectory) out << tum_line(pose) << '\n';
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

Result<TrajectoryFile> TrajectoryFile::create(const std::filesystem::path& file) {
  Result<LineFile> lines = LineFile::open(file, std::ios::trunc, {kMaxTrackBytes, ""});
  if (!lines) return tl::unexpected(lines.error());
  return TrajectoryFile(std::move(*lines));
}

Result<TrajectoryFile> TrajectoryFile::begin_session(const std::filesystem::path& directory,
                                                     std::size_t index) {
  const std::filesystem::path file = odometry_file(directory, index);
  std::error_code error;
  for (int k = 1; !parts_of(file).empty(); ++k) {
    const std::filesystem::path aside = file.string() + ".before-" + std::to_string(k);
    if (!parts_of(aside).empty()) continue;
    for (const auto& [part, to] :
         {std::pair(part_before(file), part_before(aside)), std::pair(file, aside)}) {
      if (!is_there(part)) continue;
      std::filesystem::rename(part, to, error);
      if (error) return failure(part.string() + ": cannot be moved aside: " + error.message());
    }
    spdlog::warn("{}: is of a store that was lost or replaced; it is {} now", file.string(), aside.string());
  }
  return create(file);
}

}  // namespace fleetmap::output
