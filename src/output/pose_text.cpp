#include "pose_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace fleetmap::output {

std::string pose_text(const Pose& T, int digits_m, int digits_q) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), "%.*f %.*f %.*f %.*f %.*f %.*f %.*f", digits_m, t.x(), digits_m,
                t.y(), digits_m, t.z(), digits_q, q.x(), digits_q, q.y(), digits_q, q.z(), digits_q, q.w());
  return text.data();
}

std::optional<double> finite_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace fleetmap::output
