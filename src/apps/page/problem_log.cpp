#include "problem_log.hpp"

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

namespace fleetmap::apps {
namespace {

constexpr std::size_t kMaxPast = 5;  // of a robot, on its card
constexpr Duration kForgotten = std::chrono::hours(1);

std::string without_digits(std::string text) {
  std::erase_if(text, [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
  return text;
}

}  // namespace

/// Whether the problem is there now.
bool ProblemLog::note(const std::string& problem, bool is_total, bool first_look, Stamp now,
                      Entries& entries) {
  const auto [found, is_new] = entries.try_emplace(without_digits(problem));
  Entry& entry = found->second;
  const bool has_grown = is_new ? !first_look : entry.text != problem;
  if (!is_total || has_grown) entry.last = now;
  entry.text = problem;
  entry.is_total = is_total;
  entry.is_reported = true;
  entry.is_present = !is_total || (entry.last && now - *entry.last < kGrows);
  return entry.is_present;
}

void ProblemLog::update(monitor::RobotNow& robot, Stamp now) {
  const bool first_look = !robots_.contains(robot.id);
  Entries& entries = robots_[robot.id];
  for (auto& [kind, entry] : entries) entry.is_present = entry.is_reported = false;
  std::vector<std::string> present;
  for (const std::string& problem : robot.problems) {
    const bool is_total = std::ranges::find(robot.totals, problem) != robot.totals.end();
    if (note(problem, is_total, first_look, now, entries)) present.push_back(problem);
  }
  std::erase_if(entries, [now](const auto& entry) {
    const Entry& one = entry.second;
    const bool is_old = !one.last || now - *one.last > kForgotten;
    return !one.is_present && is_old && (!one.is_total || !one.is_reported);
  });
  std::vector<Entry> past;
  for (const auto& [kind, entry] : entries)
    if (!entry.is_present) past.push_back(entry);
  std::ranges::stable_sort(past, std::greater{}, &Entry::last);
  if (past.size() > kMaxPast) past.resize(kMaxPast);
  robot.problems = std::move(present);
  robot.past.clear();
  for (Entry& one : past) {
    const auto ago = one.last ? std::optional(to_seconds(now - *one.last)) : std::nullopt;
    robot.past.push_back({std::move(one.text), one.is_total, ago});
  }
}

}  // namespace fleetmap::apps
