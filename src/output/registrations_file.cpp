#include "fleetmap/output/registrations_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fleetmap/output/line_file.hpp"
#include "pose_text.hpp"

namespace fleetmap::output {
namespace {

/// The last one is that of new files. Former versions wrote no times, and before that no poses.
constexpr std::array kHeaders{
    "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason",
    "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,pose,reason",
    "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,pose,reason,done_s"};
constexpr std::array kVerdicts{"accepted", "ambiguous", "rejected", "failed"};

/// At most `count` cells. Number `wide` takes what the others leave of the line, so the reason may hold
/// commas.
std::vector<std::string_view> cells_of(std::string_view line, std::size_t count, std::size_t wide) {
  std::vector<std::string_view> cells, behind;
  while (cells.size() < wide) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) break;
    cells.push_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  while (cells.size() == wide && cells.size() + behind.size() + 1 < count) {
    const std::size_t comma = line.rfind(',');
    if (comma == std::string_view::npos) break;
    behind.push_back(line.substr(comma + 1));
    line = line.substr(0, comma);
  }
  cells.push_back(line);
  cells.insert(cells.end(), behind.rbegin(), behind.rend());
  return cells;
}

/// "12.345" s with all three decimals, so that a number that was cut off is none.
std::optional<Stamp> stamp_in_cell(std::string_view text) {
  constexpr std::size_t kDecimals = 3;
  constexpr double kMaxSeconds = 9e9;  // nanoseconds fit into 64 bits
  const std::size_t dot = text.find('.');
  const auto seconds = finite_number(text);
  if (!seconds || std::abs(*seconds) > kMaxSeconds || dot == std::string_view::npos ||
      text.size() != dot + 1 + kDecimals)
    return std::nullopt;
  return stamp_from_ns(std::llround(*seconds * 1e3) * 1'000'000);
}

/// Empty unless it is seven finite numbers of which the last four are a rotation.
std::optional<Pose> pose_in_cell(std::string_view text) {
  std::array<double, 7> numbers{};
  for (double& number : numbers) {
    const std::string_view word = text.substr(0, text.find(' '));
    const auto value = finite_number(word);
    if (!value) return std::nullopt;
    number = *value;
    text.remove_prefix(std::min(word.size() + 1, text.size()));
  }
  const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!text.empty() || std::abs(q.norm() - 1.0) > 1e-3) return std::nullopt;
  return make_pose(q.normalized().toRotationMatrix(), {numbers[0], numbers[1], numbers[2]});
}

/// A file keeps the columns with which it was begun.
std::string_view header_of(const std::filesystem::path& file) {
  std::string header;
  std::ifstream in(file);
  std::getline(in, header);
  const auto* known = std::ranges::find(kHeaders, header);
  return known == kHeaders.end() ? kHeaders.back() : *known;
}

Result<LineFile> open_table(const std::filesystem::path& file, std::string_view header) {
  return LineFile::open(file, std::ios::app, {kMaxTableBytes, std::string(header)});
}

/// The columns of a file, by name.
class Columns {
 public:
  explicit Columns(std::string_view header)
      : names_(cells_of(header, header.size() + 1, header.size())),
        wide_(std::min(static_cast<std::size_t>(std::ranges::find(names_, "reason") - names_.begin()),
                       names_.size() - 1)) {}

  /// Empty if the line is damaged.
  std::optional<RegistrationRow> row(std::string_view line) const {
    const std::vector<std::string_view> cells = cells_of(line, names_.size(), wide_);
    if (cells.size() < names_.size()) return std::nullopt;
    const auto cell = [&](std::string_view name) {
      const auto column = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
      return column < cells.size() ? cells[column] : std::string_view{};
    };
    const auto target = parse_node_id(cell("target")), source = parse_node_id(cell("source"));
    const std::string_view verdict = cell("verdict");
    if (!target || !source || std::ranges::find(kVerdicts, verdict) == kVerdicts.end()) return std::nullopt;
    std::string_view reason = cell("reason");
    if (std::ranges::find(names_, "reason") != names_.end()) {
      if (reason.size() < 2 || reason.front() != '"' || reason.back() != '"') return std::nullopt;
      reason = reason.substr(1, reason.size() - 2);
    }
    return RegistrationRow{*target,
                           *source,
                           std::string(verdict),
                           finite_number(cell("rmse_m")),
                           finite_number(cell("inlier_fraction")),
                           finite_number(cell("overlap")),
                           finite_number(cell("cpu_s")).value_or(0.0),
                           std::string(reason),
                           pose_in_cell(cell("pose")),
                           stamp_in_cell(cell("done_s"))};
  }

 private:
  std::vector<std::string_view> names_;
  std::size_t wide_;  ///< the column of reasons, else the last one
};

}  // namespace

Status begin_registrations(const std::filesystem::path& file) {
  const Result<LineFile> begun = open_table(file, header_of(file));
  if (!begun) return tl::unexpected(begun.error());
  return {};
}

Status append_registration(const std::filesystem::path& file, const RegistrationRow& row) {
  const std::string_view header = header_of(file);
  Result<LineFile> lines = open_table(file, header);
  if (!lines) return tl::unexpected(lines.error());
  std::ostringstream out;
  out << to_string(row.target) << ',' << to_string(row.source) << ',' << row.verdict << ',';
  for (const std::optional<double>& value : {row.rmse, row.inlier_fraction, row.overlap}) {
    if (value) out << *value;
    out << ',';
  }
  out << row.cpu_seconds << ',';
  if (header != kHeaders.front())
    out << (row.T_target_source ? pose_text(*row.T_target_source, 4, 7) : "") << ',';
  out << '"' << row.reason << '"';
  if (header == kHeaders.back())
    out << ',' << (row.done ? fmt::format("{:.3f}", to_seconds(*row.done)) : std::string());
  return lines->add(out.str());
}

Registrations parse_registrations(std::string_view csv) {
  const auto next_line = [&csv] {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    return line;
  };
  Registrations read;
  const Columns columns(next_line());
  while (!csv.empty()) {
    const std::string_view line = next_line();
    if (line.empty()) continue;
    if (auto row = columns.row(line)) {
      read.rows.push_back(std::move(*row));
    } else {
      ++read.damaged;
    }
  }
  return read;
}

Registrations read_registrations(const std::filesystem::path& file) {
  Registrations all;
  for (const std::filesystem::path& part : parts_of(file)) {
    std::ostringstream text;
    text << std::ifstream(part, std::ios::binary).rdbuf();
    Registrations read = parse_registrations(text.view());
    std::ranges::move(read.rows, std::back_inserter(all.rows));
    all.damaged += read.damaged;
  }
  return all;
}

}  // namespace fleetmap::output
