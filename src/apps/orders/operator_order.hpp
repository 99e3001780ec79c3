#pragma once

#include <iosfwd>
#include <vector>

#include "command_result.hpp"
#include "operator_fleet.hpp"
#include "order_in_force.hpp"
#include "order_options.hpp"

namespace fleetmap::apps {

/// An order, and the robots that must confirm it.
struct AddressedOrder {
  std::vector<AgentId> robots;
  Order order;
};

/// To the robot that the options name, or to all: hold, resume or home. Fails for a robot that the fleet has
/// not.
Result<AddressedOrder> driving_order(const OperatorFleet& fleet, const OrderOptions& options,
                                     messages::HoldOrder::Kind kind);
/// To the robot that is to give the row, and to the one that is to drive it.
Result<AddressedOrder> row_order(const OperatorFleet& fleet, const OrderOptions& options);

/// Sends the order to robots over DDS until all of them have confirmed it, a signal comes or the time is up.
/// Prints to `out` who confirmed what, to standard error who did not; kFailed if anyone did not.
CommandResult<ExitCode> order_driving(const OrderOptions& options, messages::HoldOrder::Kind kind,
                                      std::ostream& out);
CommandResult<ExitCode> order_row(const OrderOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
