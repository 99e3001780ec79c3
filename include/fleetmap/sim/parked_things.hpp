#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// Returns the world with `count` more things that its drawing lacks: pallets, trailers and vans, two of
/// three in lanes, the others on free ground of the site. One of them may narrow or close a lane. They keep 6
/// m from each of `keep_free` and from each other. The same seed yields the same world. Fails if there is no
/// room for so many.
Result<std::shared_ptr<const World>> with_parked_things(const World& world, std::size_t count,
                                                        std::uint64_t seed,
                                                        std::span<const Eigen::Vector2d> keep_free);

}  // namespace fleetmap::sim
