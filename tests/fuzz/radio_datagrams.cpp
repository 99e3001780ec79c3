// Datagrams on a radio of a fleet with keys. The first byte selects one: a datagram of anybody, an
// introduction of a greeting, a message of a member, or a member's datagram that was changed on the way.
#include <algorithm>

#include "checks.hpp"
#include "fixed_keys.hpp"
#include "fleetmap/trust/datagram.hpp"
#include "fleetmap/trust/introduction.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr std::uint8_t kRadio = 1;
constexpr trust::Session kSession1{1, 15, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
constexpr trust::Session kSession2{1, 15, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1};

struct Pair {
  trust::Credentials r1 = credentials_of("r1", key_of_r1(), 1);
  trust::Credentials r2 = credentials_of("r2", key_of_r2(), 2);
};
const Pair& pair() {
  static const Pair credentials;
  return credentials;
}

/// r1 has greeted and was admitted by r2.
struct Link {
  trust::DatagramSealer sealer{pair().r1, pair().r1.certificate.name, kRadio, kSession1};
  trust::DatagramOpener opener{pair().r2, kRadio};
  Link() {
    const Bytes greeting = sealer.seal(trust::DatagramKind::kGreeting, {});
    require(opener.open(greeting).has_value(), "a member's greeting is not opened");
    require(opener.admit(kSession1, trust::Role::kRobot), "a member that greeted is not admitted");
  }
};

void open_anything(ByteView datagram) {
  trust::DatagramOpener opener(pair().r2, kRadio);
  static_cast<void>(opener.open(datagram));
  Link link;
  if (link.opener.open(datagram)) {
    const auto again = link.opener.open(datagram);
    require(!again.has_value(), "one datagram is opened twice");
  }
}

void introduce(ByteView text) {
  const auto introduction = trust::parse_introduction(text);
  if (!introduction) return;
  trust::Introducer introducer(pair().r2, kRadio, kSession2);
  const auto verified = introducer.verify(*introduction, kSession1, kNow);
  if (!verified) require(!verified.error().message.empty(), "refused without a reason");
}

void seal_and_open(ByteView message) {
  Link link;
  const auto opened = link.opener.open(link.sealer.seal(trust::DatagramKind::kMessage, message));
  require(opened.has_value(), "a member's message is not opened");
  require(std::ranges::equal(opened->message, message), "a message changes on the way");
  introduce(trust::Introducer(pair().r1, kRadio, kSession1).introduce(message, {}, true, true));
}

/// The first two bytes say which byte of the datagram is changed, and how.
void change_on_the_way(ByteView input) {
  if (input.size() < 2 || input[1] == 0) return;
  Link link;
  Bytes datagram = link.sealer.seal(trust::DatagramKind::kMessage, input.subspan(2));
  datagram[input[0] % datagram.size()] ^= input[1];
  require(!link.opener.open(datagram).has_value(), "a changed datagram is opened");
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  switch (input.choice % 4) {
    case 0:
      open_anything(input.rest);
      break;
    case 1:
      introduce(input.rest);
      break;
    case 2:
      seal_and_open(input.rest);
      break;
    default:
      change_on_the_way(input.rest);
  }
  return 0;
}
