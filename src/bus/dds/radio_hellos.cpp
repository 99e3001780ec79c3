// How robots find each other on a radio: the members of RadioLink that say and take Hellos.
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/writer/StatelessWriter.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <utility>

#include "fleetmap/bus/wire_overhead.hpp"
#include "participant_qos.hpp"
#include "radio_link.hpp"
#include "radio_received.hpp"
#include "radio_topic.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using rtps::IPLocator;

constexpr auto kReadsChange = std::chrono::milliseconds(100);  // until who is known hears of other topics
/// On the wire, each of the two by which a pair gets to know each other; with keys three, in the mean.
constexpr double kHelloBits = 8.0 * 260.0, kGreetingBits = 8.0 * 345.0 * 3.0 / 2.0;
/// What Hellos of all robots together may take of the link's fleet_bits_per_second: in the mean while a fleet
/// starts, and in any second.
constexpr double kMeanPart = 0.43, kMostPart = 0.93;
constexpr double kLongestSpread = 6.0;  // s: a fleet is to know itself within ten
constexpr double kFirstPause = 0.5;     // s until a Hello is repeated, and what answers may take besides
constexpr auto kLongestPause = std::chrono::seconds(2);  // and a second for each other robot
constexpr int kQuickHellos = 7;  // with this pause: the radio loses some; then the pause doubles each time
/// A robot that comes to a fleet which knows itself says its Hellos faster, since the others say none: it has
/// had this many answers, and no Hello of another newcomer for a while.
constexpr int kAnswersOfAFleet = 4;
constexpr auto kNoNewcomer = std::chrono::seconds(10);
constexpr double kNewcomersShares = 2.0;
constexpr double kNewcomersPause = 1.0;  // s
constexpr auto kAnswerAgain = std::chrono::milliseconds(300);
/// Whoever was heard so lately is still there. A robot that was killed and starts anew waits for so long.
constexpr auto kStillThere = std::chrono::seconds(2);
constexpr auto kNeverHeard = std::chrono::seconds(30);  // then it is said
constexpr std::size_t kMostNamesakes = 16;
constexpr std::size_t kMostWarnings = 128;  // about others
constexpr std::size_t kMostPlaces = 256;    // strangers may name so many

Executor::Clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<Executor::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

/// Robots that share the medium with this one, as configured: what goes to this machine does not take it.
bool RadioLink::elsewhere(const Place& place) const {
  return place.configured && !IPLocator::compareAddress(place.locator, own_) &&
         !IPLocator::isLocal(place.locator);
}

/// Robots that say Hello as this one does: all others while a fleet starts. An observer comes to one that may
/// be using the radio, and takes a quarter of what Hellos may take.
double RadioLink::others() const {
  if (observes_) return 3.0;
  return static_cast<double>(
      std::ranges::count_if(places_, [this](const auto& place) { return elsewhere(*place); }));
}

double RadioLink::hello_bits() const { return guard_ ? kGreetingBits : kHelloBits; }

/// s that the Hellos of a fleet that starts at once, each robot's to each other's, take at this rate (bit/s).
double RadioLink::hello_time(double rate) const { return others() * (others() + 1.0) * hello_bits() / rate; }

/// Over which they are spread.
RadioLink::Clock::duration RadioLink::spread() const {
  if (observes_) return {};
  return to_duration(std::min(hello_time(kMeanPart * config_.fleet_bits_per_second), kLongestSpread));
}

/// Until a Hello that was not answered is repeated: while a fleet starts answers wait for their turn, too.
RadioLink::Clock::duration RadioLink::first_pause() const {
  // Of the time that all Hellos take at the highest rate. Of three messages the radio loses one more often.
  const double answered = guard_ ? 0.4 : 0.75;
  return to_duration(kFirstPause +
                     (observes_ ? 0.0 : answered * hello_time(kMostPart * config_.fleet_bits_per_second)));
}

bool RadioLink::fleet_is_up() const {
  const bool alone = newcomer_ == Clock::time_point{} || Clock::now() - newcomer_ > kNoNewcomer;
  return !observes_ && alone && answers_ >= kAnswersOfAFleet;
}

