#include "search_radius.hpp"

#include <cmath>
#include <cstring>

namespace fleetmap::output {
namespace {

constexpr const char* kRadiusKey = "search_radius";

}  // namespace

Status keep_search_radius(store::Store& store, double radius_m) {
  Bytes bytes(sizeof(radius_m));
  std::memcpy(bytes.data(), &radius_m, sizeof(radius_m));
  return store.set_meta(kRadiusKey, bytes);
}

std::optional<double> search_radius(const store::Store& store) {
  double radius_m = 0.0;
  const auto bytes = store.meta(kRadiusKey);
  if (!bytes || !*bytes || (*bytes)->size() != sizeof(radius_m)) return std::nullopt;
  std::memcpy(&radius_m, (*bytes)->data(), sizeof(radius_m));
  if (!std::isfinite(radius_m) || radius_m <= 0.0) return std::nullopt;
  return radius_m;
}

}  // namespace fleetmap::output
