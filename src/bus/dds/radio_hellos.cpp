#include "radio_hellos.hpp"

#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <utility>

#include "fleetmap/bus/wire_overhead.hpp"
#include "hello_pacing.hpp"
#include "participant_qos.hpp"
#include "radio_greetings.hpp"
#include "radio_received.hpp"
#include "radio_topic.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using rtps::IPLocator;

constexpr auto kReadsChange = std::chrono::milliseconds(100);  // until peers are sent a new list of topics
constexpr auto kNeverHeard = std::chrono::seconds(30);         // until the log names a silent address
constexpr auto kAnswerAgain = std::chrono::milliseconds(300);
constexpr std::size_t kMaxNamesakes = 16;
constexpr int kSoughtInARow = 2;

}  // namespace

void RadioLink::Hellos::count_answer(const Hello& hello, const Acquaintance& acquaintance) {
  const auto now = Clock::now();
  const HelloPacing::Answer answer{
      .names_us = acquaintance.names_us,
      .names_another = acquaintance.names_another,
      .joined_before = hello.settings && (hello.seeks == 0 || joined_before(now - hello.joined_ago))};
  if (!radio_.pacing_.count_answer(answer, now)) return;
  for (const auto& remote : radio_.remotes_) {
    if (radio_.heard_itself(*remote) || remote->hellos_sent >= radio_.pacing_.quick_hellos(now)) continue;
    const double part = std::uniform_real_distribution(0.0, HelloPacing::kNewcomerPause)(random_);
    remote->next = std::min(remote->next, now + to_duration(part));
  }
}

void RadioLink::Hellos::send_hello(RemoteLocator& remote, bool leaves) {
  Hello hello;
  std::optional<Prefix> there = remote.claimed;
  // A robot that is not known there must answer, so an introduced one is not named.
  if (!there && radio_.heard_itself(remote)) there = remote.robot;
  if (there) std::copy_n(there->value, hello.knows.size(), hello.knows.begin());
  hello.leaves = leaves;
  hello.sender = radio_.agent_;
  std::copy_n(IPLocator::getIPv4(radio_.own_), hello.address.size(), hello.address.begin());
  hello.port = static_cast<std::uint16_t>(radio_.own_.port);
  hello.settings = radio_.settings_;
  hello.link = radio_.link_;
  hello.multicast = radio_.config_.multicast;
  for (const EntityKey key : radio_.reads_) {
    if (hello.reads.size() < kMaxReads) hello.reads.push_back(key);
  }
  hello.joined_ago = std::chrono::duration_cast<Duration>(Clock::now() - radio_.opened_);
  hello.seeks = static_cast<std::uint8_t>(std::min<std::int64_t>(sought(), 255));
  if (introduces() && !leaves) hello.introduces = introductions_to(remote);
  const Bytes cdr = radio_.guard_ ? radio_.greetings_->greeting_of(hello, remote) : encode(hello);
  send(*remote.writer, *remote.history, cdr, 1);
  const std::size_t bytes = wire_bytes(cdr.size(), hello_overhead(radio_.guard_ != nullptr));
  radio_.hello_bytes_ += bytes;
  const auto now = Clock::now();
  hello_free_ =
      std::max(hello_free_, now - kTick) + radio_.pacing_.pause_between(radio_.others(), bytes, now);
  // Robots that start together would else meet in step.
  const double jitter = std::uniform_real_distribution(0.5, 1.5)(random_);
  const Clock::duration pause = radio_.pacing_.pause_after(remote.hellos_sent, remote.pause, now);
  remote.next = now + std::chrono::duration_cast<Clock::duration>(jitter * pause);
  if (remote.claimed) {
    if (--remote.answers > 0) {  // the radio loses some, and what they are answered by
      remote.next = now + std::chrono::duration_cast<Clock::duration>(jitter * first_pause() / 2);
      return;
    }
    remote.claimed.reset();
    if (remote.robot) remote.next = Clock::time_point::max();
    return;
  }
  if (++remote.hellos_sent >= radio_.pacing_.quick_hellos(now))
    remote.pause = radio_.pacing_.longer_pause(remote.pause, radio_.others(), radio_.announcement_);
  if (!remote.robot) return;
  Peer& peer = radio_.peers_.at(*remote.robot);
  peer.last_sent = peer.last_hello = now;
  if (remote.names_predecessor || peer.introduced) return;
  // It repeated its Hello, so our last answer was lost, and this one may be.
  remote.next = std::exchange(remote.missed_answer, false) ? now + kAnswerAgain : Clock::time_point::max();
}

