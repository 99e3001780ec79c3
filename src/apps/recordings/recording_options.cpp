#include "recording_options.hpp"

#include <CLI/CLI.hpp>

namespace fleetmap::apps {

void add_recording_options(CLI::App& command, RecordingOptions& options) {
  command
      .add_option("recording", options.recording,
                  "rosbag2 folder, .db3, .mcap, .bag or .pcap, KITTI folder, or a folder of scans")
      ->required();
  command.add_option("-c,--config", options.config, "AGENT.yaml or FLEET.yaml for the sensors");
  command.add_option("--set", options.set, "key=value, e.g. lidar.model=hdl64e")->allow_extra_args(false);
}

}  // namespace fleetmap::apps
