#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/planning/site/geojson.hpp"
#include "fleetmap/planning/site/geojson_writer.hpp"
#include "fleetmap/sim/ground_truth.hpp"
#include "fleetmap/sim/mesh_file.hpp"
#include "mission_setup.hpp"
#include "options.hpp"
#include "twin_setup.hpp"

namespace fleetmap::apps {
namespace {

struct WorldOptions {
  std::string file;
  std::string out;
  std::optional<std::uint64_t> seed;
  double map_error = 0.5;
  double density = 400.0;
  std::size_t max_points = 20'000'000;
};

void describe(const sim::World& world, double surface) {
  const Eigen::Vector2d size = world.bounds().high - world.bounds().low;
  std::cout << std::fixed << std::setprecision(1) << "size " << size.x() << " m east, " << size.y()
            << " m north; east " << world.bounds().low.x() << " to " << world.bounds().high.x()
            << " m, north " << world.bounds().low.y() << " to " << world.bounds().high.y() << " m\n"
            << "mesh " << world.mesh().triangles.size() << " triangles, " << surface << " m^2 of surface\n"
            << "lanes " << world.aisles().size() << ", blocks in the drawing "
            << world.drawing().keep_out.size() << '\n'
            << "drivable " << 100.0 * world.drivable_share() << " % of the area\n";
}

Status write(const sim::World& world, double surface, const WorldOptions& options) {
  const std::filesystem::path folder(options.out);
  if (const Status writable = make_writable(folder); !writable) return writable;
  if (const Status written = sim::write_ply(folder / "world.ply", world.mesh()); !written) return written;
  if (const Status written = sim::write_obj(folder / "world.obj", world.mesh()); !written) return written;
  if (!world.aisles().empty()) {
    const auto drawing =
        sim::with_position_error(world.drawing(), options.map_error, options.seed.value_or(1));
    const Status drawn =
        planning::write_geojson(folder / "site.geojson", mission_on(drawing), LocalFrame(kSomewhere));
    if (!drawn) return drawn;
  }
  const cloud::PointCloud truth =
      sim::ground_truth(world, options.density, options.seed.value_or(1), options.max_points);
  if (const Status written = cloud::write_cloud(folder / "truth.ply", truth); !written) return written;
  const double density = static_cast<double>(truth.size()) / surface;
  std::cout << "truth " << truth.size() << " points, " << density << " per m^2";
  if (density < 0.99 * options.density)
    std::cout << " (not " << options.density << ": --max-points allows " << options.max_points << ")";
  std::cout << "\nwritten to " << options.out << ": world.ply world.obj truth.ply"
            << (world.aisles().empty() ? "" : " site.geojson") << '\n';
  return {};
}

int make(const WorldOptions& options) {
  const auto spec = config::load_world(options.file);
  if (!spec) return report(spec.error(), kBadConfiguration);
  const auto world = config::make_world(options.file, options.seed);
  if (!world) return report(world.error(), kBadConfiguration);
  const double surface = sim::area((*world)->mesh());
  describe(**world, surface);
  if (options.out.empty()) return kDone;
  if (const Status written = write(**world, surface, options); !written)
    return report(written.error(), kFailed);
  return kDone;
}

}  // namespace

void add_world(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<WorldOptions>();
  CLI::App* command =
      app.add_subcommand("world", "make a world of the twin: its mesh and ground-truth points");
  command->add_option("file", options->file, "WORLD.yaml")->required();
  command
      ->add_option("--out", options->out,
                   "folder for world.ply, world.obj, truth.ply and site.geojson; else it is only described")
      ->check(some_path());
  command->add_option("--seed", options->seed, "instead of the file's")->check(whole_number(0));
  command
      ->add_option("--map-error", options->map_error,
                   "m, by which site.geojson, the drawing of the site for a mission, is off")
      ->check(non_negative_number());
  command->add_option("--density", options->density, "ground-truth points per m^2 of surface")
      ->check(positive_number());
  command->add_option("--max-points", options->max_points, "ground-truth points at most")
      ->check(whole_number(1, 200'000'000));
  command->callback([options, &exit_code] { exit_code = make(*options); });
}

}  // namespace fleetmap::apps
