#include "shrink.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>

namespace fleetmap::fault_injection {
namespace {

using Subset = std::vector<std::size_t>;
using Fails = std::function<bool(const Subset&)>;

/// `all` without the `k`-th of `parts` equal parts.
Subset without_part(const Subset& all, std::size_t k, std::size_t parts) {
  const std::size_t first = all.size() * k / parts, end = all.size() * (k + 1) / parts;
  Subset rest(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first));
  rest.insert(rest.end(), all.begin() + static_cast<std::ptrdiff_t>(end), all.end());
  return rest;
}

std::optional<Subset> smaller(const Subset& all, std::size_t parts, const Fails& fails) {
  for (std::size_t k = 0; k < parts; ++k) {
    Subset rest = without_part(all, k, parts);
    if (fails(rest)) return rest;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> shrink(std::size_t count, const Fails& fails) {
  Subset all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (std::size_t parts = 2; !all.empty();) {
    parts = std::min(parts, all.size());
    if (auto rest = smaller(all, parts, fails)) {
      all = std::move(*rest);
      parts = std::max<std::size_t>(parts - 1, 2);
    } else if (parts == all.size()) {
      break;
    } else {
      parts *= 2;
    }
  }
  return all;
}

}  // namespace fleetmap::fault_injection
