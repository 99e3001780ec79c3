#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <set>
#include <sstream>
#include <string>

#include "fleetmap/experiment/experiment.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {

/// Stands for a twin: a fleet's RMSE and time fall as the square root of its size, and seeds scatter a
/// little.
class FakeTwin {
 public:
  Engine engine();
  std::multiset<std::string> ran() const;
  void forget() { ran_.clear(); }

  std::set<std::string> failing;   ///< names of cases
  std::set<std::string> throwing;  ///< names of cases
  std::string stop_at;             ///< the case during which the user presses Ctrl-C
  std::atomic<bool>* stop = nullptr;

 private:
  Result<CaseResult> run(const Case& one, const std::filesystem::path& directory);

  mutable std::mutex mutex_;
  std::multiset<std::string> ran_;
};

class ExperimentTest : public ::testing::Test {
 protected:
  ExperimentTest();
  void write_experiment(const std::string& rest) {
    folder_.write("experiment.yaml", "base: fleet.yaml\n" + rest);
  }
  Result<config::ExperimentConfig> load(bool quick = false) const;
  std::filesystem::path out() const { return folder_.path() / "out"; }
  RunnerConfig runner(unsigned jobs = 2) const { return {out(), jobs, false, "build-1", false}; }
  ExperimentResult run(const RunnerConfig& runner);

  testing::TemporaryFolder folder_;
  FakeTwin twin_;
  std::atomic<bool> stop_{false};
  std::ostringstream log_;
};

}  // namespace fleetmap::experiment
