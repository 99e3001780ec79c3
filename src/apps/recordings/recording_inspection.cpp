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
#include "unread_parts.hpp"

namespace fleetmap::apps {

CommandResult<ExitCode> inspect_recording(const RecordingOptions& options, std::ostream& out) {
  const auto input = open_recording(options);
  if (!input) return tl::unexpected(input.error());
  StreamSummary streams;
  const auto done = run_odometry(*input->reader, input->prepared.log_clock, input->config.agent.perception,
                                 {[&](const recording::Sample& sample) { streams.add(sample); }, {}});
  if (!done) return exit_with(kFailed, done.error());
  std::vector<std::string> findings = input->prepared.findings;
  std::ranges::copy(input->reader->findings(), std::back_inserter(findings));
  std::ranges::copy(done->findings, std::back_inserter(findings));
  std::ranges::move(done->failures(streams.scans()), std::back_inserter(findings));
  if (streams.scans() == 0) findings.push_back(no_scan(input->reader->counters()));
  std::ranges::move(unread_parts(input->reader->counters()), std::back_inserter(findings));
  const bool said = std::ranges::any_of(
      findings, [](const std::string& one) { return one.find("without a position") != std::string::npos; });
  if (auto blind = streams.fixes_without_place(input->config.agent.perception.uses_gps); blind && !said)
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
