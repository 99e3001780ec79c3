#include "merge_summary.hpp"

#include <algorithm>
#include <ostream>

#include "fleetmap/monitor/reasons.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::size_t kMaxNamed = 20;  ///< contested names of a store that are listed

void print_union(std::ostream& out, const std::string& file, const exchange::StoreUnion& added) {
  out << file << ": " << added.nodes << " nodes, " << added.submaps << " submaps, " << added.alignments
      << " alignments added, " << added.known << " items known\n";
  if (added.unproven > 0)
    out << file << ": " << added.unproven << " items left out: their makers did not sign them\n";
  if (added.unreadable > 0) out << file << ": " << added.unreadable << " submaps are damaged and left out\n";
  for (std::size_t k = 0; k < std::min(kMaxNamed, added.contested.size()); ++k)
    out << file << ": " << added.contested[k] << " has two contents; neither is used\n";
  if (added.contested.size() > kMaxNamed)
    out << file << ": and " << added.contested.size() - kMaxNamed << " more names\n";
  if (!added.contested.empty())
    out << file
        << ": two `fleetmap run` of one robot number their sessions alike; repeat one of them "
           "with --first-session 1000\n";
}

void print_pair(std::ostream& out, const DayPair& pair, const std::vector<std::string>& files, bool verbose) {
  const std::string &earlier = files[pair.earlier], &later = files[pair.later];
  std::size_t rejected = 0;
  for (const auto& [reason, count] : pair.alignments.rejected) rejected += count;
  if (pair.joined) {
    out << earlier << " and " << later << ": joined by " << pair.used << " alignments"
        << (pair.frames_shared ? " and the sessions that both have" : "");
  } else {
    out << earlier << " and " << later << ": NOT joined: " << pair.why_not;
  }
  out << " (" << pair.alignments.candidates << " candidates: " << pair.alignments.accepted << " accepted, "
      << pair.alignments.ambiguous << " ambiguous, " << rejected << " rejected)\n";
  const auto print = [&out](const std::string& reason, std::size_t count) {
    out << "  rejected " << count << " times: " << reason << '\n';
  };
  if (verbose) {
    for (const auto& [reason, count] : pair.alignments.rejected) print(reason, count);
  } else {
    for (const monitor::Reason& one : monitor::reasons_of(pair.alignments.rejected))
      print(one.text, one.count);
  }
}

}  // namespace

void print_summary(std::ostream& out, const MergedStore& merged, const std::vector<std::string>& files,
                   const std::string& written, bool verbose) {
  for (std::size_t k = 0; k < files.size(); ++k) print_union(out, files[k], merged.unions[k]);
  for (const DayPair& pair : merged.pairs) print_pair(out, pair, files, verbose);
  out << written << ": " << merged.placement.T_enu_node.size() << " nodes, " << merged.placement.used.size()
      << " alignments used, ";
  if (const std::size_t parts = merged.placement.components.size(); parts > 1) {
    out << parts << " parts that no alignment joins\n";
  } else {
    out << "all in one part\n";
  }
}

}  // namespace fleetmap::apps
