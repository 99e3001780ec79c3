#include "bus/fleet.hpp"
#include "fleetmap/bus/local_network.hpp"

namespace fleetmap::bus::testing {
namespace {

class LocalFleet final : public Fleet {
 public:
  explicit LocalFleet(const FleetConfig& config) {
    LocalNetworkConfig network;
    network.long_range.queue_capacity = config.queue_capacity;
    network.short_range.queue_capacity = config.queue_capacity;
    network_ = LocalNetwork::create(network).value();
    for (std::size_t i = 0; i < config.robots; ++i) {
      const AgentId agent = AgentId::parse(std::string("r").append(std::to_string(i))).value();
      robots_.push_back(&network_->add_robot(agent));
      network_->set_position(agent, {10.0 * static_cast<double>(i), 0.0, 0.0});
    }
  }
  Bus& robot(std::size_t index) override { return *robots_.at(index); }
  bool run_until(const std::function<bool()>& done) override {
    const Stamp deadline = network_->now() + std::chrono::hours(1);
    while (!done()) {
      if (!network_->step() || network_->now() > deadline) return done();
    }
    return true;
  }
  bool connect(const Topic&, std::size_t, std::size_t, std::size_t, std::size_t) override { return true; }

 private:
  std::unique_ptr<LocalNetwork> network_;
  std::vector<Bus*> robots_;
};

}  // namespace

std::unique_ptr<Fleet> make_local_fleet(const FleetConfig& config) {
  return std::make_unique<LocalFleet>(config);
}

}  // namespace fleetmap::bus::testing