void RadioLink::Hellos::reads_changed() {
  for (const auto& remote : radio_.remotes_) {
    if (remote->robot) remote->next = std::min(remote->next, Clock::now() + kReadsChange);
  }
}

void RadioLink::Hellos::tick() {
  std::deque<std::pair<Prefix, Bytes>> hellos;
  {
    const std::scoped_lock lock(radio_.received_->mutex);
    hellos.swap(radio_.received_->hellos);
  }
  const std::scoped_lock lock(radio_.mutex_);
  radio_.watch_address(Clock::now());
  if (radio_.participant_ == nullptr) return;
  radio_.greetings_->report_strangers();
  for (const auto& [sender, cdr] : hellos) {
    if (radio_.guard_) {
      radio_.greetings_->on_greeting(sender, cdr);
    } else if (const auto hello = decode_hello(cdr)) {
      const bool names_us = std::ranges::equal(hello->knows, radio_.participant_->getGuid().guidPrefix.value);
      on_hello(sender, *hello, {names_us, !names_us && std::ranges::any_of(hello->knows, std::identity{})});
    } else {
      on_other_version(cdr);
    }
  }
  for (const Prefix& robot : silent()) radio_.forget(robot);
  admit_successors();
  hear_introduced();
  const auto now = Clock::now();
  for (const auto& remote : radio_.remotes_) {
    if (remote->next == Clock::time_point{}) {
      remote->pause = first_pause();
      remote->hellos_sent = 0;
      const double part = std::uniform_real_distribution(0.0, 1.0)(random_);
      remote->next =
          now + std::chrono::duration_cast<Clock::duration>(part * radio_.pacing_.spread(radio_.others()));
    }
    if (remote->robot) {
      const Peer& peer = radio_.peers_.at(*remote->robot);
      // Messages to it may have been lost.
      if (now - peer.last_sent > radio_.announcement_ || now - peer.last_hello > radio_.lease_ / 2)
        remote->next = std::min(remote->next, now);
    }
  }
  warn_of_silent_remotes(now);
  send_due_hellos(now);
}

/// Robots that were started anew become known once nothing more comes from their start before.
void RadioLink::Hellos::admit_successors() {
  std::vector<Successor> due;
  for (const auto& remote : radio_.remotes_) {
    if (!remote->successor) continue;
    if (remote->robot) {
      const auto heard = radio_.last_heard(*remote->robot);
      if (heard && *heard > remote->successor->came) {  // it is still there
        remote->successor.reset();
        continue;
      }
      if (radio_.heard_recently(*remote->robot)) continue;
    }
    due.push_back(*std::exchange(remote->successor, std::nullopt));
  }
  for (const Successor& successor : due) on_hello(successor.robot, successor.hello, successor.acquaintance);
}

/// All robots should hear each other on the radio; on the Wi-Fi none may be near.
void RadioLink::Hellos::warn_of_silent_remotes(Clock::time_point now) {
  if (radio_.link_ != Link::kLongRange || radio_.observes_ || now - radio_.opened_ < kNeverHeard) return;
  for (const auto& remote : radio_.remotes_) {
    if (remote->heard || remote->warned || !radio_.elsewhere(*remote)) continue;
    remote->warned = true;
    spdlog::warn(
        "{}: nobody heard at {} in {:.0f} s: is that robot on, is this its address, and has its file "
        "the same dds.{}.domain?",
        to_string(radio_.link_), to_text(remote->locator), std::chrono::duration<double>(kNeverHeard).count(),
        to_string(radio_.link_));
  }
}

