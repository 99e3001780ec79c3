#include <stdexcept>

#include "bus/dds_domains.hpp"
#include "bus/fleet.hpp"
#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::bus::testing {
namespace {

constexpr auto kTurn = std::chrono::milliseconds(1);

/// Robots of this process over the loopback.
class DdsFleet final : public Fleet {
 public:
  explicit DdsFleet(const FleetConfig& config) {
    const std::uint32_t domain = first_test_domain();
    for (std::size_t i = 0; i < config.robots; ++i) {
      DdsBusConfig robot;
      robot.agent = AgentId::parse(std::string("r").append(std::to_string(i))).value();
      robot.qos_directory = FLEETMAP_SOURCE_DIR "/qos";
      robot.long_range.domain = domain;
      robot.short_range.domain = domain + 1;
      robot.onboard.domain = domain + 2 + static_cast<std::uint32_t>(i);
      for (DdsLinkConfig* radio : {&robot.long_range, &robot.short_range}) {
        radio->address = "127.0.0.1";
        radio->peers = {"127.0.0.1"};
        radio->queue_messages = config.queue_capacity;
      }
      auto bus = DdsBus::create(robot);
      if (!bus) throw std::runtime_error(bus.error().message);
      robots_.push_back(*std::move(bus));
    }
  }
  Bus& robot(std::size_t index) override { return *robots_.at(index); }
  bool run_until(const std::function<bool()>& done) override {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      for (const auto& robot : robots_) {
        if (robot->run_until(done, kTurn)) return true;
      }
    }
    return done();
  }
  bool connect(const Topic& topic, std::size_t from, std::size_t readers, std::size_t to,
               std::size_t writers) override {
    robots_.at(from)->advertise(topic);
    return run_until([&] {
      return robots_.at(from)->matches(topic).readers == readers &&
             robots_.at(to)->matches(topic).writers == writers;
    });
  }

 private:
  std::vector<std::unique_ptr<DdsBus>> robots_;
};

}  // namespace

std::unique_ptr<Fleet> make_dds_fleet(const FleetConfig& config) {
  return std::make_unique<DdsFleet>(config);
}

}  // namespace fleetmap::bus::testing
