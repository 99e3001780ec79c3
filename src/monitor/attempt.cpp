#include "fleetmap/monitor/attempt.hpp"

#include <array>
#include <cctype>
#include <cstdio>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::monitor {
namespace {

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

/// Measures of the pose that was found, as the begin of a sentence, without an RMSE that is the reason.
std::string measures(const Attempt& attempt) {
  std::string said;
  if (attempt.overlap) append_to_list(said, text("%.0f %% of the cloud overlaps", 100.0 * *attempt.overlap));
  if (attempt.inlier_fraction)
    append_to_list(said, text("%.0f %% are inliers", 100.0 * *attempt.inlier_fraction));
  if (attempt.rmse_m) {
    const std::string rmse = text("inlier RMSE is %.2f m", *attempt.rmse_m);
    if (attempt.reason.find(rmse) == std::string::npos) append_to_list(said, "the " + rmse);
  }
  if (!said.empty()) said.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(said.front())));
  return said;
}

}  // namespace

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
  const std::string measured = attempt.verdict == "failed" ? "" : measures(attempt);
  if (!measured.empty()) said += ". " + measured;
  if (status) said += "; " + fate(*status);
  return said + ".";
}

}  // namespace fleetmap::monitor
