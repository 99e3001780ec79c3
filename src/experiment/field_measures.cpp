#include "field_measures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/experiment/run_case.hpp"
#include "fleetmap/output/csv_line.hpp"
#include "fleetmap/output/robot_folders.hpp"

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Row = std::map<std::string, std::string>;  // by column

/// A line that is cut off (a killed writer) is left out. Fails without one of the columns `needed`.
Result<std::vector<Row>> read_csv(const fs::path& file, std::initializer_list<const char*> needed) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) return failure(file.string() + ": cannot be read");
  const std::vector<std::string> columns = output::csv_cells(line);
  for (const char* column : needed) {
    if (std::ranges::find(columns, column) == columns.end())
      return failure(file.string() + ": its first line names no column '" + column + "'");
  }
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = output::csv_cells(line);
    if (cells.size() != columns.size()) continue;
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < columns.size(); ++k) row[columns[k]] = cells[k];
  }
  return rows;
}

std::optional<double> number(const Row& row, const std::string& column) {
  const auto cell = row.find(column);
  if (cell == row.end()) return std::nullopt;
  double value = 0.0;
  const char* last = cell->second.data() + cell->second.size();
  const auto [end, error] = std::from_chars(cell->second.data(), last, value);
  // Times are counted in whole seconds further on.
  constexpr double kMaxValue = 1e18;
  if (error != std::errc() || end != last || cell->second.empty() || !(std::abs(value) < kMaxValue))
    return std::nullopt;
  return value;
}

/// `values` must not be empty.
double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return values[at];
}

/// Time at which a robot came to hold each node, s. After a restart its log repeats the nodes that it held.
Result<std::map<std::string, double>> node_times(const fs::path& robot) {
  const auto rows = read_csv(robot / "node_times.csv", {"node", "time_ns"});
  if (!rows) return tl::unexpected(rows.error());
  std::map<std::string, double> times;
  for (const Row& row : *rows) {
    const std::optional<double> ns = number(row, "time_ns");
    if (!ns) continue;
    const auto [known, fresh] = times.emplace(row.at("node"), 1e-9 * *ns);
    if (!fresh) known->second = std::min(known->second, 1e-9 * *ns);
  }
  return times;
}

Status add_latencies(const std::vector<fs::path>& robots, std::map<std::string, double>& measures) {
  std::map<std::string, std::map<std::string, double>> held;  // by robot
  for (const fs::path& robot : robots) {
    auto times = node_times(robot);
    if (!times) return tl::unexpected(times.error());
    held[robot.filename().string()] = *std::move(times);
  }
  std::vector<double> latencies;
  std::size_t missing = 0;
  for (const auto& [maker, times] : held) {
    for (const auto& [node, made] : times) {
      if (node.substr(0, node.find('#')) != maker) continue;
      for (const auto& [other, arrived] : held) {
        if (other == maker) continue;
        const auto there = arrived.find(node);
        if (there == arrived.end()) {
          ++missing;
        } else {
          latencies.push_back(std::max(there->second - made, 0.0));
        }
      }
    }
  }
  const auto all = static_cast<double>(missing + latencies.size());
  if (all > 0.0) measures["field.nodes_missing"] = 100.0 * static_cast<double>(missing) / all;
  if (latencies.empty()) return {};
  measures["field.node_p50_s"] = quantile(latencies, 0.5);
  measures["field.node_p95_s"] = quantile(latencies, 0.95);
  return {};
}

/// Seconds in which submaps filled the channel, of whatever robots.
Result<std::size_t> full_seconds(const std::vector<fs::path>& robots) {
  std::set<std::int64_t> seconds;
  for (const fs::path& robot : robots) {
    const auto rows = read_csv(robot / "link_trace.csv", {"time_s", "link", "kbit_s"});
    if (!rows) return tl::unexpected(rows.error());
    for (const Row& row : *rows) {
      const auto time = number(row, "time_s");
      if (time && number(row, "kbit_s") && row.at("link") == "short_range")
        seconds.insert(static_cast<std::int64_t>(std::floor(*time)));
    }
  }
  return seconds.size();
}

bool is_topic(const json& row) {
  const auto has = [&row](const char* key, auto is) { return row.contains(key) && (row[key].*is)(); };
  return row.is_object() && has("link", &json::is_string) && has("kind", &json::is_string) &&
         has("received_bytes", &json::is_number);
}

Status add_kinds(const std::vector<fs::path>& robots, std::map<std::string, double>& measures) {
  for (const fs::path& robot : robots) {
    const auto report = read_json(robot / "report.json");
    if (!report) return tl::unexpected(report.error());
    const fs::path file = robot / "report.json";
    const auto topics = report->find("topics");
    if (topics == report->end() || !topics->is_array()) return failure(file.string() + ": lists no topics");
    for (const json& row : *topics) {
      if (!is_topic(row)) return failure(file.string() + ": a topic lacks link, kind or received_bytes");
      const std::string name = row["link"].get<std::string>() + "." + row["kind"].get<std::string>() + "_kb";
      measures["field." + name] += 1e-3 * row["received_bytes"].get<double>();
    }
  }
  return {};
}

}  // namespace

Result<std::map<std::string, double>> field_measures(const fs::path& directory) {
  std::map<std::string, double> measures;
  const auto field = read_json(directory / "field.json");
  if (!field) return tl::unexpected(field.error());
  for (const auto& [name, value] : field->items()) {
    if (value.is_number()) measures["field." + name] = value.get<double>();
  }
  const std::vector<fs::path> robots = output::robot_folders(directory, "node_times.csv");
  if (robots.empty()) return failure(directory.string() + ": no robot has left its files there");
  for (const Status& added : {add_latencies(robots, measures), add_kinds(robots, measures)}) {
    if (!added) return tl::unexpected(added.error());
  }
  const auto seconds = full_seconds(robots);
  if (!seconds) return tl::unexpected(seconds.error());
  const auto chunks = measures.find("field.short_range.submap_chunk_kb");
  if (*seconds > 0 && chunks != measures.end())
    measures["field.wifi_goodput_kbit_s"] = 8.0 * chunks->second / static_cast<double>(*seconds);
  return measures;
}

}  // namespace fleetmap::experiment
