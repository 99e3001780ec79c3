// How robots with keys find each other on a radio: the members of RadioLink that seal and check Hellos. A
// robot is known once it has answered this start's challenge, so that recorded Hellos of the day before get
// no further than an answer.
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "radio_link.hpp"
#include "radio_received.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::rtps::GuidPrefix_t;
using eprosima::fastrtps::rtps::IPLocator;

constexpr int kAnswers = 2;  // to a claim that is not proved

trust::Session session_of(const GuidPrefix_t& prefix) {
  trust::Session session{};
  std::copy_n(prefix.value, session.size(), session.begin());
  return session;
}

}  // namespace

Bytes RadioLink::greeting_of(const Hello& hello, const Place& place) const {
  trust::Introducer& introducer = guard_->introducer();
  const bool answers = place.claimed || place.robot;
  const trust::Introducer::Flags flags{
      .knows_you = !place.claimed && place.robot,
      .knows_another = place.claimed && place.robot,
      .lacks_certificate = !place.certificate || !introducer.has_certificate(*place.certificate)};
  return introducer.introduce(encode(hello), flags, answers, answers && place.lacks_ours);
}

void RadioLink::take_greeting(const Prefix& sender, const Bytes& greeting) {
  const auto introduction = trust::parse_introduction(greeting);
  if (!introduction) return;
  const auto hello = decode_hello(introduction->text);
  if (!hello) return take_other(introduction->text);
  Locator from;
  from.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(from, hello->address.data());
  from.port = hello->port;
  if (!plausible(from)) return;
  const bool challenged = std::ranges::equal(hello->knows, guard_->session());
  const bool provable =
      guard_->introducer().has_certificate(introduction->fingerprint) || !introduction->certificate.empty();
  if (!challenged || !introduction->signature || !provable) {
    if (!hello->leaves && hello->link == link_) answer_claim(sender, from, *introduction);
    return;
  }
  if (prove(sender, from, *hello, *introduction))
    take(sender, *hello, {introduction->knows_you, introduction->knows_another});
  if (Place* place = place_at(from)) {
    place->certificate = introduction->fingerprint;
    place->lacks_ours = introduction->lacks_certificate;
    if (place->claimed == sender) place->claimed.reset();
  }
}

/// Somebody says to be there, perhaps in a recording: answers with its challenge, and one of our own.
void RadioLink::answer_claim(const Prefix& sender, const Locator& from,
                             const trust::Introduction& introduction) {
  Place* place = place_at(from);
  if (place == nullptr) {
    if (!add_place(from, /*configured=*/false)) return;
    place = place_at(from);
    if (place == nullptr) return;
  }
  if (place->robot != sender) {
    place->claimed = sender;
    place->answers = kAnswers;
  } else if (place->next == Clock::time_point::max()) {
    place->asks_again = true;  // our last answer was lost
  }
  place->certificate = introduction.fingerprint;
  place->lacks_ours = introduction.lacks_certificate;
  place->next = Clock::time_point::min();
}

/// Whether the sender is the member that it says to be; else it is named once, and what it sends is dropped.
bool RadioLink::prove(const Prefix& sender, const Locator& from, const Hello& hello,
                      const trust::Introduction& introduction) {
  const trust::Session session = session_of(sender);
  const auto now = std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
  const auto member = guard_->introducer().verify(introduction, session, now);
  std::string why;
  if (!member) {
    why = hello.sender.str() + " is refused: " + member.error().message;
  } else if (hello.settings && member->name != hello.sender) {
    why = hello.sender.str() + " is refused: it has the keys of " + member->name.str();
  }
  if (!why.empty()) {
    guard_->dismiss(session);
    forget(sender);
    refuse(from, why);
    return false;
  }
  if (member->role == trust::Role::kObserver)
    refuse_once(to_text(from), hello.sender.str() + " may only read (observer): what it sends is dropped");
  return guard_->admit(session, member->role);
}

void RadioLink::name_strangers() {
  if (!guard_) return;
  for (const RadioGuard::Stranger& stranger : guard_->take_strangers())
    refuse_once(stranger.address, stranger.why);
}

}  // namespace fleetmap::bus
