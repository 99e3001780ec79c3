#include "fleetmap/sim/mesh_file.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <system_error>

#include "fleetmap/core/lower_case.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "mesh_text.hpp"
#include "obj_format.hpp"
#include "ply_format.hpp"

namespace fleetmap::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, kMaterials> kNames = {"ground", "glass", "metal", "concrete",
                                                             "vegetation"};
constexpr std::size_t kFlushBytes = 1 << 20;

Result<std::string> content_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return failure(": no such file; give a .obj or .ply mesh");
  const auto size = fs::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in) return failure(": cannot be read; check its permissions");
  std::string content(static_cast<std::size_t>(size), '\0');
  if (!in.read(content.data(), static_cast<std::streamsize>(size)))
    return failure(": cannot be read to its end; copy it again");
  return content;
}

Result<Mesh> parse(const fs::path& file) {
  const std::string extension = lower_case(file.extension().string());
  if (extension != ".obj" && extension != ".ply")
    return failure(": '" + extension + "' is no mesh format known here; give a .obj or .ply mesh");
  const Result<std::string> content = content_of(file);
  if (!content) return tl::unexpected(content.error());
  Result<Mesh> mesh = extension == ".obj" ? parse_obj(*content) : parse_ply(*content);
  if (mesh && mesh->empty())
    return failure(": holds no faces; give a mesh of surfaces, not a cloud of points");
  return mesh;
}

void add(std::string& text, float value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), end);
}

void add_bytes(std::string& text, const void* data, std::size_t size) {
  text.append(static_cast<const char*>(data), size);
}

using Fill = std::function<void(std::size_t, std::string&)>;

/// Appends `count` pieces, each made by `fill`, a block at a time.
Status append_pieces(WholeFile& out, std::size_t count, const Fill& fill) {
  std::string block;
  for (std::size_t k = 0; k < count; ++k) {
    fill(k, block);
    if (block.size() < kFlushBytes && k + 1 < count) continue;
    if (const Status written = out.append(block); !written) return written;
    block.clear();
  }
  return {};
}

Status write_mesh(const fs::path& file, const std::string& header, std::size_t vertices, const Fill& vertex,
                  std::size_t triangles, const Fill& triangle) {
  Result<WholeFile> out = WholeFile::create(file);
  if (!out) return tl::unexpected(out.error());
  if (const Status written = out->append(header); !written) return written;
  if (const Status written = append_pieces(*out, vertices, vertex); !written) return written;
  if (const Status written = append_pieces(*out, triangles, triangle); !written) return written;
  return out->finish();
}

}  // namespace

std::string_view name_of(Material material) { return kNames[static_cast<std::size_t>(material)]; }

Material material_named(std::string_view name) {
  const std::string lower = lower_case(name);
  const auto has = [&lower](std::string_view word) { return lower.find(word) != std::string::npos; };
  if (has("glass") || has("panel")) return Material::kGlass;
  if (has("metal") || has("steel") || has("post")) return Material::kMetal;
  if (has("tree") || has("leaf") || has("vegetation")) return Material::kVegetation;
  if (has("ground") || has("terrain")) return Material::kGround;
  return Material::kConcrete;
}

Result<Mesh> read_mesh(const fs::path& file) {
  Result<Mesh> mesh = parse(file);
  if (!mesh) return failure(file.string() + mesh.error().message);
  return mesh;
}

Status write_obj(const fs::path& file, const Mesh& mesh) {
  const auto vertex = [&mesh](std::size_t k, std::string& text) {
    text += 'v';
    for (const float value : mesh.vertices[k]) add(text += ' ', value);
    text += '\n';
  };
  const auto triangle = [&mesh](std::size_t k, std::string& text) {
    if (k == 0 || mesh.materials[k] != mesh.materials[k - 1]) {
      text += "usemtl ";
      text += name_of(mesh.materials[k]);
      text += '\n';
    }
    text += 'f';
    for (const std::uint32_t index : mesh.triangles[k])
      (text += ' ') += std::to_string(static_cast<std::uint64_t>(index) + 1);
    text += '\n';
  };
  return write_mesh(file, "# metres: east, north, up\n", mesh.vertices.size(), vertex, mesh.triangles.size(),
                    triangle);
}

Status write_ply(const fs::path& file, const Mesh& mesh) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment metres: east, north, up\n"
      "comment materials: 0 ground, 1 glass, 2 metal, 3 concrete, 4 vegetation\n"
      "element vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "element face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar uint vertex_indices\nproperty uchar material\nend_header\n";
  const auto vertex = [&mesh](std::size_t k, std::string& bytes) {
    add_bytes(bytes, mesh.vertices[k].data(), 3 * sizeof(float));
  };
  const auto triangle = [&mesh](std::size_t k, std::string& bytes) {
    bytes += '\3';
    add_bytes(bytes, mesh.triangles[k].data(), 3 * sizeof(std::uint32_t));
    bytes += static_cast<char>(mesh.materials[k]);
  };
  return write_mesh(file, header, mesh.vertices.size(), vertex, mesh.triangles.size(), triangle);
}

}  // namespace fleetmap::sim
