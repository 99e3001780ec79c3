#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace fleetmap::fault_injection {

/// Delta debugging (Zeller and Hildebrandt 2002, ddmin): a subset of 0 .. count - 1 that still `fails` and of
/// which no element can be left out. All of them must fail. The order is kept.
std::vector<std::size_t> shrink(std::size_t count,
                                const std::function<bool(const std::vector<std::size_t>&)>& fails);

}  // namespace fleetmap::fault_injection
