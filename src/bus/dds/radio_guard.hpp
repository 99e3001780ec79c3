#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/trust/datagram.hpp"
#include "fleetmap/trust/introduction.hpp"

namespace fleetmap::bus {

/// The keys of one robot on one radio: seals what leaves, opens what comes, and holds the robot's RTPS
/// prefix, which is its session. RTPS headers are left out of sealed datagrams, since they hold nothing but
/// that.
class RadioGuard {
 public:
  RadioGuard(const trust::Credentials& credentials, const AgentId& name, Link link);

  const trust::Session& session() const { return session_; }
  /// Checks Hellos of the robots that introduce themselves; on the callback thread.
  trust::Introducer& introducer() { return introducer_; }

  /// From any thread: an RTPS message as a datagram, and back.
  Bytes seal(ByteView rtps_message);
  std::optional<Bytes> open(ByteView datagram, const std::string& from_address);
  bool admit(const trust::Session& session, trust::Role role);
  void dismiss(const trust::Session& session);

  /// Senders whose datagrams cannot be opened because of their keys, each once.
  struct Stranger {
    std::string address;
    std::string why;
  };
  std::vector<Stranger> take_strangers();

 private:
  static constexpr std::size_t kMaxStrangers = 64;  ///< that wait for the callback thread
  void note_stranger(ByteView datagram, const trust::NotOpened& not_opened, const std::string& address);
  std::string reason(ByteView datagram, const trust::NotOpened& not_opened) const;

  const trust::Session session_;
  const std::uint16_t epoch_;
  trust::Introducer introducer_;
  const trust::Introducer
      at_start_;        ///< for threads of Fast DDS: recognises members that the folder lists as revoked
  std::mutex sealing_;  ///< guards sealer_
  trust::DatagramSealer sealer_;
  std::mutex opening_;  ///< guards all below
  trust::DatagramOpener opener_;
  std::vector<Stranger> strangers_;
};

}  // namespace fleetmap::bus
