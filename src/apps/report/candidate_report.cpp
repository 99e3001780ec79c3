#include "candidate_report.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace fleetmap::apps {
namespace {

using monitor::PairCandidates;
using nlohmann::json;

constexpr const char* kKey = "candidates_with";

constexpr std::array<std::pair<const char*, std::uint64_t PairCandidates::*>, 10> kCounts{
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

PairCandidates candidates_between(const AgentId& by, const AgentId& with,
                                  const graph::CandidateCounts& counts) {
  PairCandidates candidates;
  static_cast<graph::CandidateCounts&>(candidates) = counts;
  candidates.by = by;
  candidates.with = with;
  return candidates;
}

/// Adds those of the robot whose part of a report this is.
void add_reported(const json& report, const AgentId& by, std::vector<PairCandidates>& all) {
  if (!report.is_object() || !report.contains(kKey) || !report[kKey].is_object()) return;
  for (const auto& [name, counts] : report[kKey].items()) {
    const auto with = AgentId::parse(name);
    if (!with || !counts.is_object()) continue;
    PairCandidates one = candidates_between(by, *with, {});
    one.ended = true;
    for (const auto& [key, count] : kCounts) {
      if (const auto found = counts.find(key); found != counts.end() && found->is_number_unsigned())
        one.*count = found->get<std::uint64_t>();
    }
    all.push_back(one);
  }
}

}  // namespace

std::vector<PairCandidates> candidates_of(const agent::Agent& agent) {
  std::vector<PairCandidates> all;
  for (const auto& [peer, now] : agent.candidates_by_peer()) {
    PairCandidates one = candidates_between(agent.config().id, peer, now);
    one.heard = now.heard;
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

std::vector<PairCandidates> reported_candidates(const json& report, const AgentId& self) {
  std::vector<PairCandidates> all;
  if (!report.is_object()) return all;
  add_reported(report, self, all);
  if (const auto agents = report.find("agents"); agents != report.end() && agents->is_object()) {
    for (const auto& [name, agent] : agents->items()) {
      if (const auto by = AgentId::parse(name)) add_reported(agent, *by, all);
    }
  }
  return all;
}

}  // namespace fleetmap::apps
