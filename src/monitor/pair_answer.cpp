#include "fleetmap/monitor/pair_answer.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/graph/located_nodes.hpp"
#include "fleetmap/monitor/reasons.hpp"

namespace fleetmap::monitor {
namespace {

using graph::AlignmentStatus;
using Pair = std::pair<AgentId, AgentId>;

Pair pair_of(const AgentId& a, const AgentId& b) { return a < b ? Pair(a, b) : Pair(b, a); }

std::string metres(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), value < 10.0 ? "%.1f m" : "%.0f m", value);
  return buffer.data();
}

std::string times(std::size_t count) { return count == 1 ? "once" : std::to_string(count) + " times"; }

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// All that is known of two robots.
struct Evidence {
  std::vector<const Attempt*> attempts;
  std::map<AlignmentStatus, std::size_t> alignments;
};

struct PlacedNode {
  NodeId id;
  Eigen::Vector3d p_enu;
};

/// The fleet, sorted so that each pair's answer is a look-up.
struct Facts {
  double search_radius_m = 0.0;
  std::set<AgentId> logs;
  std::map<Pair, Evidence> pairs;
  std::map<AgentId, std::vector<PlacedNode>> placed;
  std::map<AgentId, std::size_t> nodes;
  std::map<AgentId, std::set<std::size_t>> components;  ///< indices in Placement::components
  std::map<AgentId, bool> located;                      ///< some node of the robot has a place on Earth
};

Facts facts_of(const FleetView& view) {
  Facts facts;
  facts.search_radius_m = view.search_radius_m;
  facts.logs = {view.logs.begin(), view.logs.end()};
  for (const Attempt& attempt : view.attempts)
    facts.pairs[pair_of(attempt.target.agent, attempt.source.agent)].attempts.push_back(&attempt);
  const Outcomes outcomes = outcomes_of(view);
  for (const graph::Alignment& alignment : view.alignments) {
    const auto outcome = outcomes.find({alignment.computed_by, alignment.seq});
    const AlignmentStatus status = outcome == outcomes.end() ? AlignmentStatus::undecided : outcome->second;
    ++facts.pairs[pair_of(alignment.i.agent, alignment.j.agent)].alignments[status];
  }
  const auto floating = graph::not_georeferenced(view.nodes, view.placement.components);
  const std::set<graph::FrameId> nowhere(floating.begin(), floating.end());
  for (std::size_t k = 0; k < view.placement.components.size(); ++k) {
    for (const graph::FrameId& frame : view.placement.components[k]) facts.components[frame.agent].insert(k);
  }
  for (const graph::Node& node : view.nodes) {
    ++facts.nodes[node.id.agent];
    const auto placed = view.placement.T_enu_node.find(node.id);
    if (placed == view.placement.T_enu_node.end() || nowhere.contains(node.frame())) continue;
    facts.located[node.id.agent] = true;
    facts.placed[node.id.agent].push_back({node.id, placed->second.translation()});
  }
  return facts;
}

/// In the horizontal plane, as loop candidates are searched.
void find_nearest(const std::vector<PlacedNode>& a, const std::vector<PlacedNode>& b, PairAnswer& answer) {
  double min_squared = std::numeric_limits<double>::infinity();
  for (const PlacedNode& one : a) {
    for (const PlacedNode& other : b) {
      const double squared = (one.p_enu - other.p_enu).head<2>().squaredNorm();
      if (squared >= min_squared) continue;
      min_squared = squared;
      answer.nearest = std::pair(one.id, other.id);
    }
  }
  if (answer.nearest) answer.nearest_m = std::sqrt(min_squared);
}

std::string listed(const std::vector<Reason>& reasons) {
  constexpr std::size_t kShown = 3;
  std::string said;
  for (std::size_t k = 0; k < std::min(kShown, reasons.size()); ++k)
    said += (k == 0 ? "" : "; ") + times(reasons[k].count) + " because " + reasons[k].text;
  if (reasons.size() > kShown) said += "; and for other reasons";
  return said;
}

