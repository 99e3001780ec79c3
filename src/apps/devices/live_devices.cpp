#include "live_devices.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "fleetmap/geometry/geoid.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/sensor/ellipsoidal_height.hpp"
#include "fleetmap/sensor/gpsd_fixes.hpp"
#include "fleetmap/sensor/mavlink_sensors.hpp"
#include "fleetmap/sensor/nmea_fixes.hpp"
#include "recordings/sample_player.hpp"

namespace fleetmap::apps {
namespace {

/// Logs a count when it reaches 1, 10, 100 and each further 1000.
class CountLog {
 public:
  explicit CountLog(std::string name) : name_(std::move(name)) {}
  void operator()(const std::string& what, std::uint64_t count) {
    std::uint64_t& next = next_.try_emplace(what, 1).first->second;
    if (count < next) return;
    spdlog::warn("{} ({} so far): {}", name_, count, what);
    while (next <= count) next = next < 1000 ? next * 10 : next + 1000;
  }

 private:
  std::string name_;
  std::map<std::string, std::uint64_t> next_;
};

constexpr const char* kAboveSea =
    "fixes whose height is above mean sea level, not above the ellipsoid; gps.geoid: egm2008-5 converts them";

/// The topics that samples go to.
struct Topics {
  bus::Bus& bus;
  bus::Topic imu, fix;
  std::optional<Geoid> geoid;
  std::shared_ptr<bool> said = std::make_shared<bool>(false);  ///< that a height could not be converted

  void publish(const sensor::DeviceSamples& samples, bool with_imu = true, bool with_fixes = true) const {
    for (const sensor::Imu& sample : samples.imu) {
      if (with_imu) bus.publish(imu, ros_codec::encode(sample));
    }
    for (sensor::Fix sample : samples.fixes) {
      if (!with_fixes) continue;
      const Status converted = geoid ? sensor::make_ellipsoidal(sample, *geoid) : Status{};
      if (!converted && !std::exchange(*said, true)) spdlog::error("{}", converted.error().message);
      bus.publish(fix, ros_codec::encode(sample));
    }
  }
};

std::unique_ptr<DeviceInput> nmea_input(const agent::SerialPort& serial, const Topics& topics) {
  auto on_bytes = [topics, fixes = sensor::NmeaFixes(), log = CountLog(serial.path.string())](
                      ByteView bytes, Stamp arrival) mutable {
    topics.publish(fixes.add(bytes, arrival));
    log("sentences with a wrong checksum; check the baud rate and the cable",
        fixes.counters().wrong_checksums);
    log("sentences that are cut", fixes.counters().cut);
    log("sentences with a malformed field", fixes.counters().malformed);
    if (!topics.geoid) log(kAboveSea, fixes.above_sea_level());
  };
  return std::make_unique<DeviceInput>(serial, DeviceInput::Handlers{.on_bytes = std::move(on_bytes)});
}

std::unique_ptr<DeviceInput> gpsd_input(const agent::TcpServer& server, const Topics& topics) {
  auto fixes = std::make_shared<sensor::GpsdFixes>();
  auto on_bytes = [topics, fixes, name = to_string(server), log = CountLog(to_string(server))](
                      ByteView bytes, Stamp) mutable {
    topics.publish(fixes->add(bytes));
    log("lines that are no reports of gpsd", fixes->counters().malformed);
    if (!topics.geoid) log(kAboveSea, fixes->counters().above_sea_level);
    for (const std::string& error : fixes->take_errors()) log("gpsd reports: " + error, 1);
  };
  auto greeting = [fixes] {
    fixes->begin();
    const ByteView watch = bytes_of(sensor::kGpsdWatch);
    return Bytes(watch.begin(), watch.end());
  };
  return std::make_unique<DeviceInput>(
      server, DeviceInput::Handlers{.on_bytes = std::move(on_bytes), .greeting = std::move(greeting)});
}

std::unique_ptr<DeviceInput> mavlink_input(const agent::DeviceConfig& config, const Topics& topics) {
  const std::string name = to_string(*config.mavlink);
  auto sensors = std::make_shared<sensor::MavlinkSensors>();
  auto on_bytes = [topics, sensors, config, log = CountLog(name)](ByteView bytes, Stamp arrival) mutable {
    topics.publish(sensors->add(bytes, arrival), config.mavlink_imu, config.mavlink_gps);
    const sensor::MavlinkSensors::Counters counters = sensors->counters();
    log("frames with a wrong checksum; check the baud rate and the cable", counters.frames.wrong_checksums);
    log("frames with unknown flags", counters.frames.incompatible);
    log("messages of another system than the first that was heard", counters.of_other_systems);
    log("messages without a usable value", counters.unusable);
    log("messages with a time of GPS before the first SYSTEM_TIME", counters.unplaced);
    log("the autopilot was switched on again", counters.restarts);
    if (config.mavlink_gps && !topics.geoid) log(kAboveSea, counters.above_sea_level);
  };
  auto request = [sensors](Stamp now) { return sensors->clock_request(now); };
  return std::make_unique<DeviceInput>(
      *config.mavlink, DeviceInput::Handlers{.on_bytes = std::move(on_bytes), .request = std::move(request)});
}

}  // namespace

Result<std::vector<std::unique_ptr<DeviceInput>>> publish_devices(const agent::PerceptionConfig& config,
                                                                  bus::Bus& bus) {
  const agent::DeviceConfig& devices = config.devices;
  std::vector<std::unique_ptr<DeviceInput>> inputs;
  if (!devices.nmea && !devices.gpsd && !devices.mavlink) return inputs;
  const auto all = sensor_topics(config.topics);
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(all, name, &bus::Topic::name);
  };
  std::optional<Geoid> geoid;
  if (devices.geoid) {
    auto loaded = Geoid::load(*devices.geoid);
    if (!loaded) return failure("gps.geoid: " + loaded.error().message);
    geoid = std::move(*loaded);
  }
  const Topics topics{bus, named(config.topics.imu), named(config.topics.fix), std::move(geoid)};
  bus.advertise(topics.imu);
  bus.advertise(topics.fix);
  if (devices.nmea) inputs.push_back(nmea_input(*devices.nmea, topics));
  if (devices.gpsd) inputs.push_back(gpsd_input(*devices.gpsd, topics));
  if (devices.mavlink) inputs.push_back(mavlink_input(devices, topics));
  return inputs;
}

}  // namespace fleetmap::apps