void RadioLink::count_answer(const Acquaintance& acquaintance) {
  const bool was_up = fleet_is_up();
  if (acquaintance.knows_us) {
    ++answers_;
  } else if (!acquaintance.knows_another) {
    newcomer_ = Clock::now();
  }
  if (was_up || !fleet_is_up()) return;
  for (const auto& place : places_) {
    if (place->robot || place->said >= kQuickHellos) continue;
    const double part = std::uniform_real_distribution(0.0, kNewcomersPause)(random_);
    place->next = std::min(place->next, Clock::now() + to_duration(part));
  }
}

Status RadioLink::add_place(const Locator& locator, bool configured) {
  if (locator == own_ || (!configured && places_.size() >= kMostPlaces)) return {};
  auto place = std::make_unique<Place>();
  place->locator = locator;
  place->configured = configured;
  place->pause = first_pause();
  place->history = std::make_unique<rtps::WriterHistory>(unbounded_history());
  auto attributes = best_effort<rtps::WriterAttributes>();
  attributes.mode = rtps::SYNCHRONOUS_WRITER;
  const std::uint32_t number = ++hello_writers_ % (0xffffff - kHelloWriters);
  place->writer = rtps::RTPSDomain::createRTPSWriter(participant_, writer_id(kHelloWriters + number),
                                                     attributes, payloads_, place->history.get());
  auto* writer = dynamic_cast<rtps::StatelessWriter*>(place->writer);
  rtps::LocatorList_t there;
  there.push_back(locator);
  if (writer == nullptr || !writer->set_fixed_locators(there))
    return failure(std::string(to_string(link_)) + ": Fast DDS makes no writer to " + to_text(locator));
  places_.push_back(std::move(place));
  return {};
}

void RadioLink::say_hello(Place& place, bool leaves) {
  Hello hello;
  const std::optional<Prefix> there = place.claimed ? place.claimed : place.robot;
  if (there) std::copy_n(there->value, hello.knows.size(), hello.knows.begin());
  hello.leaves = leaves;
  hello.sender = agent_;
  std::copy_n(IPLocator::getIPv4(own_), hello.address.size(), hello.address.begin());
  hello.port = static_cast<std::uint16_t>(own_.port);
  hello.settings = settings_;
  hello.link = link_;
  hello.multicast = config_.multicast;
  for (const EntityKey key : reads_) {
    if (hello.reads.size() < kMostReads) hello.reads.push_back(key);
  }
  const Bytes cdr = guard_ ? greeting_of(hello, place) : encode(hello);
  send(*place.writer, *place.history, cdr, 1);
  hello_bytes_ += wire_bytes(cdr.size(), {.seal = guard_ ? kSealBytes : 0});
  const auto now = Clock::now();
  // Robots that start together would else meet in step.
  const double jitter = std::uniform_real_distribution(0.5, 1.5)(random_);
  const Clock::duration pause = fleet_is_up() && place.said < kQuickHellos
                                    ? std::min(place.pause, to_duration(kNewcomersPause))
                                    : place.pause;
  place.next = now + std::chrono::duration_cast<Clock::duration>(jitter * pause);
  if (place.claimed) {
    if (--place.answers > 0) {  // the radio loses some, and what they are answered by
      place.next = now + std::chrono::duration_cast<Clock::duration>(jitter * first_pause() / 2);
      return;
    }
    place.claimed.reset();
    if (place.robot) place.next = Clock::time_point::max();
    return;
  }
  // In a small fleet a robot that comes into reach again is to be known within ten seconds.
  const Clock::duration least = to_duration(kFirstPause);
  const Clock::duration most =
      std::min<Clock::duration>(announcement_, kLongestPause + to_duration(others()));
  if (++place.said >= kQuickHellos) place.pause = std::clamp(2 * place.pause, least, std::max(most, least));
  if (!place.robot) return;
  Peer& peer = peers_.at(*place.robot);
  peer.told = peer.greeted = now;
  if (place.mistakes_us) return;
  // It has asked before: our last answer was lost, and this one may be.
  place.next = std::exchange(place.asks_again, false) ? now + kAnswerAgain : Clock::time_point::max();
}

