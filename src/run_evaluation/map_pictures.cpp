#include "fleetmap/run_evaluation/map_pictures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/eval/colours.hpp"
#include "fleetmap/eval/density.hpp"
#include "fleetmap/eval/picture.hpp"
#include "fleetmap/eval/png.hpp"

namespace fleetmap::run_evaluation {
namespace {

constexpr double kPointSize = 0.14;  // m: little more than the usual voxel of a map
constexpr double kWorstError = 0.3;  // m, at the red end

using Cell = std::array<std::int32_t, 2>;

Cell cell_of(const Eigen::Vector3f& p) {
  constexpr float kCell = 3.0f;  // m: wider than a table of panels hides the ground
  const auto index = [](float v) {
    return static_cast<std::int32_t>(std::clamp(std::floor(v / kCell), -1e9f, 1e9f));
  };
  return {index(p.x()), index(p.y())};
}

/// m, of each point above the ground: a low quantile of its cell, and of the cells around it the median, so
/// that stray points under the ground do not matter.
std::vector<float> heights_above_ground(const cloud::PointCloud& cloud) {
  std::map<Cell, std::vector<float>> levels;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (p.allFinite()) levels[cell_of(p)].push_back(p.z());
  }
  std::map<Cell, float> low;
  for (auto& [cell, z] : levels) {
    const auto at = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 10);
    std::nth_element(z.begin(), at, z.end());
    low[cell] = *at;
  }
  std::map<Cell, float> ground;
  for (const auto& [cell, z] : low) {
    std::vector<float> around;
    for (int k = 0; k < 9; ++k) {
      const auto near = low.find({cell[0] + k % 3 - 1, cell[1] + k / 3 - 1});
      if (near != low.end()) around.push_back(near->second);
    }
    std::ranges::sort(around);
    ground[cell] = around[(around.size() - 1) / 2];
  }
  std::vector<float> heights(cloud.size(), 0.0f);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (p.allFinite()) heights[i] = p.z() - ground.at(cell_of(p));
  }
  return heights;
}

/// Dim on the ground, as it is at 1.5 m and whitish above.
eval::Rgb toned(eval::Rgb colour, float height) {
  const double h = static_cast<double>(std::clamp(height, 0.0f, 4.0f));
  const double light = 0.55 + 0.45 * std::min(1.0, h / 1.5);
  const double white = 0.35 * std::clamp((h - 1.5) / 2.5, 0.0, 1.0);
  const auto tone = [&](std::uint8_t v) {
    return static_cast<std::uint8_t>(std::lround((1.0 - white) * light * v + white * 255.0));
  };
  return {tone(colour.r), tone(colour.g), tone(colour.b)};
}

Result<MapPicture> drawn(std::string file, std::string caption, const cloud::PointCloud& cloud,
                         const std::vector<eval::Rgb>& colours, eval::View view) {
  view.point_size = kPointSize;
  view.title = caption;
  const auto image = eval::render(cloud, colours, view);
  if (!image) return tl::unexpected(image.error());
  auto png = eval::encode_png(*image);
  if (!png) return tl::unexpected(png.error());
  return MapPicture{std::move(file), std::move(caption), std::move(*png)};
}

/// A band of points along the path at height `z`, without gaps and wide enough to be seen.
void add_path(const Path& path, float z, std::vector<Eigen::Vector3f>& points) {
  constexpr double kStep = 0.5 * kPointSize;  // m
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector3d step = path[i] - path[i - 1];
    const int parts = static_cast<int>(std::clamp(std::ceil(step.norm() / kStep), 1.0, 1000.0));
    for (int part = 0; part < parts; ++part) {
      const Eigen::Vector3d at = path[i - 1] + step * part / parts;
      for (const auto& [east, north] :
           {std::pair{0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}})
        points.emplace_back(static_cast<float>(at.x() + kPointSize * east),
                            static_cast<float>(at.y() + kPointSize * north), z);
    }
  }
}

/// 1, 2 or 5 times a power of ten, at least `value`.
double rounded_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace

