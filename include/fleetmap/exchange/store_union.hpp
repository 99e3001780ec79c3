#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/exchange/item_proof.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

/// Result of add_items().
struct StoreUnion {
  std::size_t nodes = 0;               ///< added
  std::size_t alignments = 0;          ///< added
  std::size_t submaps = 0;             ///< added
  std::size_t known = 0;               ///< nodes and alignments that were there already
  std::size_t unproven = 0;            ///< contents left out, since nothing proves who made them
  std::size_t unreadable = 0;          ///< submaps that are damaged in `from`
  std::vector<std::string> contested;  ///< names that became contested: "node r1/17", "alignment r1/3"
};

/// Adds all items of `from` to `into`, as an exchange over the radios would: what is there stays, two
/// contents of one name contest it and neither is used, and contested names bring both contents. With `keys`,
/// contents without a genuine signature are left out. `into` must belong to none of the robots that made the
/// items. Fails when a file fails.
Result<StoreUnion> add_items(store::Store& into, store::Store& from, const ItemAuthenticator* keys);

}  // namespace fleetmap::exchange
