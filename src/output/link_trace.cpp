#include "fleetmap/output/link_trace.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <fstream>

#include "fleetmap/output/csv_line.hpp"
#include "fleetmap/output/line_file.hpp"
#include "pose_text.hpp"

namespace fleetmap::output {
namespace {

constexpr std::size_t kCells = 9;
constexpr double kMaxSeconds = 9e9;    // nanoseconds fit into 64 bits
constexpr double kMaxMessages = 1e12;  // far beyond any second

/// Empty if the line is damaged.
std::optional<LinkTraceRow> row_of(const std::string& line) {
  const std::vector<std::string> cells = csv_cells(line);
  if (cells.size() != kCells) return std::nullopt;
  const auto time = finite_number(cells[0]), loss = finite_number(cells[6]), used = finite_number(cells[7]),
             messages = finite_number(cells[8]);
  const auto from = AgentId::parse(cells[2]), to = AgentId::parse(cells[3]);
  if (!time || !loss || !used || !messages || !from || !to) return std::nullopt;
  if (std::abs(*time) > kMaxSeconds || *loss < 0.0 || *loss > 100.0 || *used < 0.0 || *messages < 0.0 ||
      *messages > kMaxMessages)
    return std::nullopt;
  return LinkTraceRow{stamp_from_ns(std::llround(*time * 1e3) * 1'000'000),
                      cells[1],
                      *from,
                      *to,
                      finite_number(cells[4]),
                      finite_number(cells[5]),
                      *loss,
                      *used,
                      static_cast<std::uint64_t>(*messages)};
}

}  // namespace

std::string to_line(const LinkTraceRow& row) {
  const auto cell = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.1f}", *value) : std::string();
  };
  return fmt::format("{:.1f},{},{},{},{},{},{:.1f},{:.1f},{}", to_seconds(row.time), row.link, row.from.str(),
                     row.to.str(), cell(row.capacity_kbit_s), cell(row.delay_ms), row.loss_percent,
                     row.used_kbit_s, row.messages);
}

LinkTrace read_link_trace(const std::filesystem::path& file) {
  LinkTrace trace;
  for (const std::filesystem::path& part : parts_of(file)) {
    std::ifstream in(part);
    std::string line;
    std::getline(in, line);  // the names of the columns
    while (std::getline(in, line)) {
      if (auto row = row_of(line)) {
        trace.rows.push_back(std::move(*row));
      } else {
        ++trace.damaged;
      }
    }
  }
  return trace;
}

}  // namespace fleetmap::output
