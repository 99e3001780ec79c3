#include "obj_format.hpp"

#include <cstdint>

#include "fleetmap/sim/mesh_file.hpp"
#include "mesh_text.hpp"

namespace fleetmap::sim {
namespace {

/// The material of the next surfaces: the last `usemtl`, or the group or object with a better known name.
struct Names {
  Material material = Material::kConcrete, group = Material::kConcrete, object = Material::kConcrete;
  Material current() const {
    if (material != Material::kConcrete) return material;
    return group != Material::kConcrete ? group : object;
  }
};

Status read_vertex(std::string_view line, std::size_t number, Mesh& mesh) {
  Eigen::Vector3d p;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::string_view word = next_word(line);
    const auto value = number_from<double>(word);
    if (!value)
      return failure_at_line(number, "expected three numbers behind 'v', found " + in_quotes(word) +
                                         "; repair the line or export the mesh again");
    if (!is_coordinate(*value)) return failure_at_line(number, kCoordinateRule);
    p[axis] = *value;
  }
  mesh.vertices.emplace_back(p.cast<float>());
  return {};
}

/// "7", "7/1", "7//3" or "-1/2/3": the vertex, counted from 1, or from the last backwards.
Result<std::uint32_t> corner_of(std::string_view word, std::size_t number, std::size_t vertices) {
  const auto index = number_from<std::int64_t>(word.substr(0, word.find('/')));
  const auto count = static_cast<std::int64_t>(vertices);
  if (!index || *index == 0 || *index > count || *index < -count)
    return failure_at_line(number, in_quotes(word) + " names none of the " + std::to_string(count) +
                                       " vertices above; repair the line or export the mesh again");
  return static_cast<std::uint32_t>(*index > 0 ? *index - 1 : count + *index);
}

Status read_face(std::string_view line, std::size_t number, Material material, Mesh& mesh) {
  std::uint32_t first = 0, previous = 0;
  std::size_t corners = 0;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
    const auto corner = corner_of(word, number, mesh.vertices.size());
    if (!corner) return tl::unexpected(corner.error());
    if (corners == 0) first = *corner;
    if (corners >= 2) add_fan(mesh, first, previous, *corner, material);
    previous = *corner;
    ++corners;
  }
  if (corners < 3) return failure_at_line(number, "a face needs three corners; remove the line");
  return {};
}

}  // namespace

Result<Mesh> parse_obj(std::string_view content) {
  Mesh mesh;
  Names names;
  Lines lines(content);
  for (std::string_view line; lines.next(line);) {
    const std::string_view key = next_word(line);
    Status status;
    if (key == "v") status = read_vertex(line, lines.number(), mesh);
    if (key == "f") status = read_face(line, lines.number(), names.current(), mesh);
    if (key == "usemtl") names.material = material_named(line);
    if (key == "g") names.group = material_named(line);
    if (key == "o") names.object = material_named(line);
    if (!status) return tl::unexpected(status.error());
  }
  return mesh;
}

}  // namespace fleetmap::sim
