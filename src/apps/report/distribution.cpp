#include "distribution.hpp"

#include <algorithm>
#include <numeric>

namespace fleetmap::apps {

Distribution distribution(std::vector<double> values) {
  Distribution d;
  d.count = values.size();
  if (values.empty()) return d;
  std::ranges::sort(values);
  const auto quantile = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
  };
  d.min = values.front();
  d.max = values.back();
  d.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  d.p50 = quantile(0.5);
  d.p99 = quantile(0.99);
  return d;
}

}  // namespace fleetmap::apps
