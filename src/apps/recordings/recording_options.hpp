#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// The options of commands that read one recording.
struct RecordingOptions {
  std::string recording;
  std::string config;
  std::vector<std::string> set;
  bool scans_needed = true;  ///< no option: what the command cannot do without
};
void add_recording_options(CLI::App& command, RecordingOptions& options);

}  // namespace fleetmap::apps
