// The database of a robot's store.
#include <filesystem>

#include "checks.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::fuzz {
namespace {

void read_all(Result<store::Store> store) {
  if (!store) return require(!store.error().message.empty(), "refused without a reason");
  for (const auto& [id, node] : store->nodes()) {
    static_cast<void>(store->missing_chunks(id));
    if (store->has_submap(id)) static_cast<void>(store->submap(id));
  }
  static_cast<void>(store->meta("site_origin"));
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const fuzz::Folder folder;
  const auto path = folder.write("store.db", ByteView(data, size));
  fuzz::read_all(store::Store::open_read_only(path));
  fuzz::read_all(
      store::Store::open(path, AgentId::parse("r1").value(), {.power_safe = false, .file_system = {}}));
  return 0;
}
