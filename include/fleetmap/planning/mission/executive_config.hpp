#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::planning {

/// When a robot takes over, gives away or gives up work. Times in s.
struct ExecutiveConfig {
  double lost_after = 60.0;  ///< without a report a robot counts as lost
  double listen = 12.0;      ///< a robot that begins far from its start (restarted) first listens for so long
  double orphan_wait = 15.0;   ///< a row unclaimed for so long is claimed by the first robot to notice; the
                               ///< next robot in the order of names waits as long again
  double offer_gain = 45.0;    ///< rows are given to an idle robot if the fleet is done so much earlier by it
  double offer_period = 30.0;  ///< at most so often
  double low_battery = 0.15;   ///< share of the battery at which a robot gives away its rows and drives home
  int row_attempts = 2;        ///< of one robot at one row
  int stuck_limit = 4;         ///< times stuck in a row without getting on until it calls itself stuck
  double stuck_retry = 30.0;   ///< a stuck robot tries again so often
  double stop_patience = 120.0;  ///< beyond what is planned, at a stop until it goes on without its partner
  double meeting_timeout =
      600.0;  ///< at the rendezvous with all rows done, beyond the planned exchange, until a robot ends alone
  Status validate() const;
};

}  // namespace fleetmap::planning