/// By rank, the longest due first, no faster than this robot's share of what Hellos may take. Two to robots
/// that are sought and may be off, then an answer.
void RadioLink::Hellos::send_due_hellos(Clock::time_point now) {
  std::vector<RemoteLocator*> due;
  for (const auto& remote : radio_.remotes_) {
    if (remote->next <= now) due.push_back(remote.get());
  }
  std::ranges::sort(due, {},
                    [this](const RemoteLocator* remote) { return std::pair(rank(*remote), remote->next); });
  while (!due.empty() && now >= hello_free_) {
    auto next = due.begin();
    if (sought_in_a_row_ >= kSoughtInARow)
      next = std::ranges::find_if(due, [](const RemoteLocator* remote) { return remote->robot.has_value(); });
    if (next == due.end()) next = due.begin();
    sought_in_a_row_ = (*next)->robot ? 0 : sought_in_a_row_ + 1;
    RemoteLocator& remote = **next;
    due.erase(next);
    send_hello(remote);
  }
}

/// Peers that were not heard for the lease.
std::vector<RadioLink::Prefix> RadioLink::Hellos::silent() const {
  std::vector<Prefix> robots;
  const auto now = Clock::now();
  const std::scoped_lock lock(radio_.received_->mutex);
  for (const auto& [robot, peer] : radio_.peers_) {
    const auto last = radio_.received_->robots.find(robot);
    if (last == radio_.received_->robots.end() || now - last->second.heard <= radio_.lease_) continue;
    spdlog::info("{}: nothing heard from {} at {} for {:.0f} s", to_string(radio_.link_), peer.agent.str(),
                 to_text(peer.locator), std::chrono::duration<double>(radio_.lease_).count());
    robots.push_back(robot);
  }
  return robots;
}

void RadioLink::Hellos::on_hello(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance) {
  if (sender == radio_.participant_->getGuid().guidPrefix) return;
  const auto origin = radio_.origin_of(hello.address, hello.port);
  if (!origin) return;
  const Locator& from = *origin;
  if (hello.link != radio_.link_) {
    if (!hello.settings) return;  // a program of an operator that tries domains
    return refuse(from, hello.sender.str() + " has its " + to_string(hello.link) + " here: give dds." +
                            to_string(radio_.link_) + ".domain and dds." + to_string(hello.link) +
                            ".domain the same numbers in every file");
  }
  if (hello.leaves) {
    const auto peer = radio_.peers_.find(sender);
    if (peer == radio_.peers_.end() || peer->second.agent != hello.sender || peer->second.locator != from)
      return;
    spdlog::info("{}: {} leaves", to_string(radio_.link_), hello.sender.str());
    return radio_.forget(sender);
  }
  count_answer(hello, acquaintance);
  warn_of_namesake(sender, hello, from);
  bool replaced = false;
  RemoteLocator* remote = claim_remote(sender, hello, acquaintance, from, replaced);
  if (remote == nullptr) return;
  meet(sender, hello, acquaintance, *remote, replaced);
  if (introduces()) on_introductions(sender, hello);
}

void RadioLink::Hellos::warn_of_namesake(const Prefix& sender, const Hello& hello, const Locator& from) {
  const bool both_robots =
      hello.settings.has_value() == radio_.settings_.has_value();  // not an operator's program
  if (hello.sender == radio_.agent_ && both_robots && namesakes_.size() < kMaxNamesakes &&
      namesakes_.insert(sender).second)
    radio_.notices_.add_namesake(to_text(from), radio_.agent_);
}

