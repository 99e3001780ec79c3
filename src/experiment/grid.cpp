#include "fleetmap/experiment/grid.hpp"

#include <utility>

#include "case_groups.hpp"
#include "fleetmap/config/experiment_file.hpp"

namespace fleetmap::experiment {

Result<Grid> load_grid(const std::filesystem::path& file, bool quick,
                       const std::vector<config::Override>& overrides) {
  auto config = config::load_experiment(file, quick);
  if (!config) return tl::unexpected(config.error());
  for (config::Study& study : config->studies)
    study.overrides.insert(study.overrides.end(), overrides.begin(), overrides.end());
  std::vector<Case> cases = all_cases(*config);
  if (const Status valid = check_cases(cases); !valid) return tl::unexpected(valid.error());
  return Grid{std::move(*config), std::move(cases)};
}

Status list_cases(const std::vector<Case>& cases, std::ostream& out) {
  const auto groups = grouped(cases);
  if (!groups) return tl::unexpected(groups.error());
  std::vector<std::size_t> first(cases.size());
  for (const CaseGroup& group : *groups)
    for (const std::size_t k : group.cases) first[k] = group.cases.front();
  for (std::size_t k = 0; k < cases.size(); ++k) {
    out << cases[k].name;
    if (first[k] != k) {
      out << ": same run as " << cases[first[k]].name << '\n';
      continue;
    }
    out << ": " << cases[k].agents << " robots";
    for (const config::Override& entry : cases[k].overrides)
      out << " --set " << entry.key << '=' << entry.value;
    out << '\n';
  }
  return {};
}

}  // namespace fleetmap::experiment
