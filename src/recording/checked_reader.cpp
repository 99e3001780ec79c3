#include "checked_reader.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace fleetmap::recording {
namespace {

struct Counter {
  const char* name;
  std::uint64_t Counters::*count;
};
constexpr Counter kCounters[] = {
    {"scans", &Counters::scans},
    {"imus", &Counters::imus},
    {"fixes", &Counters::fixes},
    {"wheels", &Counters::wheels},
    {"non_finite_points", &Counters::non_finite_points},
    {"origin_points", &Counters::origin_points},
    {"noise_points", &Counters::noise_points},
    {"undecodable_messages", &Counters::undecodable_messages},
    {"damaged_parts", &Counters::damaged_parts},
    {"empty_scans", &Counters::empty_scans},
    {"time_backwards", &Counters::time_backwards},
    {"clocks_set_back", &Counters::clocks_set_back},
    {"foreign_clock_scans", &Counters::foreign_clock_scans},
    {"foreign_time_unit_scans", &Counters::foreign_time_unit_scans},
    {"unstamped_messages", &Counters::unstamped_messages},
    {"packets_of_wrong_size", &Counters::packets_of_wrong_size},
    {"packets_of_wrong_blocks", &Counters::packets_of_wrong_blocks},
    {"packets_of_unknown_device", &Counters::packets_of_unknown_device},
    {"packets_of_other_devices", &Counters::packets_of_other_devices},
    {"incomplete_sweeps", &Counters::incomplete_sweeps},
    {"unreadable_scan_files", &Counters::unreadable_scan_files},
    {"missing_scan_frames", &Counters::missing_scan_frames},
    {"missing_oxts_frames", &Counters::missing_oxts_frames},
    {"malformed_oxts_frames", &Counters::malformed_oxts_frames},
};

/// A clock counts as set back by more than this after two such samples ...
constexpr Duration kClockSet = std::chrono::seconds(1);
/// ... and the next one does, too.
constexpr int kClockSetSamples = 2;

constexpr std::array kKinds{"scan", "imu", "fix", "wheel"};

const char* name_of(std::uint64_t Counters::*count) {
  for (const Counter& counter : kCounters) {
    if (counter.count == count) return counter.name;
  }
  return "skipped";
}

}  // namespace

std::vector<std::pair<std::string, std::uint64_t>> Counters::named() const {
  std::vector<std::pair<std::string, std::uint64_t>> out;
  for (const Counter& counter : kCounters) out.emplace_back(counter.name, this->*counter.count);
  return out;
}

Stamp stamp_of(const Sample& sample) {
  return std::visit([](const auto& s) { return s.stamp; }, sample);
}

void CheckedReader::skip(std::uint64_t Counters::*reason, const std::string& what, std::uint64_t count) {
  counters_.*reason += count;
  if (!logged_.insert(name_of(reason)).second) return;
  warn(std::string(name_of(reason)).append(": ").append(what).append(" (further ones are only counted)"));
}

void CheckedReader::warn(const std::string& news) const {
  if (!stamps_only()) spdlog::warn("{}: {}", source_, news);
}

void CheckedReader::add_finding(const std::string& finding) {
  if (std::ranges::find(findings_, finding) == findings_.end()) findings_.push_back(finding);
}

bool CheckedReader::admit(const Sample& sample) {
  constexpr std::array kAdmitted{&Counters::scans, &Counters::imus, &Counters::fixes, &Counters::wheels};
  const Stamp stamp = stamp_of(sample);
  Last& last = last_[sample.index()];
  if (last.admitted && stamp <= *last.admitted) {
    const bool in_order = last.skipped && stamp > *last.skipped;
    const bool far = *last.admitted - stamp > kClockSet;
    last.set_back = !far ? 0 : in_order ? last.set_back + 1 : 1;
    last.skipped = far ? std::optional(stamp) : std::nullopt;
    if (last.set_back <= kClockSetSamples) {
      skip(&Counters::time_backwards, std::string(kKinds[sample.index()]) + " at " +
                                          std::to_string(to_seconds(stamp)) + " s comes after one at " +
                                          std::to_string(to_seconds(*last.admitted)) + " s");
      return false;
    }
    const std::string news = fmt::format("the clock of the {} samples was set back by {:.2f} s",
                                         kKinds[sample.index()], to_seconds(*last.admitted - stamp));
    warn(news);
    if (++counters_.clocks_set_back == 1) {  // the other sensors' follow
      add_finding(
          news +
          ": it was set while it was recorded, or a recording was played in a loop. The map begins anew "
          "there; record again, or use the parts apart");
    }
  }
  last = {.admitted = stamp, .skipped = std::nullopt, .set_back = 0};
  ++(counters_.*kAdmitted[sample.index()]);
  return true;
}

bool CheckedReader::admit_points(const ros_codec::DecodedScan& decoded, const std::string& where) {
  if (decoded.scan.points.empty()) {
    skip(&Counters::empty_scans, where + " has no return");
    return false;
  }
  counters_.non_finite_points += decoded.non_finite_points;
  counters_.origin_points += decoded.origin_points;
  counters_.noise_points += decoded.noise_points;
  if (const std::string finding = ros_codec::finding_of(decoded.time_unit); !finding.empty()) {
    skip(&Counters::foreign_time_unit_scans, where + ": " + finding);
    add_finding(finding);
  }
  if (decoded.foreign_clock) {
    skip(&Counters::foreign_clock_scans, where +
                                             ": point times are far from the header's stamp; "
                                             "they are counted from the stamp or the first point");
  }
  return true;
}

}  // namespace fleetmap::recording
