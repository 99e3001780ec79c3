// The database of a robot's registrations.
#include "fleetmap/store/registration_log.hpp"

#include "checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const fuzz::Folder folder;
  const auto path = folder.write("registrations.db", ByteView(data, size));
  if (const auto log = store::RegistrationLog::open_read_only(path)) {
    const auto all = log->read();
    fuzz::require(all || !all.error().message.empty(), "refused without a reason");
  }
  auto log = store::RegistrationLog::open(path, {.max_bytes = 1'000'000});
  if (!log) {
    fuzz::require(!log.error().message.empty(), "refused without a reason");
    return 0;
  }
  const AgentId r1 = AgentId::parse("r1").value();
  static_cast<void>(log->add({{r1, 1}, {r1, 2}, "correlation", Bytes(30, 1), Bytes(40, 2), {}}));
  return 0;
}
