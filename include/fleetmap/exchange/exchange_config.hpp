#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_transfer_config.hpp"
#include "fleetmap/exchange/item_proof.hpp"
#include "fleetmap/exchange/long_range_config.hpp"
#include "fleetmap/exchange/reconcile_config.hpp"
#include "fleetmap/exchange/submap_transfer_config.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::Message;

/// Fleet, link budget and periods of the transport of one robot.
struct ExchangeConfig {
  std::vector<AgentId> fleet;  ///< every agent, this one too; messages and items of others are refused
  /// The robots that share this robot's radio and its budget, this one included. The others use other radios
  /// and are heard over the short range only. Empty: all robots of the fleet.
  std::vector<AgentId> on_radio;
  LongRangeConfig long_range;
  CloudTransferConfig clouds;
  ReconcileConfig reconcile;
  SubmapTransferConfig submaps;
  Duration status_period = std::chrono::seconds(5);
  /// Bytes of a message as the bus publishes it (CDR with its encapsulation header).
  std::function<std::size_t(const Message&)> payload_size;
  /// Signs own items and verifies those of others, which are then accepted only with the signature of their
  /// maker. Null: items have no signatures, and anyone can make them in any name.
  std::shared_ptr<const ItemAuthenticator> authenticator;
  Status validate(const AgentId& self) const;
  const std::vector<AgentId>& all_on_radio() const { return on_radio.empty() ? fleet : on_radio; }
};

/// The configuration with `on_radio` filled in and with the periods adapted to the number of robots on this
/// radio and to its budget. Status and digests go to every other robot, so their traffic grows with the
/// square of the number of robots and leaves less for clouds. Where it exceeds the share that it has with
/// five robots on 145 kbit/s, the messages are sent less often, and requests wait longer for a silent robot.
ExchangeConfig for_fleet(ExchangeConfig config);
/// `period` as for_fleet() stretches those of the exchange: no shorter than it is.
Duration for_fleet(Duration period, const ExchangeConfig& config);

}  // namespace fleetmap::exchange
