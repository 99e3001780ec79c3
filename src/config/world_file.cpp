#include "fleetmap/config/world_file.hpp"

#include <string>

#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

void read_drivable(Section& top, sim::DrivableConfig& drivable) {
  Section section = top.section("drivable");
  section.read("cell", drivable.cell);
  section.read("robot_height", drivable.robot_height);
  section.read("step_height", drivable.step_height);
  section.read_degrees("max_slope_deg", drivable.max_slope_rad);
  section.finish();
  section.check(drivable.validate());
}

void read_terrain(Section& top, sim::TerrainConfig& terrain) {
  Section section = top.section("terrain");
  section.read("rolling_amplitude", terrain.rolling_amplitude);
  section.read("rolling_wavelength", terrain.rolling_wavelength);
  section.read("rough_amplitude", terrain.rough_amplitude);
  section.read("rough_wavelength", terrain.rough_wavelength);
  section.read_degrees("slope_east_deg", terrain.slope_east_rad);
  section.read_degrees("slope_north_deg", terrain.slope_north_rad);
  section.finish();
  section.check(terrain.validate());
}

void read_fence(Section& top, sim::FenceConfig& fence) {
  Section section = top.section("fence");
  section.read("enabled", fence.enabled);
  section.read("height", fence.height);
  section.read("post_spacing", fence.post_spacing);
  section.read("wire_spacing", fence.wire_spacing);
  section.read("wire_width", fence.wire_width);
  section.finish();
  section.check(fence.validate());
}

void read_tables(Section& top, sim::SolarFarmConfig& farm) {
  top.read("row_pitch", farm.row_pitch);
  top.read_degrees("row_azimuth_deg", farm.row_azimuth_rad);
  top.read("table_length", farm.table_length);
  top.read("table_width", farm.table_width);
  top.read("table_thickness", farm.table_thickness);
  top.read("table_gap", farm.table_gap);
  top.read_degrees("tilt_deg", farm.tilt_rad);
  top.read("lower_edge_height", farm.lower_edge_height);
  top.read("post_spacing", farm.post_spacing);
  top.read("post_radius", farm.post_radius);
  top.read("missing_tables", farm.missing_tables);
  top.read_degrees("tilt_jitter_deg", farm.tilt_jitter_rad);
  top.read("height_jitter", farm.height_jitter);
  top.read("road_every", farm.road_every);
  top.read("road_width", farm.road_width);
}

sim::SolarFarmConfig read_solar_farm(Section& top) {
  sim::SolarFarmConfig farm;
  if (const auto size = top.numbers("size", 2)) {
    farm.size_east = (*size)[0];
    farm.size_north = (*size)[1];
  }
  top.read("seed", farm.seed);
  top.read("margin", farm.margin);
  top.read("headland", farm.headland);
  top.read("cabins", farm.cabins);
  top.read("trees", farm.trees);
  top.read("trees_inside", farm.trees_inside);
  top.read("terrain_cell", farm.terrain_cell);
  read_tables(top, farm);
  read_fence(top, farm.fence);
  read_terrain(top, farm.terrain);
  read_drivable(top, farm.drivable);
  top.finish();
  if (farm.terrain.validate() && farm.fence.validate() && farm.drivable.validate())
    top.check(farm.validate());
  return farm;
}

std::optional<Eigen::Vector2d> point_of(const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 2) return std::nullopt;
  Eigen::Vector2d point;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double& value = point[static_cast<Eigen::Index>(axis)];
    if (!node[axis].IsScalar() || !YAML::convert<double>::decode(node[axis], value)) return std::nullopt;
  }
  if (!point.allFinite()) return std::nullopt;
  return point;
}

void read_aisles(Document& document, Section& top, std::vector<sim::Aisle>& aisles) {
  if (!top.has("aisles")) return;
  const YAML::Node list = document.root()["aisles"];
  if (!list.IsSequence()) return top.problem("aisles", "expected a list of [[east, north], [east, north]]");
  for (std::size_t k = 0; k < list.size(); ++k) {
    const bool pair = list[k].IsSequence() && list[k].size() == 2;
    const auto from = pair ? point_of(list[k][0]) : std::nullopt;
    const auto to = pair ? point_of(list[k][1]) : std::nullopt;
    if (from && to) {
      aisles.push_back({*from, *to});
    } else {
      document.problem("aisles[" + std::to_string(k) + "]", list[k].Mark(),
                       "expected [[east, north], [east, north]] in metres");
    }
  }
}

sim::MeshWorld read_mesh_world(Document& document, Section& top) {
  sim::MeshWorld mesh;
  top.read_path("path", mesh.path);
  read_aisles(document, top, mesh.aisles);
  read_drivable(top, mesh.drivable);
  top.finish();
  if (mesh.drivable.validate()) top.check(mesh.validate());
  return mesh;
}

/// The line of WORLD.yaml that a world which cannot be built is to be mended in.
std::string place_of_mesh(const std::filesystem::path& file, const std::string& message) {
  const Result<Document> document = Document::load(file);
  if (!document) return file.string();
  const YAML::Node& root = document->root();
  const std::string key = message.starts_with("aisles") ? "aisles" : "path";
  const YAML::Node named = root[key];
  if (!named.IsDefined()) return file.string();
  return file.string() + ":" + std::to_string(named.Mark().line + 1) + ": " + key;
}

}  // namespace

Result<sim::WorldSpec> load_world(const std::filesystem::path& file) {
  Result<Document> document = Document::load(file);
  if (!document) return tl::unexpected(document.error());
  Section top(*document, document->root(), "");
  std::string kind;
  top.read("kind", kind);
  sim::WorldSpec spec;
  if (kind == "solar_farm") {
    spec = read_solar_farm(top);
  } else if (kind == "mesh") {
    spec = read_mesh_world(*document, top);
  } else {
    top.problem("kind", "expected 'solar_farm' or 'mesh', found '" + kind + "'");
  }
  if (const Status status = document->status(); !status) return tl::unexpected(status.error());
  return spec;
}

Result<std::shared_ptr<const sim::World>> make_world(const std::filesystem::path& file,
                                                     std::optional<std::uint64_t> seed) {
  const Result<sim::WorldSpec> spec = load_world(file);
  if (!spec) return tl::unexpected(spec.error());
  auto world = sim::build_world(*spec, seed);
  if (!world) return failure(place_of_mesh(file, world.error().message) + ": " + world.error().message);
  return world;
}

}  // namespace fleetmap::config
