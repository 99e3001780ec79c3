#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// The radios around agents in network namespaces (`fleetmap trial`): `field` of a fleet's file. Radios are
/// one medium each that all share.
struct FieldConfig {
  /// One medium.
  struct Medium {
    double kbit_s = 0.0;
    double loss = 0.0, duplicate = 0.0;      ///< %, of datagrams
    double delay_ms = 0.0, jitter_ms = 0.0;  ///< beside what the queue takes
  };
  Medium radio{.kbit_s = 200.0};
  Medium wifi{.kbit_s = 15'000.0};
  std::filesystem::path trace;       ///< CSV of what links had in the field; empty: none
  std::filesystem::path qos;         ///< folder of profiles; empty: qos/ of the source tree
  double trace_from = 0.0;           ///< s after its first row, when the recordings begin
  std::filesystem::path robot;       ///< AGENT.yaml of the robots' sensors; a trial needs it
  std::filesystem::path recordings;  ///< holds r1, r2, ...; empty: those of the fleet's twin, made once
  std::filesystem::path truth;       ///< holds NAME/truth.tum of them; empty: the twin's, or unknown
  double wifi_from = 0.0;            ///< s after the recordings began; before, there is no Wi-Fi
  double patience = 420.0;           ///< s until robots that have not finished are stopped
  std::uint64_t seed = 1;            ///< of what is lost

  /// Names the field and the rule that it breaks.
  Status validate() const;
};

/// Options of `fleetmap trial` for deploy/netns/field.sh, beside robots, recordings and output.
std::vector<std::string> field_options(const FieldConfig& field);

}  // namespace fleetmap::config
