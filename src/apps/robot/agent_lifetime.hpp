#pragma once

#include <atomic>

#include "drive_watchdog.hpp"
#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "link_log.hpp"
#include "page/live_publisher.hpp"

namespace fleetmap::apps {

/// Runs the agent on its bus until `stop` is set or, with `exit_after_idle` (s, > 0), until its mission is
/// done or its sensors are silent and the exchange has ended. Then halts the robot and gives the others a few
/// seconds to take its last node. `watchdog`: of a robot that drives, else null; `page`: null without one.
void run_until_done(bus::DdsBus& bus, agent::Agent& agent, LinkLog& log, DriveWatchdog* watchdog,
                    LivePublisher* page, double exit_after_idle, const std::atomic<bool>& stop);

}  // namespace fleetmap::apps
