#include "bag_metadata.hpp"

#include <yaml-cpp/yaml.h>

#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::recording {
namespace {

std::string text_or_empty(const YAML::Node& node) {
  return node && node.IsScalar() ? node.as<std::string>() : "";
}

void emit_span(YAML::Emitter& out, const BagMetadata& metadata, std::uint64_t messages) {
  out << YAML::Key << "duration" << YAML::Value << YAML::BeginMap << YAML::Key << "nanoseconds" << YAML::Value
      << metadata.last_ns - metadata.first_ns << YAML::EndMap;
  out << YAML::Key << "starting_time" << YAML::Value << YAML::BeginMap << YAML::Key
      << "nanoseconds_since_epoch" << YAML::Value << metadata.first_ns << YAML::EndMap;
  out << YAML::Key << "message_count" << YAML::Value << messages;
}

void emit_topic(YAML::Emitter& out, const BagMetadata::Topic& topic) {
  out << YAML::BeginMap << YAML::Key << "topic_metadata" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "name" << YAML::Value << topic.name << YAML::Key << "type" << YAML::Value << topic.type;
  out << YAML::Key << "serialization_format" << YAML::Value << "cdr";
  out << YAML::Key << "offered_qos_profiles" << YAML::Value << YAML::DoubleQuoted << topic.offered_qos
      << YAML::EndMap;
  out << YAML::Key << "message_count" << YAML::Value << topic.messages << YAML::EndMap;
}

}  // namespace

Result<BagMetadata> read_metadata(const std::filesystem::path& bag) {
  const std::string file = (bag / kMetadataFile).string();
  try {
    const YAML::Node info = YAML::LoadFile(file)["rosbag2_bagfile_information"];
    if (!info || !info.IsMap())
      return failure(file + ": has no rosbag2_bagfile_information; is this a rosbag2 folder?");
    BagMetadata metadata;
    metadata.storage = text_or_empty(info["storage_identifier"]);
    metadata.compression_format = text_or_empty(info["compression_format"]);
    metadata.compression_mode = text_or_empty(info["compression_mode"]);
    for (const YAML::Node& path : info["relative_file_paths"])
      metadata.files.push_back(path.as<std::string>());
    return metadata;
  } catch (const YAML::Exception& error) {
    return failure(file + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

Status write_metadata(const std::filesystem::path& bag, const BagMetadata& metadata) {
  std::uint64_t messages = 0;
  for (const auto& topic : metadata.topics) messages += topic.messages;
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "rosbag2_bagfile_information" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "version" << YAML::Value << 5;
  out << YAML::Key << "storage_identifier" << YAML::Value << metadata.storage;
  emit_span(out, metadata, messages);
  out << YAML::Key << "topics_with_message_count" << YAML::Value << YAML::BeginSeq;
  for (const auto& topic : metadata.topics) emit_topic(out, topic);
  out << YAML::EndSeq;
  out << YAML::Key << "compression_format" << YAML::Value << YAML::DoubleQuoted
      << metadata.compression_format;
  out << YAML::Key << "compression_mode" << YAML::Value << YAML::DoubleQuoted << metadata.compression_mode;
  out << YAML::Key << "relative_file_paths" << YAML::Value << metadata.files;
  out << YAML::Key << "files" << YAML::Value << YAML::BeginSeq;
  for (const auto& file : metadata.files) {
    out << YAML::BeginMap << YAML::Key << "path" << YAML::Value << file;
    emit_span(out, metadata, messages);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap << YAML::EndMap;

  return write_whole_file(bag / kMetadataFile, std::string(out.c_str()) + '\n');
}

}  // namespace fleetmap::recording
