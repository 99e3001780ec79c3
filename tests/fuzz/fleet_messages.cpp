// Every message between robots, as CDR. The first byte is the index in messages::Message.
#include <array>
#include <utility>

#include "checks.hpp"
#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fuzz {
namespace {

/// A decoded message could have been sent: its encoding decodes to itself.
template <class T>
void decode(ByteView cdr) {
  const MemoryPeak memory;
  const auto message = fleet_codec::decode<T>(cdr);
  require(memory.bytes() <= 65'536 + 32 * cdr.size(), "decoding allocates far more than its bytes");
  if (!message) return require(!message.error().message.empty(), "refused without a reason");
  const Bytes again = fleet_codec::encode(*message);
  const auto twice = fleet_codec::decode<T>(again);
  require(twice.has_value(), "what was accepted is refused when it is sent on");
  require(fleet_codec::encode(*twice) == again, "sending a message on changes it");
}

using Decoder = void (*)(ByteView);

template <std::size_t... Index>
constexpr auto decoders_of_messages(std::index_sequence<Index...>) {
  return std::array<Decoder, sizeof...(Index) + 2>{
      &decode<std::variant_alternative_t<Index, messages::Message>>..., &decode<GlobalPose>,
      &decode<messages::SpherizedCloud>};
}
constexpr auto kDecoders =
    decoders_of_messages(std::make_index_sequence<std::variant_size_v<messages::Message>>());

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  kDecoders.at(input.choice % kDecoders.size())(input.rest);
  return 0;
}
