#include "session_draw.hpp"

#include "fleetmap/store/sessions.hpp"

namespace fleetmap::fault_injection {

Result<std::uint16_t> draw_session(store::Store& store, Draws& draws) {
  auto sessions = store::Sessions::load(store);
  if (!sessions) return tl::unexpected(sessions.error());
  return sessions->begin(store, [&draws] { return static_cast<std::uint16_t>(draws.bits()); });
}

}  // namespace fleetmap::fault_injection
