#include "fleetmap/recording/survey.hpp"

#include <variant>

#include "fleetmap/sensor/sensor_health.hpp"

namespace fleetmap::recording {
namespace {

constexpr Duration kSurveyed = std::chrono::minutes(2);

/// Decides the gyro's unit by the checks that samples pass later.
class GyroUnit {
 public:
  /// False when it is decided.
  bool add(Sample sample) {
    if (auto* imu = std::get_if<sensor::Imu>(&sample)) {
      health_.check(*imu);
    } else if (auto* wheel = std::get_if<sensor::Wheel>(&sample)) {
      health_.check(*wheel);
    }
    return !health_.gyro_unit_decided();
  }
  const std::optional<std::string>& in_degrees() const { return health_.gyro_in_degrees(); }

 private:
  sensor::SensorHealth health_;
};

}  // namespace

Result<Survey> survey(const std::filesystem::path& recording, const ReaderConfig& config) {
  auto reader = open(recording, config, ScanContent::kStampOnly);
  if (!reader) return tl::unexpected(reader.error());
  LogClockFinder clock;
  GyroUnit gyro;
  std::optional<Stamp> begun;
  bool clock_open = true, gyro_open = true;
  while (clock_open || gyro_open) {
    auto sample = (*reader)->next();
    if (!sample || !*sample) break;  // the player reports the reason
    const auto recorded = (*reader)->recorded();
    if (!recorded) return Survey{};
    if (!begun) begun = recorded;
    clock_open = clock_open && clock.add(**sample, *recorded);
    gyro_open = gyro_open && *recorded - *begun < kSurveyed && gyro.add(std::move(**sample));
  }
  return Survey{clock.clock(), (*reader)->frames(), gyro.in_degrees()};
}

}  // namespace fleetmap::recording
