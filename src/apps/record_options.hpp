#pragma once

#include <string>

#include "fleetmap/recording/bag_format.hpp"

namespace CLI {
class App;
}

namespace fleetmap::apps {

/// Folder and format of the bags that a command writes.
struct RecordOptions {
  std::string folder;  ///< empty: none
  recording::BagFormat format;
};

/// Adds --record with `text` as its description, --record-format and --record-compression.
void add_record_options(CLI::App& command, RecordOptions& options, const std::string& text);

}  // namespace fleetmap::apps
