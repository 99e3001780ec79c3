#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/candidate_scheduler.hpp"
#include "fleetmap/loop_closure/loop_closing_config.hpp"
#include "fleetmap/loop_closure/own_path_config.hpp"
#include "fleetmap/loop_closure/registration_record.hpp"
#include "fleetmap/registration/registration_config.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::loop_closure {

class OdometryCandidates;
class RegistrationWorker;
class SessionCandidates;

/// Loop closing of one robot: candidates with its own path, its earlier sessions and other robots become
/// registrations, and these alignments.
/// nodes, alignments, solution of the graph, clouds -> candidates -> clouds wanted, registrations ->
/// alignments
class LoopClosing {
 public:
  /// Receivers of the results, called on the bus's callback thread.
  struct Outputs {
    /// Every registration that ended, before anything else is done with it.
    std::function<void(const Registration&)> record;
    /// An alignment without its sequence number: to be stored and sent. False: it was refused.
    std::function<bool(const graph::Alignment&)> publish;
    /// An alignment was published, and its consequences are complete.
    std::function<void()> published;
  };

  /// `bus` and `store` outlive this, and this outlives the jobs of the bus.
  LoopClosing(const LoopClosingConfig& config, bus::Bus& bus, store::Store& store, Outputs outputs);
  ~LoopClosing();
  LoopClosing(const LoopClosing&) = delete;
  LoopClosing& operator=(const LoopClosing&) = delete;

  /// The interface to the transport. Lives as long as this.
  exchange::CloudClient& scheduler() { return scheduler_; }
  CandidateStats stats() const { return scheduler_.stats(); }
  /// By the other robot, as CandidateScheduler has them.
  std::map<AgentId, PeerCandidates> by_peer() const { return scheduler_.by_peer(bus_.now()); }
  const RegistrationCounters& registrations() const;

  /// A session of this robot begins: its nodes in the store are of earlier ones.
  void begin_session(std::uint16_t session);
  /// A node of this robot was made and stored.
  void on_own_node(const graph::Node& node);
  /// A node of an earlier session was received from others.
  void on_returned_node(const graph::Node& node);
  /// The alignments that the fleet's graph uses now (graph::Placement::used).
  void on_used_alignments(std::span<const graph::Alignment> used) { scheduler_.on_used_alignments(used); }
  /// Starts the registration of the clouds that were received.
  void register_received();
  /// Makes the encoded cloud around an own node for a peer; nothing if that fails. `done` is called in any
  /// case.
  void make_cloud(const graph::Node& node, std::function<void(std::optional<Bytes>)> done);
  /// No job is under way.
  bool idle() const;

 private:
  void register_own(const LoopCandidate& candidate);
  void start(const ReceivedCloud& received);
  void conclude(const Registration& registration);

  LoopClosingConfig config_;
  bus::Bus& bus_;
  store::Store& store_;
  Outputs outputs_;
  std::uint16_t session_ = 0;
  CandidateScheduler scheduler_;
  std::unique_ptr<OdometryCandidates> own_path_;
  std::unique_ptr<SessionCandidates> sessions_;
  std::unique_ptr<RegistrationWorker> worker_;
};

}  // namespace fleetmap::loop_closure
