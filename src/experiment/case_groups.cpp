#include "case_groups.hpp"

#include <map>

namespace fleetmap::experiment {

Result<std::vector<CaseGroup>> grouped(const std::vector<Case>& cases) {
  std::vector<CaseGroup> groups;
  std::map<std::string, std::size_t> known;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto hash = input_hash(cases[k]);
    if (!hash) return tl::unexpected(hash.error());
    const auto [entry, is_new] = known.emplace(*hash, groups.size());
    if (is_new) groups.push_back({{}, *hash});
    groups[entry->second].cases.push_back(k);
  }
  return groups;
}

}  // namespace fleetmap::experiment
