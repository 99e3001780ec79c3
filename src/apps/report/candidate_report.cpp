#include "candidate_report.hpp"

#include <array>
#include <fstream>
#include <utility>

namespace fleetmap::apps {
namespace {

using monitor::PairCandidates;
using nlohmann::json;

constexpr const char* kKey = "candidates_with";

constexpr std::array<std::pair<const char*, std::size_t PairCandidates::*>, 10> kCounts{
    {{"waiting", &PairCandidates::waiting},
     {"requested", &PairCandidates::requested},
     {"registering", &PairCandidates::registering},
     {"aligned", &PairCandidates::aligned},
     {"rejected", &PairCandidates::rejected},
     {"not_received", &PairCandidates::not_received},
     {"to_be_retried", &PairCandidates::to_be_retried},
     {"redundant", &PairCandidates::redundant},
     {"overflowed", &PairCandidates::overflowed},
     {"uninformative", &PairCandidates::uninformative}}};

/// Adds those of the robot whose part of a report this is.
void add_reported(const json& report, const AgentId& by, std::vector<PairCandidates>& all) {
  if (!report.is_object() || !report.contains(kKey) || !report[kKey].is_object()) return;
  for (const auto& [name, counts] : report[kKey].items()) {
    const auto with = AgentId::parse(name);
    if (!with || !counts.is_object()) continue;
    PairCandidates one{.by = by, .with = *with, .ended = true};
    for (const auto& [key, count] : kCounts) {
      if (const auto found = counts.find(key); found != counts.end() && found->is_number_unsigned())
        one.*count = found->get<std::size_t>();
    }
    all.push_back(one);
  }
}

}  // namespace

std::vector<PairCandidates> candidates_of(const agent::Agent& agent) {
  std::vector<PairCandidates> all;
  for (const auto& [peer, now] : agent.candidates_by_peer()) {
    PairCandidates one{.by = agent.config().id, .with = peer, .heard = now.heard};
    one.waiting = now.waiting;
    one.requested = now.requested;
    one.registering = now.registering;
    one.aligned = now.aligned;
    one.rejected = now.rejected;
    one.not_received = now.not_received;
    one.to_be_retried = now.to_be_retried;
    one.redundant = now.redundant;
    one.overflowed = now.overflowed;
    one.uninformative = now.uninformative;
    all.push_back(one);
  }
  return all;
}

json candidates_json(const std::vector<PairCandidates>& candidates) {
  json all = json::object();
  for (const PairCandidates& one : candidates) {
    json& counts = all[one.with.str()];
    for (const auto& [key, count] : kCounts) counts[key] = one.*count;
  }
  return all;
}

std::vector<PairCandidates> reported_candidates(const std::filesystem::path& report, const AgentId& self) {
  std::vector<PairCandidates> all;
  std::ifstream file(report);
  if (!file) return all;
  const json read = json::parse(file, nullptr, false);
  if (!read.is_object()) return all;
  add_reported(read, self, all);
  if (const auto agents = read.find("agents"); agents != read.end() && agents->is_object()) {
    for (const auto& [name, agent] : agents->items()) {
      if (const auto by = AgentId::parse(name)) add_reported(agent, *by, all);
    }
  }
  return all;
}

}  // namespace fleetmap::apps
