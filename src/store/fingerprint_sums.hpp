#pragma once

#include <cstdint>
#include <map>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/store/seq_set.hpp"

namespace fleetmap::store {

/// Fingerprints of items by their names, and their sum over a range without a visit to each: blocks of
/// numbers have their sums.
class FingerprintSums {
 public:
  void set(const NodeId& name, std::uint32_t print);
  std::uint32_t of(const SeqRange& range) const;

 private:
  std::map<NodeId, std::uint32_t> prints_;
  std::map<NodeId, std::uint32_t> blocks_;  ///< by the first name of the block
};

}  // namespace fleetmap::store
