#include "run_summary.hpp"

#include <set>
#include <string>

#include "recordings/unread_parts.hpp"
#include "report.hpp"

namespace fleetmap::apps {
namespace {

void print_maps(std::ostream& out, const FleetOutcome& outcome, const std::filesystem::path& folder) {
  for (const auto& entry : outcome.agents) {
    const std::string id = entry.id.str();
    for (const std::string& unread : unread_parts(entry.recording)) out << id << ": " << unread << '\n';
    if (!entry.agent) out << id << ": switched off; what its store held:\n";
    if (!entry.results) {
      out << id << ": no map: " << (entry.problem.empty() ? "it made no node" : entry.problem) << '\n';
      continue;
    }
    out << id << ": " << (folder / id / "map.ply").string() << "  " << entry.results->map.points
        << " points from " << entry.results->map.submaps << " submaps, hash "
        << entry.results->map.hash.substr(0, 12) << '\n';
    if (!entry.problem.empty()) out << "    " << entry.problem << '\n';
    if (entry.agent) {
      if (const std::string lost = lost_ways(entry.agent->perception().odometry_counters()); !lost.empty())
        out << "    " << lost << '\n';
    }
    for (const graph::Alignment& used : entry.results->placement.used) {
      out << "    joined by " << to_string(used.i) << " - " << to_string(used.j) << ", E " << used.best().rmse
          << " m\n";
    }
  }
}

void print_quarantine(std::ostream& out, const FleetOutcome& outcome) {
  for (const auto& entry : outcome.agents) {
    if (!entry.results) continue;
    for (const auto& [agent, credit] : entry.results->placement.alignment_stats) {
      if (credit.quarantined)
        out << agent.str() << " is in quarantine: " << credit.outlier_sets
            << " alignments that it computed are false, and none of its is used\n";
    }
    break;
  }
}

void print_contradictions(std::ostream& out, const FleetOutcome& outcome) {
  for (const auto& entry : outcome.agents) {
    if (!entry.results) continue;
    for (const auto& [agent, contradiction] : entry.results->contradicting)
      out << agent.str() << " contradicts the fleet: " << to_string(contradiction) << '\n';
    break;
  }
}

void print_agreement(std::ostream& out, const FleetOutcome& outcome) {
  std::set<std::string> maps;  // of those who are there at the end
  for (const auto& entry : outcome.agents) {
    if (entry.agent) maps.insert(entry.results ? entry.results->map.hash : "none of " + entry.id.str());
  }
  out << (maps.size() <= 1 ? "all robots hold the same map\n" : "the robots' maps differ: see report.json\n");
  if (!outcome.exchange_ended) {
    out << "the exchange did not come to its end within exchange_timeout: maps may be incomplete, see "
           "report.json\n";
  }
}

void print_mission(std::ostream& out, const Completion& completion) {
  for (const Completion::Abandoned& row : completion.abandoned) {
    out << "row " << row.row << " was given up by " << row.agent.str() << ": "
        << (row.why.empty() ? "no robot was left to drive it" : row.why) << '\n';
  }
  if (completion.completed) {
    out << "mission completed after " << *completion.completed << " s\n";
  } else {
    out << "mission not completed: " << completion.why_not << '\n';
  }
}

}  // namespace

void print_summary(std::ostream& out, const FleetOutcome& outcome, const std::filesystem::path& folder) {
  print_maps(out, outcome, folder);
  print_quarantine(out, outcome);
  print_contradictions(out, outcome);
  print_agreement(out, outcome);
  if (outcome.completion) print_mission(out, *outcome.completion);
  out << "report: " << (folder / "report.html").string() << '\n';
}

}  // namespace fleetmap::apps
