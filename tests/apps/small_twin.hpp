#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace fleetmap::testing {

/// A farm of three lanes, a LiDAR of few rays and three robots: a mission of half a minute of virtual time.
class SmallTwin {
 public:
  SmallTwin();

  /// FLEET.yaml anew; `agent_keys` are what r1, r2 and r3 have besides: "robot: {start: [1, 2, 0]}".
  void write_fleet(const std::string& top_keys, const std::vector<std::string>& agent_keys = {},
                   const std::string& mission_keys = "") const;

  std::filesystem::path path(const std::string& name = "") const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& content) const { folder_.write(name, content); }

  struct Run {
    int exit_code = -1;
    std::string output;
    std::filesystem::path out;
    nlohmann::json report;
  };
  /// `fleetmap run` of it into the folder `name`.
  Run run(const std::string& name, const std::vector<std::string>& more = {}) const;

 private:
  TemporaryFolder folder_;
};

}  // namespace fleetmap::testing
