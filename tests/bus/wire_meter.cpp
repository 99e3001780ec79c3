#include "wire_meter.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>

namespace fleetmap::bus {

WireMeter::WireMeter(const std::string& iface) : path_("/sys/class/net/" + iface + "/statistics/tx_bytes") {
  sample();
}

void WireMeter::sample() {
  std::ifstream file(path_);
  std::uint64_t bytes = 0;
  file >> bytes;
  samples_.push_back({std::chrono::steady_clock::now(), static_cast<double>(bytes)});
}

double WireMeter::mean_kbit_s() const { return rate_kbit_s(samples_.front(), samples_.back()); }

double WireMeter::peak_kbit_s() const {
  double peak = 0.0;
  for (std::size_t i = 10; i < samples_.size(); ++i) {
    peak = std::max(peak, rate_kbit_s(samples_[i - 10], samples_[i]));
  }
  return peak;
}

double WireMeter::rate_kbit_s(const Sample& from, const Sample& to) {
  return (to.bytes - from.bytes) * 8e-3 / std::chrono::duration<double>(to.time - from.time).count();
}

}  // namespace fleetmap::bus
