#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::experiment {

/// Reads the metrics of a fleet that ran in network namespaces (deploy/netns/field.sh --scenario trial), by
/// name:
///
/// - field.all_know_s, ended_s: s; absent where it did not come to it
/// - field.equal: 1 if all stores are whole and hold the same nodes, alignments and submaps
/// - field.worst_kbit_s, radio_kb, radio_dropped, wifi_mb, wifi_dropped: at the interfaces that all share
/// - field.node_p50_s, node_p95_s: s from when a robot made a node until another one held it
/// - field.nodes_missing: % of these that never came
/// - field.wifi_goodput_kbit_s: submaps that arrived, of all robots, by the seconds in which they filled the
/// channel
/// - field.LINK.KIND_kb: kB of payload that arrived, of all robots, by kind of message
///
/// Fails with the file that is missing or broken.
Result<std::map<std::string, double>> field_measures(const std::filesystem::path& directory);

}  // namespace fleetmap::experiment
