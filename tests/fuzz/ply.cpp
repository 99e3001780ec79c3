// A PLY file, as a cloud and as a mesh.
#include "checks.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/sim/mesh_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  const auto file = folder.write("site.ply", ByteView(data, size));
  const fuzz::MemoryPeak memory;
  const auto cloud = cloud::read_cloud(file);
  const auto mesh = sim::read_mesh(file);
  fuzz::require(memory.bytes() <= 1'000'000 + 200 * size, "a PLY file takes far more memory than its size");
  if (!cloud) fuzz::require(!cloud.error().message.empty(), "refused without a reason");
  if (!mesh) return 0;
  for (const auto& triangle : mesh->triangles)
    for (const std::uint32_t corner : triangle)
      fuzz::require(corner < mesh->vertices.size(), "a triangle names no vertex");
  return 0;
}
