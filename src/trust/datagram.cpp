#include "fleetmap/trust/datagram.hpp"

#include <algorithm>
#include <stdexcept>

#include "openssl.hpp"

namespace fleetmap::trust {
namespace {

constexpr std::size_t kFleetBytes = 4, kCounterBytes = 5, kTailBytes = 4;
constexpr std::size_t kEpochAt = 1 + kFleetBytes, kNameAt = kEpochAt + 2,
                      kSessionAt = kNameAt + AgentId::kMaxLength;

std::uint64_t read_number(ByteView bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes) number = number << 8 | byte;
  return number;
}

void append_number(Bytes& bytes, std::uint64_t number, std::size_t size) {
  while (size-- > 0) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * size)));
}

std::optional<AgentId> read_name(ByteView bytes) {
  const auto end = std::ranges::find(bytes, std::uint8_t{0});
  const auto name = AgentId::parse(std::string(bytes.begin(), end));
  return name ? std::optional(*name) : std::nullopt;
}

tl::unexpected<NotOpened> not_opened(NotOpened::Why why, AgentId name = {}, std::uint16_t epoch = 0) {
  return tl::unexpected(NotOpened{why, std::move(name), epoch});
}

std::array<std::uint8_t, kTailBytes> tail_of(const Session& session) {
  std::array<std::uint8_t, kTailBytes> tail{};
  std::copy_n(session.end() - kTailBytes, kTailBytes, tail.begin());
  return tail;
}

}  // namespace

DatagramSealer::DatagramSealer(const Credentials& credentials, const AgentId& name, std::uint8_t radio,
                               const Session& session)
    : fleet_(credentials.authority.fleet),
      epoch_(credentials.epoch()),
      name_(name),
      session_(session),
      cipher_(session_key(credentials.fleet_keys.at(epoch_), fleet_, epoch_, radio, session)) {}

Bytes DatagramSealer::seal(DatagramKind kind, ByteView message) {
  if (++counter_ >> (8 * kCounterBytes) != 0) throw std::runtime_error("a session's counter is used up");
  Bytes datagram{static_cast<std::uint8_t>(kind)};
  datagram.reserve(kGreetingHeaderBytes + message.size() + kTagBytes);
  if (kind == DatagramKind::kGreeting) {
    datagram.insert(datagram.end(), fleet_.begin(), fleet_.begin() + kFleetBytes);
    append_number(datagram, epoch_, 2);
    datagram.insert(datagram.end(), name_.str().begin(), name_.str().end());
    datagram.resize(kSessionAt);
    datagram.insert(datagram.end(), session_.begin(), session_.end());
  } else {
    datagram.insert(datagram.end(), session_.end() - kTailBytes, session_.end());
  }
  append_number(datagram, counter_, kCounterBytes);
  cipher_.seal(counter_, datagram, message);
  return datagram;
}

DatagramOpener::DatagramOpener(const Credentials& credentials, std::uint8_t radio)
    : fleet_(credentials.authority.fleet), keys_(credentials.fleet_keys), radio_(radio) {}

Cipher DatagramOpener::cipher_of(const Session& session, std::uint16_t epoch) const {
  return Cipher(session_key(keys_.at(epoch), fleet_, epoch, radio_, session));
}

tl::expected<Opened, NotOpened> DatagramOpener::open(ByteView datagram) {
  if (datagram.empty()) return not_opened(NotOpened::Why::kNotSealed);
  if (datagram[0] == static_cast<std::uint8_t>(DatagramKind::kGreeting)) return open_greeting(datagram);
  if (datagram[0] == static_cast<std::uint8_t>(DatagramKind::kMessage)) return open_message(datagram);
  return not_opened(NotOpened::Why::kNotSealed);
}

