#include "stream_summary.hpp"

#include <algorithm>
#include <iomanip>

namespace fleetmap::apps {
namespace {

constexpr std::array kNames{"LiDAR", "IMU", "GPS", "wheels"};

}  // namespace

void StreamSummary::add(const recording::Sample& sample) {
  const Stamp stamp = recording::stamp_of(sample);
  Stream& stream = streams_.at(sample.index());
  ++stream.count;
  if (const auto* fix = std::get_if<sensor::Fix>(&sample); fix != nullptr && fix->valid) ++places_;
  if (!stream.first) stream.first = stamp;
  if (stream.last) stream.longest_gap = std::max(stream.longest_gap, stamp - *stream.last);
  stream.last = stamp;
}

std::optional<std::string> StreamSummary::fixes_without_place(bool uses_gps) const {
  if (!uses_gps || fixes() == 0 || places_ > 0) return std::nullopt;
  return "GPS: " + std::to_string(fixes()) +
         " fixes came, all without a position (status -1): check the antenna and its cable, and wait under "
         "open sky until the receiver has a position. A robot without GPS has gps.use: false";
}

void StreamSummary::print(std::ostream& out) const {
  for (std::size_t k = 0; k < streams_.size(); ++k) {
    const Stream& stream = streams_[k];
    out << std::left << std::setw(8) << kNames.at(k) << std::right << std::setw(8) << stream.count;
    if (stream.count > 1) {
      const double seconds = to_seconds(*stream.last - *stream.first);
      out << std::fixed << std::setprecision(1) << std::setw(10) << seconds << " s" << std::setw(8)
          << static_cast<double>(stream.count - 1) / std::max(seconds, 1e-9) << " Hz, longest gap "
          << std::setprecision(2) << to_seconds(stream.longest_gap) << " s";
    }
    out << (stream.count == 0 ? "  none\n" : "\n");
  }
}

}  // namespace fleetmap::apps
