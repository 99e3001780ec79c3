#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <variant>
#include <vector>

#include "exchange/recorded_cloud_client.hpp"
#include "exchange/robots.hpp"
#include "fleetmap/exchange/exchange.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::exchange {

inline AgentStatus status_of(const AgentId& robot, bool busy) {
  AgentStatus status;
  status.from = robot;
  status.busy = busy;
  return status;
}

/// The exchange of r1, of a fleet of three, whose time and messages the test decides.
class LoneExchange : public ::testing::Test {
 protected:
  static ExchangeConfig config() {
    ExchangeConfig config;
    config.fleet = {kSelf, kPeer, kThird};
    config.payload_size = [](const Message&) { return std::size_t{10}; };
    return config;
  }
  Exchange make() { return std::move(Exchange::make(config(), store_, closer_, kStart).value()); }
  template <class Wanted>
  std::vector<Wanted> taken() {
    std::vector<Wanted> found;
    for (const Event& event : exchange_.take_events()) {
      if (const auto* wanted = std::get_if<Wanted>(&event)) found.push_back(*wanted);
    }
    return found;
  }
  /// Messages of one kind that a second of ticks from `from` on sends.
  template <class Wanted>
  std::vector<Outgoing> sent(Stamp from) {
    std::vector<Outgoing> found;
    for (int k = 0; k < 10; ++k) {
      for (const Outgoing& outgoing : exchange_.tick(from + k * std::chrono::milliseconds(100))) {
        if (std::holds_alternative<Wanted>(outgoing.message)) found.push_back(outgoing);
      }
    }
    return found;
  }

  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  RecordedCloudClient closer_;
  Exchange exchange_ = make();
};

}  // namespace fleetmap::exchange
