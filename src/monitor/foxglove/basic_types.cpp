#include "basic_types.hpp"

#include <algorithm>
#include <limits>

namespace fleetmap::monitor::foxglove {

Color color_of(std::uint32_t rgb) {
  const auto share = [&](unsigned shift) { return static_cast<double>(rgb >> shift & 0xffu) / 255.0; };
  return {share(16), share(8), share(0), 1.0};
}

void write(CdrWriter& cdr, Stamp stamp) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  constexpr std::int64_t kLast = std::numeric_limits<std::uint32_t>::max() * kSecond + kSecond - 1;
  const std::int64_t ns = std::clamp<std::int64_t>(to_ns(stamp), 0, kLast);
  cdr.number(static_cast<std::uint32_t>(ns / kSecond));
  cdr.number(static_cast<std::uint32_t>(ns % kSecond));
}

void write(CdrWriter& cdr, const Eigen::Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) cdr.number(value);
}

void write(CdrWriter& cdr, const Eigen::Quaterniond& q) {
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) cdr.number(value);
}

void write(CdrWriter& cdr, const Pose& T) {
  write(cdr, Eigen::Vector3d(T.translation()));
  write(cdr, Eigen::Quaterniond(T.linear()));
}

void write(CdrWriter& cdr, const Color& color) {
  for (const double value : {color.r, color.g, color.b, color.a}) cdr.number(value);
}

}  // namespace fleetmap::monitor::foxglove
