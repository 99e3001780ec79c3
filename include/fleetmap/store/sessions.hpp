#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::store {

/// The sessions of a robot that began with this store, in their order. A session is an odometry frame: one
/// begins with each start of the program and whenever the odometry begins anew.
///
/// Their numbers are drawn at random, since a lost, restored or replaced store lacks sessions that the fleet
/// has, so the used numbers cannot be derived from it. 65,535 numbers make it unlikely (1 in 650 for a robot
/// that lost a hundred sessions) that one is drawn twice.
class Sessions {
 public:
  using Draw = std::function<std::uint16_t()>;

  static Result<Sessions> load(const Store& store);
  /// A number that no own item in the store bears and that no session began with.
  Result<std::uint16_t> draw(const Store& store, const Draw& draw) const;
  /// The same, which is stored before it is used.
  Result<std::uint16_t> begin(Store& store, const Draw& draw);
  /// Counts from 0; nothing for a session that began with another store.
  std::optional<std::size_t> index_of(std::uint16_t session) const;

 private:
  std::vector<std::uint16_t> numbers_;
};

/// From the operating system's source of entropy.
std::uint16_t random_session();

}  // namespace fleetmap::store
