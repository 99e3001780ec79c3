#include "recording_inspection.hpp"

#include <algorithm>
#include <iterator>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "odometry_run.hpp"
#include "recording_input.hpp"
#include "stream_summary.hpp"

namespace fleetmap::apps {
namespace {

/// Sentences on what could not be read; the log has the first of each with its place.
std::vector<std::string> unread_parts(const recording::Counters& counters) {
  std::vector<std::string> findings;
  const auto add = [&](std::uint64_t count, const char* one, const char* many, const char* what) {
    if (count > 0) findings.push_back(std::to_string(count) + (count == 1 ? one : many) + what);
  };
  add(counters.damaged_parts, " part of the recording is", " parts of the recording are",
      " damaged or cut off and left out: copy it again from where it was recorded (mcap recover and "
      "rosbag reindex save what can be read)");
  add(counters.undecodable_messages, " message is", " messages are",
      " truncated or contradictory and left out: correct the driver, or the type of the topic");
  add(counters.unreadable_scan_files, " scan file is", " scan files are",
      " truncated or damaged and left out: copy the recording again");
  add(counters.malformed_oxts_frames, " record of oxts is", " records of oxts are",
      " malformed and left out: copy the recording again");
  return findings;
}

}  // namespace

CommandResult<ExitCode> inspect_recording(const RecordingOptions& options, std::ostream& out) {
  const auto input = open_recording(options);
  if (!input) return tl::unexpected(input.error());
  StreamSummary streams;
  const auto done = run_odometry(*input->reader, input->prepared.log_clock, input->config.agent.perception,
                                 {[&](const recording::Sample& sample) { streams.add(sample); }, {}});
  if (!done) return exit_with(kFailed, done.error());
  std::vector<std::string> findings = input->prepared.findings;
  std::ranges::copy(done->findings, std::back_inserter(findings));
  std::ranges::move(done->failures(streams.scans()), std::back_inserter(findings));
  std::ranges::move(unread_parts(input->reader->counters()), std::back_inserter(findings));
  if (auto blind = streams.fixes_without_place(input->config.agent.perception.uses_gps))
    findings.push_back(std::move(*blind));
  streams.print(out);
  for (const std::string& mount : input->prepared.mounts) out << mount << '\n';
  for (const auto& [name, count] : input->reader->counters().named()) {
    if (count > 0) out << name << ' ' << count << '\n';
  }
  for (const std::string& note : done->notes) out << "note: " << note << '\n';
  for (const std::string& finding : findings) out << "- " << finding << '\n';
  if (findings.empty()) out << "nothing found in clocks, units, rates, mounts and motions\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace fleetmap::apps