Result<std::vector<MapPicture>> pictures_by_robot(const store::MergedMap& map) {
  const std::vector<float> heights = heights_above_ground(map.cloud);
  std::vector<eval::Rgb> colours(map.cloud.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const std::size_t robot = i < map.observed_by.size() ? map.observed_by[i] : 0;
    colours[i] = toned(eval::robot_colour(robot), heights[i]);
  }
  eval::View view;
  for (std::size_t k = 0; k < map.agents.size(); ++k)
    view.legend.push_back({map.agents[k].str(), eval::robot_colour(k)});
  auto top = drawn("map_top.png", "Map from above by robot", map.cloud, colours, view);
  if (!top) return tl::unexpected(top.error());
  view.projection = eval::Projection::kPerspective;
  auto perspective = drawn("map_perspective.png", "Map by robot", map.cloud, colours, view);
  if (!perspective) return tl::unexpected(perspective.error());
  return std::vector<MapPicture>{std::move(*top), std::move(*perspective)};
}

Result<MapPicture> picture_with_paths(const cloud::PointCloud& map, const std::vector<std::string>& robots,
                                      const std::vector<Path>& paths) {
  constexpr eval::Rgb kMap{150, 158, 168};
  const std::vector<float> heights = heights_above_ground(map);
  cloud::PointCloud shown{map.points, {}};
  std::vector<eval::Rgb> colours;
  float top = 0.0f;
  for (std::size_t i = 0; i < map.size(); ++i) {
    colours.push_back(toned(kMap, heights[i]));
    if (map.points[i].allFinite()) top = std::max(top, map.points[i].z());
  }
  eval::View view;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    view.legend.push_back({robots[k], eval::robot_colour(k)});
    // Above all that the map shows, or a roof would hide where a robot drove.
    add_path(paths[k], top + 1.0f, shown.points);
    colours.resize(shown.size(), eval::robot_colour(k));
  }
  return drawn("map_plan.png", "Map from above, with the paths of the robots", shown, colours, view);
}

Result<MapPicture> picture_of_errors(const cloud::PointCloud& points, const std::vector<float>& errors) {
  std::vector<eval::Rgb> colours;
  colours.reserve(errors.size());
  for (const float error : errors) colours.push_back(eval::turbo(static_cast<double>(error) / kWorstError));
  eval::View view;
  view.bar = {"distance to the truth [m]", 0.0, kWorstError, true};
  view.bar_is_turbo = true;
  return drawn("map_error.png", "Error of the map", points, colours, view);
}

Result<MapPicture> picture_of_density(const cloud::PointCloud& map, double radius) {
  cloud::PointCloud shown = map;
  for (float voxel = 0.1f; shown.size() > kMaxDrawn; voxel *= 1.5f) {
    cloud::VoxelMerger merger(voxel);
    merger.add(shown);
    shown = merger.cloud();
  }
  return picture_of_density(shown, eval::density_at(shown.points, map.points, static_cast<float>(radius)),
                            radius);
}

Result<MapPicture> picture_of_density(const cloud::PointCloud& shown,
                                      const std::vector<std::uint32_t>& counts, double radius) {
  if (counts.empty()) return failure("there is no point to draw");
  std::vector<std::uint32_t> sorted = counts;
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  const double max_count = rounded_up(std::max(1.0, static_cast<double>(*at)));
  std::vector<eval::Rgb> colours;
  colours.reserve(counts.size());
  for (const std::uint32_t count : counts) colours.push_back(eval::viridis(count / max_count));
  eval::View view;
  view.bar = {"points within " + std::to_string(static_cast<int>(std::lround(radius))) + " m", 0.0, max_count,
              true};
  return drawn("map_density.png", "Density of the map", shown, colours, view);
}

void add_density(const cloud::PointCloud& shown, const cloud::PointCloud& tile, double radius,
                 std::vector<std::uint32_t>& counts) {
  const auto reach = static_cast<float>(radius);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : tile.points) box.extend(p);
  box.min().array() -= reach;
  box.max().array() += reach;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (box.contains(shown.points[i])) near.push_back(i);
  }
  const auto more = eval::density_at(cloud::select(shown, near).points, tile.points, reach);
  for (std::size_t k = 0; k < near.size(); ++k) counts[near[k]] += more[k];
}

Status write_picture(const std::filesystem::path& directory, const MapPicture& picture) {
  return write_whole_file(directory / picture.file, picture.png);
}

}  // namespace fleetmap::run_evaluation
