#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace fleetmap::bus {

/// Bytes that left an interface, Ethernet headers included, as the kernel counts them.
class WireMeter {
 public:
  explicit WireMeter(const std::string& iface);
  /// To be called every 100 ms.
  void sample();
  double mean_kbit_s() const;
  /// The highest mean over a second.
  double peak_kbit_s() const;

 private:
  struct Sample {
    std::chrono::steady_clock::time_point time;
    double bytes = 0.0;
  };
  static double rate_kbit_s(const Sample& from, const Sample& to);

  std::string path_;
  std::vector<Sample> samples_;
};

}  // namespace fleetmap::bus
