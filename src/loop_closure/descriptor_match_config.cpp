#include "fleetmap/loop_closure/descriptor_match_config.hpp"

namespace fleetmap::loop_closure {

Status DescriptorMatchConfig::validate() const {
  if (!(spacing_m >= 0.0)) return failure("descriptor_match.spacing_m must not be negative");
  const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
  if (!share(min_similarity) || !share(sure_similarity)) {
    return failure("descriptor_match.min_similarity and sure_similarity must lie in [0, 1]");
  }
  if (!(min_support >= 0.0)) return failure("descriptor_match.min_support must not be negative");
  if (!(agree_m > 0.0) || !(agree_rad > 0.0)) {
    return failure("descriptor_match.agree_m and agree_rad must be positive");
  }
  if (kept == 0 || max_compared == 0) {
    return failure("descriptor_match.kept and max_compared must be at least 1");
  }
  return {};
}

}  // namespace fleetmap::loop_closure
