#include "fleetmap/output/sea_level_heights.hpp"

namespace fleetmap::output {
namespace {

constexpr const char* kSeaLevelKey = "sea_level_heights";

}  // namespace

Status keep_sea_level_heights(store::Store& store) { return store.set_meta(kSeaLevelKey, Bytes{1}); }

bool has_sea_level_heights(const store::Store& store) {
  const auto kept = store.meta(kSeaLevelKey);
  return kept && kept->has_value();
}

}  // namespace fleetmap::output
