#include "record_options.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "validators.hpp"

namespace fleetmap::apps {
namespace {

using recording::BagStorage;
using recording::ChunkCompression;

const std::map<std::string, BagStorage> kStorages{{"mcap", BagStorage::kMcap},
                                                  {"sqlite3", BagStorage::kSqlite}};
const std::map<std::string, ChunkCompression> kCompressions{
    {"zstd", ChunkCompression::kZstd}, {"lz4", ChunkCompression::kLz4}, {"none", ChunkCompression::kNone}};

template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& text) {
  CLI::Option* option = command.add_option_function<std::string>(
      name, [&value, &choices](const std::string& word) { value = choices.at(word); }, text);
  return option->check(CLI::IsMember(&choices));
}

}  // namespace

void add_record_options(CLI::App& command, RecordOptions& options, const std::string& text) {
  CLI::Option* record = command.add_option("--record", options.folder, text)->check(some_path());
  add_choice(command, "--record-format", options.format.storage, kStorages,
             "rosbag2 storage: mcap, or sqlite3 for ROS 2 Humble without its MCAP plugin; default mcap")
      ->needs(record);
  add_choice(command, "--record-compression", options.format.compression, kCompressions,
             "of the chunks of MCAP; default zstd")
      ->needs(record)
      ->check([&options](const std::string&) {  // after --record-format, wherever that is on the command line
        return options.format.storage == BagStorage::kSqlite
                   ? "applies to MCAP; sqlite3 recordings are not compressed"
                   : "";
      });
}

}  // namespace fleetmap::apps
