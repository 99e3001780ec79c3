#include "sensor_recorder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "recordings/sample_player.hpp"

namespace fleetmap::apps {
namespace {

std::filesystem::path free_folder(const std::filesystem::path& directory) {
  std::filesystem::path folder = directory;
  for (int k = 1; is_there(folder); ++k) folder = directory.string() + "-" + std::to_string(k);
  return folder;
}

}  // namespace

recording::Durability durability_of(const bus::Topic& topic) {
  return topic.profile == "sensor" ? recording::Durability::kVolatile
                                   : recording::Durability::kTransientLocal;
}

SensorRecorder::SensorRecorder(recording::BagWriter writer, const agent::SensorTopics& topics, bool outputs,
                               bus::Bus& bus)
    : writer_(std::move(writer)) {
  std::vector<bus::Topic> recorded = sensor_topics(topics);
  recorded.push_back(ros_codec::topics::tf_static());
  for (const bus::Topic& output : outputs ? ros_codec::topics::outputs() : std::vector<bus::Topic>()) {
    if (std::ranges::find(recorded, output.name, &bus::Topic::name) == recorded.end())
      recorded.push_back(output);
  }
  for (const bus::Topic& topic : recorded) {
    subscriptions_.push_back(bus.subscribe(topic, [this, topic, &bus](const Bytes& cdr) {
      if (!problem_.empty()) return;
      const Status written = writer_.write(topic.name, topic.type, bus.now(), cdr, durability_of(topic));
      if (!written) stop(written.error().message);
    }));
  }
}

Result<std::unique_ptr<SensorRecorder>> SensorRecorder::create(const RecordOptions& options,
                                                               const agent::SensorTopics& topics,
                                                               bool outputs, bus::Bus& bus) {
  auto writer = recording::BagWriter::create(free_folder(options.folder), options.format);
  if (!writer) return tl::unexpected(writer.error());
  return std::unique_ptr<SensorRecorder>(new SensorRecorder(std::move(*writer), topics, outputs, bus));
}

void SensorRecorder::stop(const std::string& problem) {
  problem_ = problem;
  spdlog::error("recording stopped: {}", problem);
}

Status SensorRecorder::close() {
  subscriptions_.clear();
  const Status closed = writer_.close();
  if (!closed && problem_.empty()) stop(closed.error().message);
  return closed;
}

}  // namespace fleetmap::apps
