#include "fleetmap/monitor/attempt.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace fleetmap::monitor {
namespace {

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> finite(std::string_view text) {
  const auto value = number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Seven cells and the reason, which may itself hold commas.
std::optional<std::array<std::string_view, 8>> cells_of(std::string_view line) {
  std::array<std::string_view, 8> cells;
  for (std::size_t k = 0; k + 1 < cells.size(); ++k) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    cells[k] = line.substr(0, comma);
    line.remove_prefix(comma + 1);
  }
  if (line.size() < 2 || line.front() != '"' || line.back() != '"') return std::nullopt;
  cells[7] = line.substr(1, line.size() - 2);
  return cells;
}

std::optional<Attempt> parse_line(std::string_view line, const AgentId& by) {
  static constexpr std::array kVerdicts{"accepted", "ambiguous", "rejected", "failed"};
  const auto cells = cells_of(line);
  if (!cells) return std::nullopt;
  const auto& [target, source, verdict, rmse, inliers, overlap, cpu, reason] = *cells;
  const auto i = parse_node(target), j = parse_node(source);
  if (!i || !j || std::ranges::find(kVerdicts, verdict) == kVerdicts.end()) return std::nullopt;
  return Attempt{
      by, *i, *j, std::string(verdict), finite(rmse), finite(inliers), finite(overlap), std::string(reason)};
}

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

std::string measures(const Attempt& attempt) {
  std::string said;
  if (attempt.overlap) said += text(", %.0f %% of the cloud overlaps", 100.0 * *attempt.overlap);
  if (attempt.inlier_fraction) said += text(", %.0f %% are inliers", 100.0 * *attempt.inlier_fraction);
  if (attempt.rmse_m) said += text(", E %.1f cm", 100.0 * *attempt.rmse_m);
  return said;
}

}  // namespace

Result<NodeId> parse_node(std::string_view text) {
  const auto wrong = [&] {
    std::string said = "no node is named ";
    said.append(text.substr(0, 40));
    return failure(std::move(said));
  };
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return wrong();
  std::string_view robot = text.substr(0, slash);
  std::optional<std::uint16_t> session = std::uint16_t{0};
  if (const std::size_t hash = robot.find('#'); hash != std::string_view::npos) {
    session = number<std::uint16_t>(robot.substr(hash + 1));
    robot = robot.substr(0, hash);
  }
  const auto count = number<std::uint32_t>(text.substr(slash + 1));
  const auto agent = AgentId::parse(robot);
  if (!agent || !session || !count || *count >= kItemsPerSession) return wrong();
  return NodeId{*agent, first_seq(*session) + *count};
}

Attempts parse_attempts(std::string_view csv, const AgentId& by) {
  Attempts all;
  for (bool header = true; !csv.empty(); header = false) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    if (header || line.empty()) continue;
    if (auto attempt = parse_line(line, by)) {
      all.attempts.push_back(std::move(*attempt));
    } else {
      ++all.damaged;
    }
  }
  return all;
}

std::string fate(graph::AlignmentStatus status) {
  switch (status) {
    case graph::AlignmentStatus::used:
      return "the graph uses it";
    case graph::AlignmentStatus::against_gps:
      return "the graph does not use it: it contradicts GPS and odometry";
    case graph::AlignmentStatus::against_others:
      return "the graph does not use it: it contradicts alignments that are better supported";
    case graph::AlignmentStatus::undecided:
      return "the graph does not use it yet: too little evidence";
    case graph::AlignmentStatus::quarantined:
      return "the graph does not use it: its robot is quarantined for many false alignments";
    case graph::AlignmentStatus::waiting:
      return "the graph does not use it yet: one of its nodes has not arrived";
    case graph::AlignmentStatus::invalid:
      return "the graph does not use it: its numbers are impossible";
  }
  return "";
}

std::string sentence(const Attempt& attempt, std::optional<graph::AlignmentStatus> status) {
  std::string said = attempt.by.str() + " registered " + to_string(attempt.source) + " onto " +
                     to_string(attempt.target) + ": " + attempt.verdict;
  if (!attempt.reason.empty()) said += ", because " + attempt.reason;
  if (attempt.verdict != "failed") said += measures(attempt);
  if (status) said += "; " + fate(*status);
  return said + ".";
}

}  // namespace fleetmap::monitor
