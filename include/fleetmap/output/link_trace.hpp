#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::output {

/// Messages of robot `from` that robot `to` heard within a second, as a line of link_trace.csv.
struct LinkTraceRow {
  Stamp time;        ///< when the second began, by the clock of `to`; 0.1 s
  std::string link;  ///< long_range or short_range
  AgentId from, to;
  std::optional<double> capacity_kbit_s = {};  ///< of the link, where it is known
  std::optional<double> delay_ms = {};         ///< by the clocks of both robots
  double loss_percent = 0.0;                   ///< 100: `from` fell silent
  double used_kbit_s = 0.0;
  std::uint64_t messages = 0;
};

/// Name of the file in a robot's folder, and its first line.
inline constexpr const char* kLinkTraceFile = "link_trace.csv";
inline constexpr const char* kLinkTraceHeader =
    "time_s,link,from,to,kbit_s,ms,loss_percent,used_kbit_s,messages";
std::string to_line(const LinkTraceRow& row);

/// Content of a link_trace.csv.
struct LinkTrace {
  std::vector<LinkTraceRow> rows;
  std::size_t damaged = 0;  ///< lines that cannot be read; they are left out
};
/// With the rows of part_before(file). A file that is not there holds nothing.
LinkTrace read_link_trace(const std::filesystem::path& file);

}  // namespace fleetmap::output
