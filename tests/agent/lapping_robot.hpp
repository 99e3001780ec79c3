#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"

namespace fleetmap::testing {

/// A sensor's clock against the true time.
struct SensorClock {
  Duration ahead{};
  double rate_error = 0.0;  ///< s a second that it gains
};

/// A whole agent in virtual time, whose robot drives laps of a yard for ever. Sensors are published as
/// drivers do: encoded, and some time after they were taken. Scans have few points and repeat with every lap.
class LappingRobot {
 public:
  struct Options {
    double scan_rate = 5.0;  ///< Hz, a divisor of 50
    int columns = 600;       ///< of a scan of 16 rings
    double gps_sigma = 0.3;  ///< m, white, horizontal
    std::array<SensorClock, sensor::kSources> clocks{};
    std::array<bool, sensor::kSources> fitted{true, true, true, true};
    std::filesystem::path folder;  ///< of the agent
  };
  static constexpr double kLap = 40.0;  ///< s
  static constexpr Stamp kStart = stamp_from_ns(1'750'000'000'000'000'000);

  /// The error of the poses published with one scan, against the truth at the stamp that they bear.
  struct Error {
    double seconds = 0.0;   ///< since the start, by the published stamp
    double odometry = 0.0;  ///< m, of O since the first
    double position = 0.0;  ///< m, of G
  };

  explicit LappingRobot(const Options& options);
  void run_for(double seconds);
  /// From now on.
  void set_clock(sensor::Source source, const SensorClock& clock) {
    options_.clocks[static_cast<std::size_t>(source)] = clock;
  }
  void set_fitted(sensor::Source source, bool fitted) {
    options_.fitted[static_cast<std::size_t>(source)] = fitted;
  }
  agent::Agent& agent() { return *agent_; }
  bus::LocalNetwork& network() { return *network_; }
  bus::Bus& bus() { return *bus_; }
  /// The errors of the scans of which G was known.
  const std::vector<Error>& errors() const { return errors_; }
  void forget_errors() { errors_.clear(); }
  /// Samples of `source` that were published.
  int published(sensor::Source source) const { return published_[static_cast<std::size_t>(source)]; }

 private:
  void sense(double seconds);
  void publish(sensor::Source source, double seconds, const bus::Topic& topic, Bytes cdr);
  Stamp stamp(sensor::Source source, double seconds) const;
  void on_odometry(const Bytes& cdr);
  void on_position(const Bytes& cdr);

  Options options_;
  std::unique_ptr<bus::LocalNetwork> network_;
  bus::Bus* bus_ = nullptr;
  std::unique_ptr<agent::Agent> agent_;
  std::vector<bus::Handle> handles_;
  std::int64_t ticks_ = 0;
  std::array<int, sensor::kSources> published_{};
  std::optional<Pose> T_odom_first_, T_enu_first_;
  double last_odometry_error_ = 0.0;
  std::vector<Error> errors_;
};

}  // namespace fleetmap::testing