tl::expected<Opened, NotOpened> DatagramOpener::open_greeting(ByteView datagram) {
  using Why = NotOpened::Why;
  if (datagram.size() < kGreetingHeaderBytes + kTagBytes) return not_opened(Why::kNotSealed);
  const auto name = read_name(datagram.subspan(kNameAt, AgentId::kMaxLength));
  if (!name) return not_opened(Why::kNotSealed);
  const auto epoch = static_cast<std::uint16_t>(read_number(datagram.subspan(kEpochAt, 2)));
  if (!std::equal(fleet_.begin(), fleet_.begin() + kFleetBytes, datagram.begin() + 1))
    return not_opened(Why::kOtherFleet, *name, epoch);
  if (!keys_.contains(epoch)) return not_opened(Why::kNewEpoch, *name, epoch);
  Session session{};
  std::copy_n(datagram.begin() + kSessionAt, session.size(), session.begin());
  const ByteView header = datagram.first(kGreetingHeaderBytes);
  const std::uint64_t counter = read_number(header.last(kCounterBytes));
  const ByteView sealed = datagram.subspan(kGreetingHeaderBytes);
  const auto known = senders_.find(session);
  const bool current = epoch == keys_.rbegin()->first;
  auto message = known != senders_.end() && current ? known->second.cipher.open(counter, header, sealed)
                                                    : cipher_of(session, epoch).open(counter, header, sealed);
  if (!message) return not_opened(Why::kForged, *name, epoch);
  if (!current) return not_opened(Why::kOldEpoch, *name, epoch);
  const bool fresh =
      known != senders_.end() ? known->second.window.accept(counter) : is_new_claim(session, counter);
  if (!fresh) return not_opened(Why::kReplayed, *name, epoch);
  return Opened{DatagramKind::kGreeting, session, *std::move(message)};
}

bool DatagramOpener::is_new_claim(const Session& session, std::uint64_t counter) {
  const auto [claim, first] = claims_.try_emplace(session, 0);
  if (first) {
    claims_by_age_.push_back(session);
    if (claims_by_age_.size() > kMaxClaims) {
      claims_.erase(claims_by_age_.front());
      claims_by_age_.pop_front();
    }
  }
  if (counter <= claim->second) return false;
  claim->second = counter;
  return true;
}

tl::expected<Opened, NotOpened> DatagramOpener::open_message(ByteView datagram) {
  using Why = NotOpened::Why;
  if (datagram.size() < kMessageHeaderBytes + kTagBytes) return not_opened(Why::kNotSealed);
  Tail tail{};
  std::copy_n(datagram.begin() + 1, tail.size(), tail.begin());
  const auto session = by_tail_.find(tail);
  if (session == by_tail_.end()) return not_opened(Why::kUnknown);
  Sender& sender = senders_.at(session->second);
  if (!sender.role) return not_opened(Why::kUnknown);
  const ByteView header = datagram.first(kMessageHeaderBytes);
  const std::uint64_t counter = read_number(header.last(kCounterBytes));
  auto message = sender.cipher.open(counter, header, datagram.subspan(kMessageHeaderBytes));
  if (!message) return not_opened(Why::kForged);
  if (!sender.window.accept(counter)) return not_opened(Why::kReplayed);
  if (sender.role == Role::kObserver) return not_opened(Why::kReadsOnly);
  return Opened{DatagramKind::kMessage, session->second, *std::move(message)};
}

bool DatagramOpener::admit(const Session& session, Role role) {
  if (const auto known = senders_.find(session); known != senders_.end()) {
    known->second.role = role;
    return true;
  }
  const auto claim = claims_.find(session);
  // Another that ends alike keeps its place; so many starts of members are beyond any day's work.
  if (claim == claims_.end() || senders_.size() >= kMaxSessions || by_tail_.contains(tail_of(session)))
    return false;
  senders_.emplace(session,
                   Sender{cipher_of(session, keys_.rbegin()->first), ReplayWindow(claim->second), role});
  by_tail_.emplace(tail_of(session), session);
  return true;
}

void DatagramOpener::dismiss(const Session& session) {
  if (const auto known = senders_.find(session); known != senders_.end()) known->second.role.reset();
}

}  // namespace fleetmap::trust