std::string unused_because(const std::map<AlignmentStatus, std::size_t>& alignments) {
  std::string said;
  for (const auto& [status, count] : alignments) {
    if (status != AlignmentStatus::used)
      append_to_list(said, std::to_string(count) + ": " + fate(status), "; ");
  }
  return said;
}

/// The distance of their nearest nodes, as a clause.
std::string nearest_clause(const PairAnswer& answer) {
  return "their nodes came within " + metres(*answer.nearest_m) + " (" + to_string(answer.nearest->first) +
         " and " + to_string(answer.nearest->second) + ")";
}

std::string listed(const std::vector<AgentId>& robots, const char* last_separator) {
  std::string names;
  for (const AgentId& robot : robots) append_to_list(names, robot.str(), last_separator);
  return names;
}

/// A pair is registered by one of its two robots alone, so the other logs add nothing.
void explain_near(const Facts& facts, PairAnswer& answer) {
  const std::string both = answer.a.str() + " and " + answer.b.str();
  if (answer.missing_logs.empty()) {
    answer.state = PairState::not_tried;
    answer.text = both + " were near, but neither registered the other's nodes: " + nearest_clause(answer) +
                  "; the radio may have failed there, or other pairs were worth more";
    return;
  }
  answer.state = PairState::not_known;
  answer.text = both + " were near: " + nearest_clause(answer) + "; whether " +
                listed(answer.missing_logs, " or ") + " registered them is not known here, since ";
  const std::vector<AgentId> logs(facts.logs.begin(), facts.logs.end());
  answer.text += logs.empty() ? "no log of registrations is here"
                              : "only " + listed(logs, " and ") + "'s log of registrations is here";
  answer.text += ": open the page of " + listed(answer.missing_logs, " or ");
}

/// Why no alignment of the two is used. The rules stand in the order in which a pair comes to be joined,
/// from the end: an answer further down means that less was achieved.
void explain_no_alignment(const Facts& facts, const Evidence& known, PairAnswer& answer) {
  const std::string both = answer.a.str() + " and " + answer.b.str();
  if (!known.alignments.empty()) {
    answer.state = PairState::alignments_unused;
    std::size_t found = 0;
    for (const auto& [status, count] : known.alignments) found += count;
    answer.text = "registration found " + counted(found, "alignment") + " of " + both +
                  ", but none is used: " + unused_because(known.alignments);
  } else if (!known.attempts.empty()) {
    const std::vector<Reason> reasons = reasons_of(known.attempts);
    const bool overlap =
        !reasons.empty() && reasons.front().text.find("overlap too little") != std::string::npos;
    answer.state = overlap ? PairState::no_overlap : PairState::rejected;
    answer.text = both + " were registered " + times(known.attempts.size()) +
                  (overlap ? ", near each other but without enough overlap: " : ", and none was accepted: ") +
                  listed(reasons);
    if (!answer.missing_logs.empty())
      answer.text += "; " + listed(answer.missing_logs, " and ") +
                     " may have tried more: " + (answer.missing_logs.size() == 1 ? "its" : "their") +
                     " registrations.csv is not here";
  } else if (!facts.nodes.contains(answer.a) || !facts.nodes.contains(answer.b)) {
    const AgentId& missing = facts.nodes.contains(answer.a) ? answer.b : answer.a;
    answer.state = PairState::nothing_known;
    answer.text = "no node of " + missing.str() + " is held here: it made none, or was never heard";
  } else if (!answer.nearest_m) {
    const AgentId& lost = facts.located.contains(answer.a) ? answer.b : answer.a;
    answer.state = PairState::not_tied;
    answer.text = lost.str() +
                  " has no place on Earth: it had no GPS, and no alignment ties its frame to one "
                  "that had, so whether the two met cannot be told";
  } else if (*answer.nearest_m > facts.search_radius_m) {
    answer.state = PairState::never_near;
    answer.text = both + " were never near each other: " + nearest_clause(answer) +
                  ", and only nodes within " + metres(facts.search_radius_m) + " are registered";
  } else {
    explain_near(facts, answer);
  }
}

