#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fleetmap::apps {

/// Accepts whole numbers only, checked before the conversion, which would wrap -1 round.
CLI::Validator whole_number(std::uint64_t min, std::uint64_t max = std::numeric_limits<std::uint64_t>::max());
CLI::Validator positive_number();
CLI::Validator non_negative_number();
CLI::Validator number_within(double min, double max);
/// Not empty, as it is when a script's variable is unset.
CLI::Validator some_path();
/// A path with one of these extensions (".gpx").
CLI::Validator file_ending(std::vector<std::string> extensions);
/// Coordinates of LAS, as output::parse_crs() reads them.
CLI::Validator reference_system();

}  // namespace fleetmap::apps
