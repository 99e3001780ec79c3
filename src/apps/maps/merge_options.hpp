#pragma once

#include <string>
#include <vector>

namespace fleetmap::apps {

/// Stores that become one, as the command line has them.
struct MergeOptions {
  std::vector<std::string> stores;
  std::string out;       ///< FILE.db, or a folder for store.db
  std::string keys;      ///< folder of a member's keys; empty: signatures are not checked
  bool verbose = false;  ///< each reason of a rejection, and not those with other numbers as one
};

}  // namespace fleetmap::apps
