#include "recording_input.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/recording/survey.hpp"
#include "options.hpp"

namespace fleetmap::apps {

void add_recording_options(CLI::App& command, RecordingOptions& options) {
  command
      .add_option("recording", options.recording,
                  "rosbag2 folder, .db3, .mcap, .bag or .pcap, KITTI folder, or a folder of scans")
      ->required();
  command.add_option("-c,--config", options.config, "AGENT.yaml or FLEET.yaml for the sensors");
  command.add_option("--set", options.set, "key=value, e.g. lidar.model=hdl64e")->allow_extra_args(false);
}

Result<Preparation> prepare(const std::filesystem::path& recording, const recording::ReaderConfig& reader,
                            agent::PerceptionConfig& config) {
  auto survey = recording::survey(recording, reader);
  if (!survey) return tl::unexpected(survey.error());
  auto mounts = agent::SensorMounts::of_recording(survey->frames, config);
  mounts.apply_to(config);
  config.gyro_in_degrees = std::move(survey->gyro_in_degrees);
  return Preparation{survey->clock, mounts.summaries(), mounts.take_warnings()};
}

tl::expected<RecordingInput, int> open_recording(const RecordingOptions& options) {
  const auto failed = [](const Error& error, ExitCode code) { return tl::unexpected(report(error, code)); };
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return failed(overrides.error(), kUsage);
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) file = options.config;
  auto config = config::load_sensors(file, *overrides);
  if (!config) return failed(config.error(), kBadConfiguration);
  recording::ReaderConfig reader_config =
      config->recording ? config->recording->reader : recording::ReaderConfig{};
  reader_config.scans_needed = options.scans_needed;
  auto reader = recording::open(options.recording, reader_config);
  if (!reader) return failed(reader.error(), kFailed);
  auto prepared = prepare(options.recording, reader_config, config->agent.perception);
  if (!prepared) return failed(prepared.error(), kFailed);
  return RecordingInput{std::move(*config), std::move(*reader), std::move(*prepared)};
}

}  // namespace fleetmap::apps
