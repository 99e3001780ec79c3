#pragma once

#include <vector>

#include "fleetmap/loop_closure/candidate_scheduler.hpp"

namespace fleetmap::loop_closure {

/// The pairs that the cloud of `theirs` starts to register.
inline std::vector<NodePair> on_cloud(CandidateScheduler& scheduler, const NodeId& theirs) {
  std::vector<NodePair> pairs;
  scheduler.on_cloud(theirs, Bytes(1, 1));
  for (const ReceivedCloud& received : scheduler.take_received()) pairs.push_back(received.candidate.pair());
  return pairs;
}

}  // namespace fleetmap::loop_closure
