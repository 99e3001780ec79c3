#include "registration_replay.hpp"

#include <map>
#include <utility>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/loop_closure/registered_alignment.hpp"
#include "fleetmap/loop_closure/submap_drift.hpp"
#include "fleetmap/registration/registration_method.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "fleetmap/store/registration_log.hpp"

namespace fleetmap::run_evaluation {
namespace {

using registration::PreparedCloud;

/// The registrations that one agent logged; empty, with a note, where the log is missing or damaged.
std::vector<store::LoggedRegistration> logged_by(const AgentFolder& agent, std::vector<std::string>& notes) {
  const std::filesystem::path file = agent.directory / store::kRegistrationLogFile;
  if (!is_there(file)) {
    notes.push_back(file.string() + ": is missing; registrations of " + agent.id.str() +
                    " cannot be repeated by another method");
    return {};
  }
  auto log = store::RegistrationLog::open_read_only(file);
  auto logged = log ? log->read() : tl::unexpected(log.error());
  if (logged) return std::move(*logged);
  notes.push_back(logged.error().message);
  return {};
}

/// Robots of a run usually share a method. If they do not, the one that is not the default counts.
void add_method(const std::string& name, const AgentFolder& agent, RegistrationLogs& logs) {
  const auto method = registration::registration_method(name);
  if (!method) {
    logs.notes.push_back((agent.directory / store::kRegistrationLogFile).string() +
                         ": method of registration: " + method.error().message);
  } else if (*method != registration::Method::correlation) {
    logs.method = *method;
  }
}

registration::Prior prior_of(const store::LoggedPrior& logged) {
  return {logged.T_target_source, logged.sigma_translation_m, logged.sigma_yaw_rad,
          logged.sigma_tilt_rad,  logged.sigma_height_m,      logged.up_target};
}

/// Registers what one agent logged. A node's cloud is prepared once for all its partners.
class Replay {
 public:
  Replay(const StoredFleet& held, registration::Method method, ReplayedRegistrations& result)
      : held_(held), result_(result) {
    config_.method = method;
  }

  void add(const AgentId& agent, const store::LoggedRegistration& logged) {
    const graph::Node* target = held_.store.node(logged.target);
    const graph::Node* source = held_.store.node(logged.source);
    if (target == nullptr || source == nullptr) {  // of a robot whose nodes never came
      ++without_nodes_;
      return;
    }
    const double start = thread_cpu_seconds();
    const auto target_cloud = prepared(*target, logged.target_cloud);
    const auto source_cloud = prepared(*source, logged.source_cloud);
    if (!target_cloud || !source_cloud) {
      result_.notes.push_back((target_cloud ? source_cloud : target_cloud).error().message);
      return;
    }
    const auto registered = registration::register_clouds(*target_cloud, *source_cloud, config_,
                                                          prior_of(logged.prior), drifts(*target, *source));
    result_.cpu_seconds += thread_cpu_seconds() - start;
    keep(agent, logged, registered);
  }
  std::size_t without_nodes() const { return without_nodes_; }

 private:
  Result<PreparedCloud> prepared(const graph::Node& node, const Bytes& encoded) {
    const ContentHash name = content_hash(encoded);
    if (const auto known = clouds_.find(name); known != clouds_.end()) return known->second;
    const auto cloud = cloud::decode(encoded);
    if (!cloud) return failure("cloud of node " + to_string(node.id) + ": " + cloud.error().message);
    return clouds_.emplace(name, PreparedCloud(*cloud, node.up_in_base, config_)).first->second;
  }

  registration::Drifts drifts(const graph::Node& target, const graph::Node& source) const {
    if (!registration::uses_prior(config_.method)) return {};
    const double reach = static_cast<double>(registration::SpherizeConfig{}.radius_m);
    return {loop_closure::drift_around(held_.store, target, reach),
            loop_closure::drift_around(held_.store, source, reach)};
  }

  void keep(const AgentId& agent, const store::LoggedRegistration& logged,
            const registration::RegistrationResult& registered) {
    using registration::Verdict;
    ++(registered.verdict == Verdict::accepted    ? result_.accepted
       : registered.verdict == Verdict::ambiguous ? result_.ambiguous
                                                  : result_.rejected);
    if (registered.verdict == Verdict::rejected) return;
    graph::Alignment alignment = loop_closure::alignment_of(logged.target, logged.source, agent, registered);
    alignment.seq = next_seq_[agent]++;
    if (auto rounded = fleet_codec::quantised(alignment)) {
      result_.alignments.push_back(std::move(*rounded));
    } else {
      result_.notes.push_back(rounded.error().message);
    }
  }

  const StoredFleet& held_;
  ReplayedRegistrations& result_;
  registration::RegistrationConfig config_;
  std::size_t without_nodes_ = 0;
  std::map<ContentHash, PreparedCloud> clouds_;
  std::map<AgentId, std::uint32_t> next_seq_;
};

}  // namespace

RegistrationLogs read_registration_logs(const RunFolder& run) {
  RegistrationLogs logs;
  for (const AgentFolder& agent : run.agents) {
    std::vector<store::LoggedRegistration> logged = logged_by(agent, logs.notes);
    if (!logged.empty()) add_method(logged.front().method, agent, logs);
    logs.by_agent.emplace_back(agent.id, std::move(logged));
  }
  return logs;
}

ReplayedRegistrations register_again(const RegistrationLogs& logs, const StoredFleet& held,
                                     registration::Method method) {
  ReplayedRegistrations result;
  result.notes = logs.notes;
  Replay replay(held, method, result);
  for (const auto& [agent, logged] : logs.by_agent) {
    for (const store::LoggedRegistration& one : logged) replay.add(agent, one);
  }
  if (replay.without_nodes() > 0) {
    result.notes.push_back(
        std::to_string(replay.without_nodes()) +
        " logged registrations are of nodes that are not in the evaluated store; they were "
        "not registered again");
  }
  return result;
}

}  // namespace fleetmap::run_evaluation
