#include "fleetmap/monitor/pair_candidates.hpp"

#include "candidates_json.hpp"
#include "fleetmap/core/text_list.hpp"

namespace fleetmap::monitor {
namespace {

/// "1 waits", "3 wait"
std::string some(std::uint64_t count, const char* one, const char* more) {
  return std::to_string(count) + ' ' + (count == 1 ? one : more);
}

std::string waiting(const PairCandidates& all) {
  if (all.ended) return some(all.waiting, "was", "were") + " still waiting at its end";
  if (!all.heard) return some(all.waiting, "waits", "wait") + " until " + all.with.str() + " is heard again";
  return some(all.waiting, "waits", "wait") + " for complete clouds or for a turn on the radio";
}

std::string under_way(const PairCandidates& all) {
  if (all.ended)
    return some(all.requested, "was", "were") + " requested, and the cloud had not come at its end";
  return some(all.requested, "was", "were") + " requested, and the cloud is under way";
}

/// Those that were never registered.
std::string unregistered(const PairCandidates& all) {
  std::string said;
  const auto add = [&said](const std::string& part) { append_to_list(said, part, "; "); };
  if (all.waiting > 0) add(waiting(all));
  if (all.requested > 0) add(under_way(all));
  if (all.not_received > 0)
    add(some(all.not_received, "was", "were") + " not registered, since the cloud did not come");
  if (all.uninformative > 0)
    add(some(all.uninformative, "was", "were") +
        " dropped, since the radio was busy and the alignment would have added too little");
  if (all.overflowed > 0) add(some(all.overflowed, "was", "were") + " dropped, since too many waited");
  if (all.redundant > 0)
    add(some(all.redundant, "was", "were") + " left out beside another one of the same place");
  return said;
}

std::string registered(const PairCandidates& all) {
  std::string said;
  const auto add = [&said](const std::string& part) { append_to_list(said, part, "; "); };
  if (all.aligned > 0) add(some(all.aligned, "is", "are") + " aligned");
  if (all.registering > 0) add(some(all.registering, "is", "are") + " being registered");
  if (all.rejected > 0) add(some(all.rejected, "was", "were") + " registered without an alignment");
  return said;
}

}  // namespace

std::string sentence(const PairCandidates& all) {
  std::string said = registered(all);
  if (const std::string rest = unregistered(all); !rest.empty()) append_to_list(said, rest, "; ");
  if (said.empty()) said = "there is none any more";
  if (all.to_be_retried > 0)
    append_to_list(said,
                   std::to_string(all.to_be_retried) + " of those that failed " +
                       (all.ended ? "would have been tried again" : "will be tried again"),
                   "; ");
  return "Candidates of " + all.by.str() + " with " + all.with.str() + ": " + said + ".";
}

nlohmann::json candidates_json(const std::vector<PairCandidates>& all) {
  nlohmann::json list = nlohmann::json::array();
  for (const PairCandidates& one : all)
    list.push_back({{"by", one.by.str()}, {"with", one.with.str()}, {"sentence", sentence(one)}});
  return list;
}

}  // namespace fleetmap::monitor
