#include "world_files.hpp"

#include <iomanip>
#include <ostream>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/planning/site/geojson_writer.hpp"
#include "fleetmap/sim/ground_truth.hpp"
#include "fleetmap/sim/mesh_file.hpp"
#include "options.hpp"
#include "robot/mission_setup.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {

void describe_world(std::ostream& out, const sim::World& world) {
  const Eigen::Vector2d size = world.bounds().high - world.bounds().low;
  out << std::fixed << std::setprecision(1) << "size " << size.x() << " m east, " << size.y()
      << " m north; east " << world.bounds().low.x() << " to " << world.bounds().high.x() << " m, north "
      << world.bounds().low.y() << " to " << world.bounds().high.y() << " m\n"
      << "mesh " << world.mesh().triangles.size() << " triangles, " << sim::area(world.mesh())
      << " m^2 of surface\n"
      << "lanes " << world.aisles().size() << ", blocks in the drawing " << world.drawing().keep_out.size()
      << '\n'
      << "drivable " << 100.0 * world.drivable_share() << " % of the area\n";
}

Status write_world(std::ostream& out, const sim::World& world, const std::filesystem::path& folder,
                   const WorldFileOptions& settings) {
  if (const Status writable = make_writable(folder); !writable) return writable;
  if (const Status written = sim::write_ply(folder / "world.ply", world.mesh()); !written) return written;
  if (const Status written = sim::write_obj(folder / "world.obj", world.mesh()); !written) return written;
  if (!world.aisles().empty()) {
    const auto drawing = sim::with_position_error(world.drawing(), settings.map_error, settings.seed);
    const Status drawn =
        planning::write_geojson(folder / "site.geojson", mission_on(drawing), LocalFrame(kSomewhere));
    if (!drawn) return drawn;
  }
  const cloud::PointCloud truth =
      sim::ground_truth(world, settings.density, settings.seed, settings.max_points);
  if (const Status written = cloud::write_cloud(folder / "truth.ply", truth); !written) return written;
  const double density = static_cast<double>(truth.size()) / sim::area(world.mesh());
  out << std::fixed << std::setprecision(1) << "truth " << truth.size() << " points, " << density
      << " per m^2";
  if (density < 0.99 * settings.density)
    out << " (not " << settings.density << ": --max-points allows " << settings.max_points << ")";
  out << "\nwritten to " << folder.string() << ": world.ply world.obj truth.ply"
      << (world.aisles().empty() ? "" : " site.geojson") << '\n';
  return {};
}

}  // namespace fleetmap::apps
