#include <algorithm>
#include <array>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "commands.hpp"
#include "recording_input.hpp"
#include "sample_check.hpp"

namespace fleetmap::apps {
namespace {

/// The samples of one sensor.
struct Stream {
  std::size_t count = 0;
  std::optional<Stamp> first, last;
  Duration longest_gap = Duration::zero();

  void add(Stamp stamp) {
    ++count;
    if (!first) first = stamp;
    if (last) longest_gap = std::max(longest_gap, stamp - *last);
    last = stamp;
  }
};

constexpr std::array kNames{"LiDAR", "IMU", "GPS", "wheels"};

void print(std::ostream& out, const char* name, const Stream& stream) {
  out << std::left << std::setw(8) << name << std::right << std::setw(8) << stream.count;
  if (stream.count > 1) {
    const double seconds = to_seconds(*stream.last - *stream.first);
    out << std::fixed << std::setprecision(1) << std::setw(10) << seconds << " s" << std::setw(8)
        << static_cast<double>(stream.count - 1) / std::max(seconds, 1e-9) << " Hz, longest gap "
        << std::setprecision(2) << to_seconds(stream.longest_gap) << " s";
  }
  out << (stream.count == 0 ? "  none\n" : "\n");
}

int inspect(const RecordingOptions& options) {
  const auto input = open_recording(options);
  if (!input) return input.error();
  SampleCheck check(input->log_clock, input->config.agent.perception.odometry.T_base_lidar);
  std::array<Stream, std::variant_size_v<recording::Sample>> streams;
  std::vector<std::string> findings;
  for (;;) {
    auto sample = input->reader->next();
    if (!sample) return report(sample.error(), kFailed);
    if (!*sample) break;
    streams.at((*sample)->index()).add(recording::stamp_of(**sample));
    check.admit(**sample, input->reader->recorded());
    for (std::string& news : check.take_warnings()) findings.push_back(std::move(news));
  }
  for (std::size_t k = 0; k < streams.size(); ++k) print(std::cout, kNames.at(k), streams[k]);
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