void RadioLink::reads_changed() {
  for (const auto& place : places_) {
    if (place->robot) place->next = std::min(place->next, Clock::now() + kReadsChange);
  }
}

void RadioLink::tick() {
  std::deque<std::pair<Prefix, Bytes>> hellos;
  {
    const std::scoped_lock lock(received_->mutex);
    hellos.swap(received_->hellos);
  }
  const std::scoped_lock lock(mutex_);
  watch_address(Clock::now());
  if (participant_ == nullptr) return;
  name_strangers();
  for (const auto& [sender, cdr] : hellos) {
    if (guard_) {
      take_greeting(sender, cdr);
    } else if (const auto hello = decode_hello(cdr)) {
      const bool knows_us = std::ranges::equal(hello->knows, participant_->getGuid().guidPrefix.value);
      take(sender, *hello, {knows_us, !knows_us && std::ranges::any_of(hello->knows, std::identity{})});
    } else {
      take_other(cdr);
    }
  }
  for (const Prefix& robot : silent()) forget(robot);
  take_successors();
  const auto now = Clock::now();
  for (const auto& place : places_) {
    if (place->next == Clock::time_point{}) {
      place->pause = first_pause();
      place->said = 0;
      const double part = std::uniform_real_distribution(0.0, 1.0)(random_);
      place->next = now + std::chrono::duration_cast<Clock::duration>(part * spread());
    }
    if (place->robot) {
      const Peer& peer = peers_.at(*place->robot);
      // What it should know may have been lost.
      if (now - peer.told > announcement_ || now - peer.greeted > lease_ / 2)
        place->next = std::min(place->next, now);
    }
  }
  name_who_was_never_heard(now);
  say_due_hellos(now);
}

/// Robots that were started anew become known once nothing more comes from their start before.
void RadioLink::take_successors() {
  std::vector<Successor> due;
  for (const auto& place : places_) {
    if (!place->successor) continue;
    if (place->robot) {
      const auto heard = last_heard(*place->robot);
      if (heard && *heard > place->successor->came) {  // it is still there
        place->successor.reset();
        continue;
      }
      if (heard_lately(*place->robot)) continue;
    }
    due.push_back(*std::exchange(place->successor, std::nullopt));
  }
  for (const Successor& successor : due) take(successor.robot, successor.hello, successor.acquaintance);
}

/// On the radio all should hear each other, on the Wi-Fi nobody may be near.
void RadioLink::name_who_was_never_heard(Clock::time_point now) {
  if (link_ != Link::kLongRange || observes_ || now - opened_ < kNeverHeard) return;
  for (const auto& place : places_) {
    if (place->heard || place->told || !elsewhere(*place)) continue;
    place->told = true;
    spdlog::warn(
        "{}: nobody heard at {} in {:.0f} s: is that robot on, is this its address, and has its file "
        "the same dds.{}.domain?",
        to_string(link_), to_text(place->locator), std::chrono::duration<double>(kNeverHeard).count(),
        to_string(link_));
  }
}

/// The longest due first, no faster than this robot's share of what Hellos may take.
void RadioLink::say_due_hellos(Clock::time_point now) {
  const double shares = fleet_is_up() ? std::min(kNewcomersShares, others() + 1.0) : 1.0;
  const Clock::duration pause =
      to_duration((others() + 1.0) * hello_bits() / (shares * kMostPart * config_.fleet_bits_per_second));
  std::vector<Place*> due;
  for (const auto& place : places_) {
    if (place->next <= now) due.push_back(place.get());
  }
  std::ranges::sort(due, {}, &Place::next);
  for (Place* place : due) {
    if (now < hello_free_) return;
    hello_free_ = std::max(hello_free_, now - kTick) + pause;
    say_hello(*place);
  }
}

