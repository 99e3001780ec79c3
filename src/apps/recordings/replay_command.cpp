#include <iostream>
#include <memory>

#include "commands.hpp"
#include "recording_replay.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_replay(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "plays a recording onto a robot's onboard domain");
  command->add_option("recording", options->recording,
                      "rosbag2 folder, .db3, .mcap, .bag or .pcap, KITTI folder, or a folder of scans");
  command->add_option("-c,--config", options->config,
                      "AGENT.yaml: its dds.onboard and recording keys are used");
  command->add_option("--as", options->as, "name of the robot that is played");
  command->add_option("--rate", options->rate, "speed, in multiples of real time")
      ->check(CLI::Range(0.01, 100.0));
  command->add_option("--wait", options->wait_for_reader, "s, time to wait for an agent that subscribes")
      ->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = report(replay_recording(*options, std::cout)); });
}

}  // namespace fleetmap::apps
