#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "world_file_options.hpp"

namespace fleetmap::apps {

/// A world that is made, as the command line has it.
struct WorldOptions {
  std::string file;                   ///< WORLD.yaml
  std::string out;                    ///< folder; empty: the world is only described
  std::optional<std::uint64_t> seed;  ///< instead of the file's
  WorldFileOptions files;
};

}  // namespace fleetmap::apps
