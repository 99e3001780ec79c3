#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <tl/expected.hpp>

#include "fleetmap/trust/cipher.hpp"
#include "fleetmap/trust/credentials.hpp"
#include "fleetmap/trust/replay_window.hpp"

namespace fleetmap::trust {

/// A datagram is a header, ChaCha20-Poly1305 (RFC 8439) of the message under the session's key, and the tag.
/// The header is authenticated too.
///
///   greeting  0x47, fleet 4, epoch 2, name 8, session 12, counter 5    readable by who never heard the
///   sender message   0x4d, session's last 4 bytes, counter 5                  from whose greeting was
///   admitted
///
/// The key of a session is HKDF-SHA256 (RFC 5869) of the fleet's key of that epoch with the session as salt;
/// the nonce is the counter, which a sender never uses twice.
enum class DatagramKind : std::uint8_t { kGreeting = 0x47, kMessage = 0x4d };
inline constexpr std::size_t kMessageHeaderBytes = 1 + 4 + 5;
inline constexpr std::size_t kGreetingHeaderBytes = 1 + 4 + 2 + 8 + 12 + 5;

/// Seals the datagrams of one robot on one radio since one start.
class DatagramSealer {
 public:
  DatagramSealer(const Credentials& credentials, const AgentId& name, std::uint8_t radio,
                 const Session& session);
  Bytes seal(DatagramKind kind, ByteView message);

 private:
  const FleetId fleet_;
  const std::uint16_t epoch_;
  const AgentId name_;
  const Session session_;
  Cipher cipher_;
  std::uint64_t counter_ = 0;
};

/// Why a datagram was not opened.
struct NotOpened {
  enum class Why : std::uint8_t {
    kNotSealed,   ///< no datagram of this kind
    kOtherFleet,  ///< of another authority
    kOldEpoch,    ///< sealed with a key of this fleet from before a revocation; the name is authentic
    kNewEpoch,    ///< with a key that this robot has not
    kForged,      ///< or damaged
    kReplayed,    ///< came before, or too late
    kUnknown,     ///< a message from whose greeting was not admitted
    kReadsOnly,   ///< a message of an observer
  };
  Why why = Why::kNotSealed;
  AgentId name{};           ///< that a greeting claims
  std::uint16_t epoch = 0;  ///< of a greeting
};

/// Content of a datagram whose seal is valid.
struct Opened {
  DatagramKind kind = DatagramKind::kMessage;
  Session session{};
  Bytes message;
};

/// Opens the datagrams of one radio.
///
/// A greeting is opened for every member, by the fleet's key. Messages of a session are opened once it was
/// admitted, which takes a signed greeting with this start's challenge (introduction.hpp), so no packet of an
/// earlier start of either side is ever accepted. Sessions are kept when a robot leaves, or its packets could
/// be replayed to it after its return.
class DatagramOpener {
 public:
  DatagramOpener(const Credentials& credentials, std::uint8_t radio);
  tl::expected<Opened, NotOpened> open(ByteView datagram);
  /// Opens messages of a session that were sealed after the last greeting of it that was opened. False if
  /// none was lately: the next one will do.
  bool admit(const Session& session, Role role);
  /// Messages of the session are dropped from now on.
  void dismiss(const Session& session);

 private:
  struct Sender {
    Cipher cipher;
    ReplayWindow window;
    std::optional<Role> role;
  };
  using Tail = std::array<std::uint8_t, 4>;  ///< of a session, as messages carry it
  static constexpr std::size_t kMaxSessions = 4096, kMaxClaims = 1024;

  tl::expected<Opened, NotOpened> open_greeting(ByteView datagram);
  tl::expected<Opened, NotOpened> open_message(ByteView datagram);
  bool is_new_claim(const Session& session, std::uint64_t counter);
  Cipher cipher_of(const Session& session, std::uint16_t epoch) const;

  const FleetId fleet_;
  const FleetKeys keys_;
  const std::uint8_t radio_;
  std::map<Session, Sender> senders_;
  std::map<Tail, Session> by_tail_;
  std::map<Session, std::uint64_t>
      claims_;  ///< counters of the last greetings of sessions that are not admitted
  std::deque<Session> claims_by_age_;
};

}  // namespace fleetmap::trust
