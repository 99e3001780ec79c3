#pragma once

#include <span>
#include <string>
#include <vector>

#include "basic_types.hpp"

namespace fleetmap::monitor::foxglove {

enum class LineType { strip, loop, list };  ///< as foxglove::LineType counts them

/// Lines in the map's frame, as wide on the screen at any distance.
struct Line {
  LineType type = LineType::strip;
  std::vector<Eigen::Vector3d> points;  ///< m
  double thickness = 2.0;               ///< pixels
  Color color;
};

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
  double diameter = 0.5;                             ///< m
  Color color;
};

/// An entity replaces the one of the same name that was sent before.
struct Entity {
  std::string id;
  Stamp stamp;
  std::vector<Sphere> spheres;
  std::vector<Line> lines;
};

/// foxglove::SceneUpdate, as CDR.
Bytes scene_update(std::span<const Entity> entities);

}  // namespace fleetmap::monitor::foxglove
