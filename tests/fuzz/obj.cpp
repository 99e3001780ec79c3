// A mesh in OBJ.
#include "checks.hpp"
#include "fleetmap/sim/mesh_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  const auto mesh = sim::read_mesh(folder.write("site.obj", ByteView(data, size)));
  if (!mesh) {
    fuzz::require(!mesh.error().message.empty(), "refused without a reason");
    return 0;
  }
  const auto copy = folder.path() / "copy.obj";
  fuzz::require(sim::write_obj(copy, *mesh).has_value(), "the mesh cannot be written");
  const auto again = sim::read_mesh(copy);
  fuzz::require(again && again->vertices == mesh->vertices && again->triangles == mesh->triangles &&
                    again->materials == mesh->materials,
                "the mesh changes when it is written and read");
  return 0;
}
