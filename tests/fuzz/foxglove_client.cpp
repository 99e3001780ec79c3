// Input of the monitor from a Foxglove client: its texts, and the subprotocols that it offers.
#include "checks.hpp"
#include "monitor/foxglove/subscriptions.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  using namespace fleetmap::monitor::foxglove;
  const std::string_view text = fuzz::text_of({data, size});
  const std::string_view chosen = accepted_subprotocol(text);
  fuzz::require(chosen.empty() || text.find(chosen) != text.npos, "a subprotocol that was not offered");
  const auto request = parse_client_text(text);
  if (!request) {
    fuzz::require(!request.error().message.empty(), "an error without a text");
    return 0;
  }
  std::vector<Channel> channels(3);
  for (std::uint32_t k = 0; k < 3; ++k) channels[k] = {k + 1, "/x", ChannelKind::map, {}, 1};
  Subscriptions subscriptions;
  static_cast<void>(status(StatusLevel::warning, subscriptions.apply(*request, channels)));
  std::size_t due = 0;
  while (const auto next = subscriptions.next_due(channels)) {
    fuzz::require(next->channel >= 1 && next->channel <= 3, "a message of no channel is due");
    fuzz::require(++due <= 3, "a message is due twice");
  }
  return 0;
}
