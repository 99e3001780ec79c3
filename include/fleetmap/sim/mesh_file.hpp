#pragma once

#include <filesystem>
#include <string_view>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/mesh.hpp"

/// The readers are ours rather than assimp's. Assimp 5.2.5 crashed on 2 of the 48 inputs of tests/fuzz/corpus
/// and did not end within 8 s of processor time on others. It accepts NaN and, in a PLY, faces whose vertices
/// do not exist, and takes 3.4 GB for a header of 200 bytes that claims 3e8 vertices. Its library is 10 MB,
/// ours 500 lines.
namespace fleetmap::sim {

/// Reads a mesh in metres of the site's ENU frame, z up, by its extension: .obj, or .ply (ascii or binary
/// little endian). Polygons become fans of triangles. Materials come from the names of an OBJ's materials and
/// groups (material_named()) or from a PLY's face property `material` as write_ply() writes it; else
/// concrete. Errors name the file, the line (or the byte of a binary file) and a remedy. Memory is bounded by
/// a small multiple of the file's size, whatever its header claims.
Result<Mesh> read_mesh(const std::filesystem::path& file);

/// Vertices, triangles, and `usemtl` with the name of their material. Read back, it is the same mesh.
/// The file appears whole or not at all.
Status write_obj(const std::filesystem::path& file, const Mesh& mesh);
/// Binary little endian, float32, with the material as face property `material`.
Status write_ply(const std::filesystem::path& file, const Mesh& mesh);

std::string_view name_of(Material material);
/// By the words in a name: glass or panel; metal, steel or post; tree, leaf or vegetation; ground or terrain;
/// else concrete.
Material material_named(std::string_view name);

}  // namespace fleetmap::sim