/// Robots that have alignments in use with both.
std::string go_betweens(const Facts& facts, const AgentId& a, const AgentId& b) {
  const auto linked = [&](const AgentId& one, const AgentId& other) {
    const auto known = facts.pairs.find(pair_of(one, other));
    return known != facts.pairs.end() && known->second.alignments.contains(AlignmentStatus::used);
  };
  std::string names;
  for (const auto& [robot, count] : facts.nodes) {
    if (robot != a && robot != b && linked(robot, a) && linked(robot, b)) append_to_list(names, robot.str());
  }
  return names.empty() ? "others" : names;
}

PairAnswer answer_of(const Facts& facts, const AgentId& a, const AgentId& b) {
  PairAnswer answer;
  answer.a = a;
  answer.b = b;
  for (const AgentId& robot : {a, b}) {
    if (!facts.logs.contains(robot)) answer.missing_logs.push_back(robot);
  }
  const auto known = facts.pairs.find({a, b});
  const Evidence evidence = known == facts.pairs.end() ? Evidence{} : known->second;
  answer.attempts = evidence.attempts.size();
  answer.accepted =
      static_cast<std::size_t>(std::ranges::count(evidence.attempts, "accepted", &Attempt::verdict));
  if (const auto used = evidence.alignments.find(AlignmentStatus::used); used != evidence.alignments.end())
    answer.used = used->second;
  if (facts.placed.contains(a) && facts.placed.contains(b))
    find_nearest(facts.placed.at(a), facts.placed.at(b), answer);
  if (answer.used > 0) {
    answer.state = PairState::joined;
    answer.text = counted(answer.used, "alignment") + " in use " + (answer.used == 1 ? "joins" : "join") +
                  " " + a.str() + " and " + b.str();
  } else {
    explain_no_alignment(facts, evidence, answer);
    const auto component = [&](const AgentId& robot) {
      const auto found = facts.components.find(robot);
      return found == facts.components.end() ? std::set<std::size_t>{} : found->second;
    };
    const auto of_a = component(a), of_b = component(b);
    if (std::ranges::any_of(of_a, [&](std::size_t k) { return of_b.contains(k); })) {
      answer.state = PairState::joined_by_others;
      answer.text = "joined through " + go_betweens(facts, a, b) + "; directly not, since " + answer.text;
    }
  }
  // Names are case-sensitive.
  const bool is_name = answer.text.starts_with(a.str() + " ") || answer.text.starts_with(b.str() + " ");
  if (!is_name)
    answer.text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(answer.text.front())));
  answer.text += '.';
  return answer;
}

}  // namespace

const char* to_string(PairState state) {
  switch (state) {
    case PairState::joined:
      return "joined";
    case PairState::joined_by_others:
      return "joined through others";
    case PairState::alignments_unused:
      return "alignments not used";
    case PairState::rejected:
      return "registrations rejected";
    case PairState::no_overlap:
      return "near, but no overlap";
    case PairState::not_tried:
      return "near, but not registered";
    case PairState::not_known:
      return "near, registrations not known here";
    case PairState::never_near:
      return "never near";
    case PairState::not_tied:
      return "frames not tied";
    case PairState::nothing_known:
      return "never heard";
  }
  return "";
}

std::vector<PairAnswer> explain_pairs(const FleetView& view) {
  const Facts facts = facts_of(view);
  const std::vector<AgentId> robots = robots_of(view);
  std::vector<PairAnswer> answers;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = i + 1; j < robots.size(); ++j)
      answers.push_back(answer_of(facts, robots[i], robots[j]));
  }
  return answers;
}

}  // namespace fleetmap::monitor
