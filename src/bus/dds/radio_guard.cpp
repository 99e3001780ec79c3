#include "radio_guard.hpp"

#include <fastdds/rtps/common/Types.h>

#include <algorithm>
#include <fastdds/rtps/common/VendorId_t.hpp>

#include "hello.hpp"
#include "rtps_header.hpp"

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;

/// The header of an RTPS message of this session; that of the sender was equal but for a later minor version.
std::array<std::uint8_t, kRtpsHeaderBytes> rtps_header(const trust::Session& session) {
  std::array<std::uint8_t, kRtpsHeaderBytes> header{'R',
                                                    'T',
                                                    'P',
                                                    'S',
                                                    rtps::c_ProtocolVersion.m_major,
                                                    rtps::c_ProtocolVersion.m_minor,
                                                    rtps::c_VendorId_eProsima[0],
                                                    rtps::c_VendorId_eProsima[1]};
  std::ranges::copy(session, header.end() - static_cast<std::ptrdiff_t>(session.size()));
  return header;
}

}  // namespace

RadioGuard::RadioGuard(const trust::Credentials& credentials, const AgentId& name, Link link)
    : session_(trust::draw_session({rtps::c_VendorId_eProsima[0], rtps::c_VendorId_eProsima[1]})),
      epoch_(credentials.epoch()),
      introducer_(credentials, static_cast<std::uint8_t>(link), session_),
      at_start_(introducer_),
      sealer_(credentials, name, static_cast<std::uint8_t>(link), session_),
      opener_(credentials, static_cast<std::uint8_t>(link)) {}

Bytes RadioGuard::seal(ByteView rtps_message) {
  const bool greets = hello_in(rtps_message).has_value();
  const auto kind = greets ? trust::DatagramKind::kGreeting : trust::DatagramKind::kMessage;
  const ByteView message = rtps_message.subspan(std::min(kRtpsHeaderBytes, rtps_message.size()));
  const std::scoped_lock lock(sealing_);
  Bytes datagram = sealer_.seal(kind, message);
  // One in 256 would be overwritten on its way out; the next counter gives other bytes.
  while (ends_like_statistics(datagram)) datagram = sealer_.seal(kind, message);
  return datagram;
}

std::optional<Bytes> RadioGuard::open(ByteView datagram, const std::string& from_address) {
  const std::scoped_lock lock(opening_);
  const auto opened = opener_.open(datagram);
  if (!opened) {
    note_stranger(datagram, opened.error(), from_address);
    return std::nullopt;
  }
  const auto header = rtps_header(opened->session);
  Bytes message(header.size() + opened->message.size());
  std::ranges::copy(opened->message, std::ranges::copy(header, message.begin()).out);
  // A sender that is not admitted may greet and do nothing else.
  if (opened->kind == trust::DatagramKind::kGreeting && !hello_in(message)) return std::nullopt;
  return message;
}

bool RadioGuard::admit(const trust::Session& session, trust::Role role) {
  const std::scoped_lock lock(opening_);
  return opener_.admit(session, role);
}

void RadioGuard::dismiss(const trust::Session& session) {
  const std::scoped_lock lock(opening_);
  opener_.dismiss(session);
}

std::string RadioGuard::reason(ByteView datagram, const trust::NotOpened& not_opened) const {
  using Why = trust::NotOpened::Why;
  const std::string name = not_opened.name.str();
  const std::string epochs =
      " (its number " + std::to_string(not_opened.epoch) + ", ours " + std::to_string(epoch_) + ")";
  switch (not_opened.why) {
    case Why::kNotSealed: {
      const auto cdr = hello_in(datagram);
      const auto hello = cdr ? decode_hello(*cdr) : std::nullopt;
      if (!hello) return {};
      return hello->sender.str() + " has no keys: give it its folder, and keys: DIR in its file";
    }
    case Why::kOtherFleet:
      return name + " has the keys of another fleet";
    case Why::kOldEpoch:
      if (at_start_.was_revoked(not_opened.name)) return name + " was revoked";
      return name + " has an old key of the fleet" + epochs + ": copy its folder anew";
    case Why::kNewEpoch:
      return name + " has a newer key of the fleet" + epochs + ": copy this robot's folder anew";
    case Why::kForged:
      return name.empty() ? std::string() : "what comes under the name " + name + " is forged or damaged";
    case Why::kReplayed:
    case Why::kUnknown:
    case Why::kReadsOnly:
      break;
  }
  return {};
}

void RadioGuard::note_stranger(ByteView datagram, const trust::NotOpened& not_opened,
                               const std::string& address) {
  if (strangers_.size() >= kMaxStrangers) return;
  std::string why = reason(datagram, not_opened);
  const auto same = [&](const Stranger& other) { return other.address == address && other.why == why; };
  if (!why.empty() && std::ranges::none_of(strangers_, same)) strangers_.push_back({address, std::move(why)});
}

std::vector<RadioGuard::Stranger> RadioGuard::take_strangers() {
  const std::scoped_lock lock(opening_);
  return std::exchange(strangers_, {});
}

}  // namespace fleetmap::bus