/// Who was not heard for the lease.
std::vector<RadioLink::Prefix> RadioLink::silent() const {
  std::vector<Prefix> robots;
  const auto now = Clock::now();
  const std::scoped_lock lock(received_->mutex);
  for (const auto& [robot, peer] : peers_) {
    const auto last = received_->robots.find(robot);
    if (last == received_->robots.end() || now - last->second.heard <= lease_) continue;
    spdlog::info("{}: nothing heard from {} at {} for {:.0f} s", to_string(link_), peer.agent.str(),
                 to_text(peer.locator), std::chrono::duration<double>(lease_).count());
    robots.push_back(robot);
  }
  return robots;
}

void RadioLink::take(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance) {
  if (sender == participant_->getGuid().guidPrefix) return;
  Locator from;
  from.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(from, hello.address.data());
  from.port = hello.port;
  if (!plausible(from)) return;
  if (hello.link != link_) {
    if (!hello.settings) return;  // a program of an operator that tries domains
    return refuse(from, hello.sender.str() + " has its " + to_string(hello.link) + " here: give dds." +
                            to_string(link_) + ".domain and dds." + to_string(hello.link) +
                            ".domain the same numbers in every file");
  }
  if (hello.leaves) {
    const auto peer = peers_.find(sender);
    if (peer == peers_.end() || peer->second.agent != hello.sender || peer->second.locator != from) return;
    spdlog::info("{}: {} leaves", to_string(link_), hello.sender.str());
    return forget(sender);
  }
  count_answer(acquaintance);
  const bool both_robots = hello.settings.has_value() == settings_.has_value();  // not an operator's program
  if (hello.sender == agent_ && both_robots && namesakes_.size() < kMostNamesakes &&
      namesakes_.insert(sender).second) {
    spdlog::error(
        "{}: another robot at {} is named {}, too: each needs a name of its own, or their nodes are "
        "taken for conflicts",
        to_string(link_), to_text(from), agent_.str());
  }
  Place* place = place_at(from);
  bool replaced = false;
  if (place != nullptr && place->robot && *place->robot != sender) {
    // It was started anew; unless it is still there, and somebody only says to be at its place.
    const bool proved = guard_ && peers_.at(*place->robot).agent == hello.sender;
    if (!proved && heard_lately(*place->robot)) {
      place->successor = Successor{sender, hello, acquaintance, Clock::now()};
      return;
    }
    forget(*place->robot);
    replaced = true;
    place = place_at(from);
  }
  if (place == nullptr) {  // nobody that the configuration names
    if (Status added = add_place(from, /*configured=*/false); !added) spdlog::warn(added.error().message);
    place = place_at(from);
    if (place == nullptr) return;
  }
  {
    const std::scoped_lock lock(received_->mutex);
    Received::Robot& robot = received_->robots[sender];
    robot.heard = Clock::now();
    ++robot.traffic.hellos;
  }
  Peer& peer = peers_[sender];
  const bool known = place->robot.has_value();
  if (!known) {
    spdlog::info("{}: heard {} at {}{}", to_string(link_), hello.sender.str(), to_text(from),
                 settings_ && !hello.settings ? " (an operator's program)" : "");
    place->robot = sender;
    place->heard = place->heard || hello.settings;
    place->next = Clock::time_point::max();
  }
  note(hello, from);
  compare(hello);
  peer.agent = hello.sender;
  peer.locator = from;
  peer.reads = {hello.reads.begin(), hello.reads.end()};
  peer.multicast = hello.multicast;
  for (const auto& [key, end] : ends_) {
    end->meet(sender, peer);
    end->hear(sender);
  }
  place->mistakes_us = acquaintance.knows_another;
  if (!acquaintance.knows_us || replaced) {
    if (known && place->next == Clock::time_point::max()) place->asks_again = true;  // no answer is under way
    place->next = Clock::time_point::min();  // before those to robots that may not be there
  } else if (peer.greeted == Clock::time_point{}) {
    peer.greeted = Clock::now();  // by what made it know us
  }
  executor_->wake();  // whoever waits for it
}

