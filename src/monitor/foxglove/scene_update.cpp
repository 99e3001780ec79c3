#include "scene_update.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

void write(CdrWriter& cdr, const Sphere& sphere) {
  foxglove::write(cdr, Pose(Eigen::Translation3d(sphere.centre)));
  foxglove::write(cdr, Eigen::Vector3d(Eigen::Vector3d::Constant(sphere.diameter)));
  foxglove::write(cdr, sphere.color);
}

void write(CdrWriter& cdr, const Line& line) {
  cdr.enumerator(line.type);
  foxglove::write(cdr, Pose(Pose::Identity()));
  cdr.number(line.thickness);
  cdr.flag(true);  // pixels
  cdr.count(line.points.size());
  for (const Eigen::Vector3d& point : line.points) foxglove::write(cdr, point);
  foxglove::write(cdr, line.color);
  cdr.count(0);  // colours of single points
  cdr.count(0);  // indices
}

template <class Primitive>
void write_all(CdrWriter& cdr, const std::vector<Primitive>& primitives) {
  cdr.count(primitives.size());
  for (const Primitive& primitive : primitives) write(cdr, primitive);
}

void write(CdrWriter& cdr, const Entity& entity) {
  foxglove::write(cdr, entity.stamp);
  cdr.text(kMapFrame);
  cdr.text(entity.id);
  cdr.number(std::int32_t{0});  // lifetime: until it is replaced
  cdr.number(std::uint32_t{0});
  cdr.flag(false);  // frame_locked
  cdr.count(0);     // metadata
  cdr.count(0);     // arrows
  cdr.count(0);     // cubes
  write_all(cdr, entity.spheres);
  cdr.count(0);  // cylinders
  write_all(cdr, entity.lines);
  cdr.count(0);  // triangles
  cdr.count(0);  // texts
  cdr.count(0);  // models
}

}  // namespace

Bytes scene_update(std::span<const Entity> entities) {
  CdrWriter cdr;
  cdr.count(0);  // deletions
  cdr.count(entities.size());
  for (const Entity& entity : entities) write(cdr, entity);
  return std::move(cdr).message();
}

}  // namespace fleetmap::monitor::foxglove
