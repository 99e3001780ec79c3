#include "fleetmap/agent/trajectory_file.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <optional>
#include <sstream>

namespace fleetmap::agent {
namespace {

/// "12.345" to nanoseconds without a detour over double, which cannot hold a Unix time to the nanosecond.
std::optional<Stamp> parse_stamp(const std::string& text) {
  const std::size_t dot = std::min(text.find('.'), text.size());
  std::string digits = text.substr(0, dot) + (dot < text.size() ? text.substr(dot + 1, 9) : "");
  digits.append(9 - std::min<std::size_t>(9, dot < text.size() ? text.size() - dot - 1 : 0), '0');
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), ns);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return stamp_from_ns(ns);
}

}  // namespace

std::filesystem::path odometry_file(const std::filesystem::path& directory, std::size_t index) {
  return directory / (index == 0 ? "odometry.tum" : "odometry-" + std::to_string(index) + ".tum");
}

std::string tum_line(const StampedPose& pose) {
  const Eigen::Quaterniond q(pose.T_w_base.linear());
  const Eigen::Vector3d t = pose.T_w_base.translation();
  const std::int64_t ns = to_ns(pose.stamp);
  std::array<char, 256> text{};
  // The stamp is written from its integer: a double would round a Unix time to 100 ns.
  std::snprintf(text.data(), text.size(), "%s%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f",
                ns < 0 ? "-" : "", static_cast<long long>(std::abs(ns) / 1'000'000'000),
                static_cast<long long>(std::abs(ns) % 1'000'000'000), t.x(), t.y(), t.z(), q.x(), q.y(),
                q.z(), q.w());
  return text.data();
}

Result<std::vector<StampedPose>> read_trajectory(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) return failure(file.string() + ": cannot be read");
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    std::string stamp_text;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    if (!(fields >> stamp_text >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w()) ||
        q.norm() < 0.5 || !parse_stamp(stamp_text)) {
      if (in.peek() == std::ifstream::traits_type::eof()) break;
      return failure(file.string() + ":" + std::to_string(number) + ": expected 'stamp x y z qx qy qz qw'");
    }
    poses.push_back({*parse_stamp(stamp_text), make_pose(q, t)});
  }
  return poses;
}

Status write_trajectory(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  std::ofstream out(file, std::ios::trunc);
  for (const StampedPose& pose : poses) out << tum_line(pose) << '\n';
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

Result<TrajectoryFile> TrajectoryFile::create(const std::filesystem::path& file) {
  Result<LineFile> lines = LineFile::open(file, std::ios::trunc);
  if (!lines) return tl::unexpected(lines.error());
  return TrajectoryFile(std::move(*lines));
}

}  // namespace fleetmap::agent
