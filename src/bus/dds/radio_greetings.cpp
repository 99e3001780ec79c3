#include "radio_greetings.hpp"

#include <fastdds/rtps/participant/RTPSParticipant.h>

#include <algorithm>

#include "fleetmap/core/utc.hpp"
#include "radio_hellos.hpp"
#include "radio_received.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::rtps::GuidPrefix_t;

constexpr int kAnswers = 2;  // to a claim that is not proved

trust::Session session_of(const GuidPrefix_t& prefix) {
  trust::Session session{};
  std::copy_n(prefix.value, session.size(), session.begin());
  return session;
}

}  // namespace

Bytes RadioLink::Greetings::greeting_of(const Hello& hello, const RemoteLocator& remote) const {
  trust::Introducer& introducer = radio_.guard_->introducer();
  const bool answers = remote.claimed || remote.robot;
  const trust::Introducer::Flags flags{
      .names_you = !remote.claimed && remote.robot,
      .names_another = remote.claimed && remote.robot,
      .lacks_certificate = !remote.certificate || !introducer.has_certificate(*remote.certificate)};
  return introducer.introduce(encode(hello), flags, answers, answers && remote.lacks_our_certificate);
}

void RadioLink::Greetings::on_greeting(const Prefix& sender, const Bytes& greeting) {
  const auto introduction = trust::parse_introduction(greeting);
  if (!introduction) return;
  const auto hello = decode_hello(introduction->text);
  if (!hello) return radio_.hellos_->on_other_version(introduction->text);
  const auto origin = radio_.origin_of(hello->address, hello->port);
  if (!origin) return;
  const Locator& from = *origin;
  const bool challenged = std::ranges::equal(hello->knows, radio_.guard_->session());
  const bool provable = radio_.guard_->introducer().has_certificate(introduction->fingerprint) ||
                        !introduction->certificate.empty();
  if (!challenged || !introduction->signature || !provable) {
    if (!hello->leaves && hello->link == radio_.link_) answer_claim(sender, from, *introduction);
    return;
  }
  if (prove(sender, from, *hello, *introduction))
    radio_.hellos_->on_hello(sender, *hello, {introduction->names_you, introduction->names_another});
  if (RemoteLocator* remote = radio_.remote_at(from)) {
    remote->certificate = introduction->fingerprint;
    remote->lacks_our_certificate = introduction->lacks_certificate;
    if (remote->claimed == sender) remote->claimed.reset();
  }
}

/// Answers an unproved claim to an address, perhaps from a recording, with its challenge and one of our own.
void RadioLink::Greetings::answer_claim(const Prefix& sender, const Locator& from,
                                        const trust::Introduction& introduction) {
  RemoteLocator* remote = radio_.remote_at(from);
  if (remote == nullptr) {
    if (!radio_.add_remote(from, /*configured=*/false)) return;
    remote = radio_.remote_at(from);
    if (remote == nullptr) return;
  }
  if (remote->robot != sender) {
    remote->claimed = sender;
    remote->answers = kAnswers;
  } else if (remote->next == Clock::time_point::max()) {
    remote->missed_answer = true;  // our last answer was lost
  }
  remote->certificate = introduction.fingerprint;
  remote->lacks_our_certificate = introduction.lacks_certificate;
  remote->next = std::min(remote->next, Clock::now());
}

/// Returns whether the sender is the member that it claims to be; else it is reported once, and its messages
/// are dropped.
bool RadioLink::Greetings::prove(const Prefix& sender, const Locator& from, const Hello& hello,
                                 const trust::Introduction& introduction) {
  const trust::Session session = session_of(sender);
  const auto now = system_now();
  const auto member = radio_.guard_->introducer().verify(introduction, session, now);
  std::string why;
  if (!member) {
    why = hello.sender.str() + " is refused: " + member.error().message;
  } else if (hello.settings && member->name != hello.sender) {
    why = hello.sender.str() + " is refused: it has the keys of " + member->name.str();
  }
  if (!why.empty()) {
    radio_.guard_->dismiss(session);
    radio_.forget(sender);
    radio_.hellos_->refuse(from, why);
    return false;
  }
  if (member->role == trust::Role::kObserver)
    radio_.notices_.refuse(to_text(from),
                           hello.sender.str() + " may only read (observer): what it sends is dropped");
  return radio_.guard_->admit(session, member->role);
}

void RadioLink::Greetings::report_strangers() {
  if (!radio_.guard_) return;
  for (const RadioGuard::Stranger& stranger : radio_.guard_->take_strangers())
    radio_.notices_.refuse(stranger.address, stranger.why);
}

}  // namespace fleetmap::bus
