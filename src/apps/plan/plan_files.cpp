#include "plan_files.hpp"

#include <string>
#include <vector>

#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/eval/colours.hpp"
#include "fleetmap/eval/picture.hpp"
#include "fleetmap/eval/png.hpp"
#include "fleetmap/planning/mission/plan_geojson.hpp"
#include "plan_picture.hpp"

namespace fleetmap::apps {

Result<std::filesystem::path> write_plan(const planning::FleetPlan& plan, const DrawnSite& site,
                                         const std::filesystem::path& out) {
  std::vector<std::string> colours;
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) colours.push_back(eval::hex(eval::robot_colour(k)));
  const std::string text = planning::to_geojson(plan, colours, site.enu, site.frame);
  if (const Status written = write_whole_file(out, text); !written) return tl::unexpected(written.error());
  const auto image = picture_of(plan);
  if (!image) return tl::unexpected(image.error());
  const std::filesystem::path picture = std::filesystem::path(out).replace_extension(".png");
  if (const Status drawn = eval::write_png(picture, *image); !drawn) return tl::unexpected(drawn.error());
  return picture;
}

}  // namespace fleetmap::apps
