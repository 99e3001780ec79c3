#include "recording_input.hpp"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/recording/survey.hpp"
#include "health/sensor_settings.hpp"

namespace fleetmap::apps {

Result<Preparation> prepare(const std::filesystem::path& recording, const recording::ReaderConfig& reader,
                            agent::PerceptionConfig& config) {
  auto survey = recording::survey(recording, reader);
  if (!survey) return tl::unexpected(survey.error());
  auto mounts = agent::SensorMounts::of_recording(survey->frames, config);
  mounts.apply_to(config);
  config.gyro_in_degrees = std::move(survey->gyro_in_degrees);
  config.findings_before = mounts.take_warnings();
  return Preparation{survey->clock, mounts.summaries(), config.findings_before};
}

void log_preparation(const Preparation& prepared, const std::string& source) {
  const std::string start = source.empty() ? "" : source + ": ";
  for (const std::string& mount : prepared.mounts) spdlog::info("{}{}", start, mount);
  for (const std::string& finding : prepared.findings) spdlog::warn("{}{}", start, finding);
}

CommandResult<RecordingInput> open_recording(const RecordingOptions& options) {
  auto config = sensor_settings(options.config, options.set);
  if (!config) return tl::unexpected(config.error());
  recording::ReaderConfig reader_config =
      config->recording ? config->recording->reader : recording::ReaderConfig{};
  reader_config.ouster_metadata = config->agent.perception.ouster.metadata;
  reader_config.scans_needed = options.scans_needed;
  auto reader = recording::open(options.recording, reader_config);
  if (!reader) return exit_with(kFailed, reader.error());
  auto prepared = prepare(options.recording, reader_config, config->agent.perception);
  if (!prepared) return exit_with(kFailed, prepared.error());
  return RecordingInput{std::move(*config), std::move(*reader), std::move(*prepared)};
}

}  // namespace fleetmap::apps
