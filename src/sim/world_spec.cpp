#include "fleetmap/sim/world_spec.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include "fleetmap/sim/mesh_file.hpp"

namespace fleetmap::sim {
namespace {

Result<std::shared_ptr<const World>> build(const MeshWorld& spec) {
  if (const Status valid = spec.validate(); !valid) return tl::unexpected(valid.error());
  Result<Mesh> mesh = read_mesh(spec.path);
  if (!mesh) return tl::unexpected(mesh.error());
  auto world = World::create(std::move(*mesh), spec.drivable, SiteDrawing{spec.aisles, {}, {}, {}});
  if (!world) return failure(spec.path.string() + ": " + world.error().message);
  for (std::size_t k = 0; k < spec.aisles.size(); ++k) {
    const WorldBounds& bounds = (*world)->bounds();
    if (bounds.contains(spec.aisles[k].from) && bounds.contains(spec.aisles[k].to)) continue;
    char range[160];
    std::snprintf(range, sizeof range, "east %.1f to %.1f m, north %.1f to %.1f m", bounds.low.x(),
                  bounds.high.x(), bounds.low.y(), bounds.high.y());
    return failure("aisles[" + std::to_string(k) + "] leaves the mesh " + spec.path.string() +
                   ", which spans " + range + "; move its ends");
  }
  return world;
}

}  // namespace

Status MeshWorld::validate() const {
  if (path.empty()) return failure("path must name a .obj or .ply mesh");
  for (std::size_t k = 0; k < aisles.size(); ++k) {
    if (!aisles[k].from.allFinite() || !aisles[k].to.allFinite() ||
        (aisles[k].to - aisles[k].from).norm() < 0.1)
      return failure("aisles[" + std::to_string(k) + "] must be two different points");
  }
  if (const Status valid = drivable.validate(); !valid) return failure("drivable: " + valid.error().message);
  return {};
}

Result<std::shared_ptr<const World>> build_world(const WorldSpec& spec, std::optional<std::uint64_t> seed) {
  if (const auto* mesh = std::get_if<MeshWorld>(&spec)) return build(*mesh);
  SolarFarmConfig farm = std::get<SolarFarmConfig>(spec);
  farm.seed = seed.value_or(farm.seed);
  return make_solar_farm(farm);
}

}  // namespace fleetmap::sim
