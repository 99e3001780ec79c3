#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "odometry_run.hpp"
#include "recording_input.hpp"
#include "stream_summary.hpp"

namespace fleetmap::apps {
namespace {

int inspect(const RecordingOptions& options) {
  const auto input = open_recording(options);
  if (!input) return input.error();
  StreamSummary streams;
  const auto done = run_odometry(*input->reader, input->prepared.log_clock, input->config.agent.perception,
                                 [&](const recording::Sample& sample) { streams.add(sample); });
  if (!done) return report(done.error(), kFailed);
  std::vector<std::string> findings = input->prepared.findings;
  std::ranges::copy(done->findings, std::back_inserter(findings));
  if (!done->kept_its_way()) findings.emplace_back("odometry: it lost its way; see the findings before this");
  if (done->poses.empty() && streams.scans() > 0)
    findings.push_back("odometry: no scan could be used: " + done->first_refusal);
  streams.print(std::cout);
  for (const std::string& mount : input->prepared.mounts) std::cout << mount << '\n';
  for (const auto& [name, count] : input->reader->counters().named()) {
    if (count > 0) std::cout << name << ' ' << count << '\n';
  }
  for (const std::string& finding : findings) std::cout << "- " << finding << '\n';
  if (findings.empty()) std::cout << "nothing found in clocks, units, rates, mounts and motions\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RecordingOptions>();
  options->scans_needed = false;
  CLI::App* command = app.add_subcommand("inspect",
                                         "what a recording holds, and what is wrong with its clocks, units, "
                                         "rates, mounts and motions; exit code 1 if anything is");
  add_recording_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = inspect(*options); });
}

}  // namespace fleetmap::apps
