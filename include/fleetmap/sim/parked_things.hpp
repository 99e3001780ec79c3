#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// The world with `count` things more that nobody drew: pallets, trailers and vans, two of three of them in
/// lanes, the others on free ground of the site. A lane may be narrowed or closed by one. They stand at least
/// 6 m from each of `keep_free` and from each other; the drawing stays as it is. The same seed gives the same
/// world. Fails if there is no room for so many.
Result<std::shared_ptr<const World>> with_parked_things(const World& world, std::size_t count,
                                                        std::uint64_t seed,
                                                        std::span<const Eigen::Vector2d> keep_free);

}  // namespace fleetmap::sim
