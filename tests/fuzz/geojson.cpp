// A site's drawing in GeoJSON.
#include "fleetmap/planning/site/geojson.hpp"

#include "checks.hpp"
#include "fleetmap/planning/site/geojson_writer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const std::string text(fuzz::text_of({data, size}));
  const LocalFrame site(geo_point_from_degrees(49.0, 8.4, 110.0));
  static_cast<void>(planning::first_position(text));
  const auto mission = planning::parse_geojson(text, "site.geojson", site);
  if (!mission) {
    fuzz::require(mission.error().message.starts_with("site.geojson"), "the error does not name the file");
    return 0;
  }
  const std::string written = planning::to_geojson(*mission, site, planning::FileFrame::kEnu);
  // Written numbers are rounded, also those at the limit.
  const auto again = planning::parse_geojson(written, "again.geojson", site, {.reach = 10'001.0});
  fuzz::require(again && again->rows.size() == mission->rows.size(), "a mission cannot be read again");
  return 0;
}