/// For survey().
void RadioLink::note(const Hello& hello, const Locator& from) {
  const std::string place = to_text(from);
  const auto known = std::ranges::find_if(heard_, [&](const RadioSurvey::Robot& robot) {
    return robot.agent == hello.sender && robot.place == place;
  });
  if (known != heard_.end()) {
    known->settings = hello.settings;
    known->multicast = hello.multicast;
  } else if (heard_.size() < kMostPlaces) {
    const bool here = IPLocator::compareAddress(from, own_) || IPLocator::isLocal(from);
    heard_.push_back({hello.sender, place, here, domain_of(from.port, profile_),
                      std::chrono::duration_cast<Duration>(Clock::now() - opened_), hello.settings,
                      hello.multicast});
  }
}

bool RadioLink::first_time(const std::string& warning) {
  return warnings_.size() < kMostWarnings && warnings_.insert(warning).second;
}

/// Once per robot and difference.
void RadioLink::compare(const Hello& hello) {
  if (!settings_ || !hello.settings) return;
  if (config_.multicast != hello.multicast) {
    const std::string key = std::string("dds.") + to_string(link_) + ".multicast";
    const std::string one_sided =
        hello.sender.str() + (config_.multicast
                                  ? " has no " + key + ", this robot has: what goes to it is not counted"
                                  : " has " + key + ", this robot has not: give all the same");
    if (first_time(one_sided)) spdlog::warn("{}: {}", to_string(link_), one_sided);
  }
  for (const std::string& difference : differences(hello.sender.str(), *hello.settings, *settings_)) {
    if (first_time(difference)) spdlog::warn("{}: {}", to_string(link_), difference);
  }
}

/// A robot with which no exchange is possible.
void RadioLink::refuse(const Locator& from, const std::string& why) {
  if (Place* place = place_at(from)) place->heard = true;
  refuse_once(to_text(from), why);
}

void RadioLink::refuse_once(const std::string& place, const std::string& why) {
  if (!first_time(place + why)) return;
  refused_.push_back(place + ": " + why);
  spdlog::warn("{}: {}", to_string(link_), refused_.back());
}

/// Once per address.
void RadioLink::take_other(const Bytes& cdr) {
  const auto hello = decode_other_hello(cdr);
  if (!hello) return;
  Locator from;
  from.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(from, hello->address.data());
  from.port = hello->port;
  if (!plausible(from)) return;
  refuse(from, hello->sender.str() + " runs another version of fleetmap (its Hello is of version " +
                   std::to_string(hello->version) + "): install the same on all robots");
}

/// A robot may say that it listens at any address; at these none does.
bool RadioLink::plausible(const Locator& locator) const {
  const std::uint8_t first = IPLocator::getIPv4(locator)[0];
  constexpr std::uint8_t kMulticast = 224;
  return first != 0 && first < kMulticast && IPLocator::isLocal(locator) == IPLocator::isLocal(own_) &&
         locator != own_;
}

RadioLink::Place* RadioLink::place_at(const Locator& locator) {
  const auto place =
      std::ranges::find_if(places_, [&](const auto& other) { return other->locator == locator; });
  return place == places_.end() ? nullptr : place->get();
}

std::optional<RadioLink::Clock::time_point> RadioLink::last_heard(const Prefix& robot) const {
  const std::scoped_lock lock(received_->mutex);
  const auto last = received_->robots.find(robot);
  return last == received_->robots.end() ? std::nullopt : std::optional(last->second.heard);
}

bool RadioLink::heard_lately(const Prefix& robot) const {
  const auto heard = last_heard(robot);
  return heard && Clock::now() - *heard < kStillThere;
}

void RadioLink::forget(Prefix robot) {
  if (peers_.erase(robot) == 0) return;
  for (const auto& [key, end] : ends_) end->forget(robot);
  std::erase_if(places_, [&](const auto& place) {
    if (place->robot != robot) return false;
    place->robot.reset();
    place->next = {};  // as at the start
    place->claimed.reset();
    place->mistakes_us = place->asks_again = false;
    if (!place->configured) rtps::RTPSDomain::removeRTPSWriter(place->writer);
    return !place->configured;
  });
  const std::scoped_lock lock(received_->mutex);
  received_->robots.erase(robot);
}

}  // namespace fleetmap::bus
