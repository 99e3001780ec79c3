#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/config/experiment_config.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::experiment {

/// One run of one fleet: a point of a study's grid with one seed.
struct Case {
  std::string name;  ///< of its folder: unique, no '/'
  std::string study;
  std::vector<std::string> point;  ///< a label an axis of the study, in its order
  std::uint64_t seed = 1;
  std::filesystem::path base;  ///< FLEET.yaml
  std::size_t agents = 1;      ///< the first of `base`
  std::vector<config::Override> overrides;
  bool pictures = true;  ///< of the map: drawn of the first seed only
  // Slow parts of the evaluation, which only some metrics need.
  std::set<std::string> modes = {};  ///< combinations of registration and placement, as of `fleetmap eval`
  bool overlap = false;              ///< the map where two robots were
};

/// Counts of values by bin; bins follow each other from 0.
struct Histogram {
  double bin_width = 1.0;
  std::vector<double> shares;
};

/// Result of a case.
struct CaseResult {
  std::map<std::string, double> metrics;  ///< finite; what a case could not measure is absent
  std::map<std::string, Histogram> histograms;
  std::map<std::string, std::string> pictures;  ///< kind -> PNG file in the case's folder
};

/// Runs one case in an empty folder. Called from several threads.
using Engine = std::function<Result<CaseResult>(const Case&, const std::filesystem::path& directory)>;

/// `text` with '_' for what does not belong into a file's name.
std::string file_name(const std::string& text);

/// Every case of every study, in the order of the file, a point's seeds one after another.
std::vector<Case> all_cases(const config::ExperimentConfig& config);

/// Index of the case with this name. The error lists the names that are nearest to it.
Result<std::size_t> case_named(const std::vector<Case>& cases, const std::string& name);

/// Hash of a case's inputs, without its name, study and point. One build of the program gives equal results
/// for equal inputs.
Result<std::string> input_hash(const Case& one);

/// A fleet's file that cannot be read with a point's keys is found before hours are spent on the others.
Status check_cases(const std::vector<Case>& cases);

}  // namespace fleetmap::experiment
