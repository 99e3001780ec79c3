#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "recording_input.hpp"
#include "sample_check.hpp"
#include "stream_summary.hpp"

namespace fleetmap::apps {
namespace {

int inspect(const RecordingOptions& options) {
  const auto input = open_recording(options);
  if (!input) return input.error();
  SampleCheck check(input->log_clock, input->config.agent.perception.odometry.T_base_lidar);
  StreamSummary streams;
  std::vector<std::string> findings;
  for (;;) {
    auto sample = input->reader->next();
    if (!sample) return report(sample.error(), kFailed);
    if (!*sample) break;
    streams.add(**sample);
    check.admit(**sample, input->reader->recorded());
    for (std::string& news : check.take_warnings()) findings.push_back(std::move(news));
  }
  streams.print(std::cout);
  for (const auto& [name, count] : input->reader->counters().named()) {
    if (count > 0) std::cout << name << ' ' << count << '\n';
  }
  for (const std::string& finding : findings) std::cout << "- " << finding << '\n';
  if (findings.empty()) std::cout << "nothing found in clocks, units and rates\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RecordingOptions>();
  options->scans_needed = false;
  CLI::App* command = app.add_subcommand("inspect",
                                         "what a recording holds, and what is wrong with its clocks, units "
                                         "and rates; exit code 1 if anything is");
  add_recording_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = inspect(*options); });
}

}  // namespace fleetmap::apps