/// Returns the entry of the address that the robot now holds. Null if another robot still holds it, which
/// then is checked again later, or if there are too many addresses.
RadioLink::RemoteLocator* RadioLink::Hellos::claim_remote(const Prefix& sender, const Hello& hello,
                                                          const Acquaintance& acquaintance,
                                                          const Locator& from, bool& replaced) {
  RemoteLocator* remote = radio_.remote_at(from);
  if (remote != nullptr && remote->robot && *remote->robot != sender) {
    // The robot was started again; unless it is still there, and the new one only claims its address.
    const bool proved = radio_.guard_ && radio_.peers_.at(*remote->robot).agent == hello.sender;
    if (!proved && radio_.heard_recently(*remote->robot)) {
      remote->successor = Successor{sender, hello, acquaintance, Clock::now()};
      return nullptr;
    }
    radio_.forget(*remote->robot);
    replaced = true;
    remote = radio_.remote_at(from);
  }
  if (remote == nullptr) {  // not in the configuration
    if (Status added = radio_.add_remote(from, /*configured=*/false); !added)
      spdlog::warn(added.error().message);
    remote = radio_.remote_at(from);
  }
  return remote;
}

/// Updates the peer and its address by its Hello, and plans the answer.
void RadioLink::Hellos::meet(const Prefix& sender, const Hello& hello, const Acquaintance& acquaintance,
                             RemoteLocator& remote, bool replaced) {
  {
    const std::scoped_lock lock(radio_.received_->mutex);
    Received::Robot& robot = radio_.received_->robots[sender];
    robot.heard = Clock::now();
    ++robot.traffic.hellos;
  }
  Peer& peer = radio_.peers_[sender];
  const bool known = radio_.heard_itself(remote);
  const bool spoke = peer.spoke;
  if (!known) {
    if (!spoke)
      spdlog::info("{}: heard {} at {}{}", to_string(radio_.link_), hello.sender.str(),
                   to_text(remote.locator),
                   radio_.settings_ && !hello.settings ? " (an operator's program)" : "");
    remote.robot = sender;
    remote.heard = remote.heard || hello.settings;
    remote.next = Clock::time_point::max();
  }
  note(hello.sender, hello.settings, hello.multicast, remote.locator);
  radio_.notices_.compare(hello);
  peer.agent = hello.sender;
  peer.locator = remote.locator;
  peer.reads = {hello.reads.begin(), hello.reads.end()};
  peer.multicast = hello.multicast;
  peer.seeks = hello.seeks;
  peer.shares_settings = introduces() && shares_settings(hello);
  peer.joined = Clock::now() - hello.joined_ago;
  peer.introduced.reset();
  radio_.introductions_.meet(bytes_of(sender));
  connect(sender, peer);
  remote.names_predecessor = acquaintance.names_another;
  if (!acquaintance.names_us || replaced) {
    if (known && remote.next == Clock::time_point::max())
      remote.missed_answer = true;  // no answer is under way
    // In turn, or it would keep this robot from seeking others.
    remote.next = std::min(remote.next, Clock::now());
  } else if (peer.last_hello == Clock::time_point{}) {
    peer.last_sent = peer.last_hello = Clock::now();  // the message to which this is the answer
  }
  radio_.executor_->wake();  // a call of matches() may wait for it
}

void RadioLink::Hellos::note(const AgentId& agent, const std::optional<FleetSettings>& settings,
                             bool multicast, const Locator& from) {
  const bool here = IPLocator::compareAddress(from, radio_.own_) || IPLocator::isLocal(from);
  radio_.notices_.note({agent, to_text(from), here, domain_of(from.port, radio_.profile_),
                        std::chrono::duration_cast<Duration>(Clock::now() - radio_.opened_), settings,
                        multicast});
}

/// A robot with which no exchange is possible.
void RadioLink::Hellos::refuse(const Locator& from, const std::string& why) {
  if (RemoteLocator* remote = radio_.remote_at(from)) remote->heard = true;
  radio_.notices_.refuse(to_text(from), why);
}

/// Reports a robot whose Hello is of another version, once per address.
void RadioLink::Hellos::on_other_version(const Bytes& cdr) {
  const auto hello = decode_other_hello(cdr);
  if (!hello) return;
  if (const auto from = radio_.origin_of(hello->address, hello->port)) {
    refuse(*from, hello->sender.str() + " runs another version of fleetmap (its Hello is of version " +
                      std::to_string(hello->version) + "): install the same on all robots");
  }
}

}  // namespace fleetmap::bus
