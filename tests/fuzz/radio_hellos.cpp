// Hellos, by which robots find each other: alone, and inside an RTPS message before Fast DDS parses it.
#include "bus/dds/hello.hpp"
#include "bus/dds/rtps_header.hpp"
#include "checks.hpp"

namespace fleetmap::fuzz {
namespace {

void decode(const Bytes& cdr) {
  const auto other = bus::decode_other_hello(cdr);
  const auto hello = bus::decode_hello(cdr);
  require(!hello || !other, "a Hello is of this version and of another one");
  if (!hello) return;
  require(bus::decode_hello(bus::encode(*hello)).has_value(), "a Hello that was accepted cannot be sent");
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const ByteView bytes(data, size);
  fuzz::decode(Bytes(bytes.begin(), bytes.end()));
  if (const auto cdr = bus::hello_in(bytes)) fuzz::decode(*cdr);
  return 0;
}
