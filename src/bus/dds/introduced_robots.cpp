#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>

#include "radio_hellos.hpp"
#include "radio_received.hpp"
#include "radio_topic.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::rtps::IPLocator;

/// A robot that joined at most so long before this one seeks it, too, so that a Hello to it can wait.
constexpr auto kJoinsWithUs = std::chrono::seconds(10);
/// The first Hellos to an address introduce others; later ones are short, since no robot may be there.
constexpr int kIntroducing = 2;
constexpr int kSoughtFirst = 4;
constexpr double kMinWait = 2.0, kMaxWait = 5.0;  // s

}  // namespace

Introductions::Prefix RadioLink::Hellos::bytes_of(const Prefix& prefix) {
  Introductions::Prefix bytes{};
  std::copy_n(prefix.value, bytes.size(), bytes.begin());
  return bytes;
}

/// On the Wi-Fi not all robots reach each other; with keys each must prove to each who it is; and an
/// operator's program says whom it heard itself.
bool RadioLink::Hellos::introduces() const {
  return radio_.link_ == Link::kLongRange && !radio_.guard_ && radio_.settings_;
}

/// The remote of least rank gets the next Hello. Without introductions answers come first, because each pair
/// must meet by itself. With introductions the order is: sought robots, unless they were silent so often that
/// they may be off; answers; introduced robots.
int RadioLink::Hellos::rank(const RemoteLocator& remote) const {
  if (!introduces()) return remote.robot || remote.claimed ? 0 : 1;
  if (!remote.robot) return remote.hellos_sent < kSoughtFirst ? 0 : 1;
  return radio_.heard_itself(remote) ? 1 : 2;
}

/// The topics that a robot reads if it reads what this one does.
std::set<RadioLink::EntityKey> RadioLink::Hellos::reads_of(const AgentId& robot) const {
  std::set<EntityKey> keys;
  for (const auto& [key, end] : radio_.ends_) {
    if (radio_.reads_.contains(key)) keys.insert(end->key_of_robot(robot));
  }
  return keys;
}

/// The sender has this robot's settings and topics, so its name and address suffice to introduce it.
bool RadioLink::Hellos::shares_settings(const Hello& hello) const {
  return hello.settings && hello.settings == radio_.settings_ &&
         hello.multicast == radio_.config_.multicast &&
         std::set<EntityKey>(hello.reads.begin(), hello.reads.end()) == reads_of(hello.sender);
}

std::vector<Introduction> RadioLink::Hellos::introductions_to(const RemoteLocator& remote) const {
  const auto now = Clock::now();
  Introductions::Prefix recipient{};
  std::optional<Duration> joined_ago;
  if (!remote.robot && remote.hellos_sent >= kIntroducing) return {};
  if (remote.robot) {
    const Peer& there = radio_.peers_.at(*remote.robot);
    if (!there.shares_settings || there.seeks == 0) return {};
    recipient = bytes_of(*remote.robot);
    joined_ago = std::chrono::duration_cast<Duration>(now - there.joined);
  }
  std::vector<Introduction> known;
  for (const auto& [robot, peer] : radio_.peers_) {
    if (!peer.shares_settings) continue;
    const auto heard = radio_.last_heard(robot);
    if (!heard) continue;
    Introduction& one = known.emplace_back();
    one.prefix = bytes_of(robot);
    one.agent = peer.agent;
    std::copy_n(IPLocator::getIPv4(peer.locator), one.address.size(), one.address.begin());
    one.port = static_cast<std::uint16_t>(peer.locator.port);
    one.heard_ago = std::chrono::duration_cast<Duration>(now - *heard);
    one.joined_ago = std::chrono::duration_cast<Duration>(now - peer.joined);
  }
  return radio_.introductions_.select(std::move(known), recipient, joined_ago);
}

void RadioLink::Hellos::on_introductions(const Prefix& sender, const Hello& hello) {
  radio_.introductions_.note_known(bytes_of(sender), hello.introduces);
  if (!radio_.peers_.at(sender).shares_settings) return;
  bool any = false;
  for (const Introduction& introduction : hello.introduces)
    any |= radio_.introductions_.accepts(introduction) && introduce(introduction, hello.sender);
  if (any) seek_sooner();
}

/// Fewer robots are still sought, so that the radio has room for more Hellos to each.
void RadioLink::Hellos::seek_sooner() {
  const auto now = Clock::now();
  const Clock::duration pause = first_pause();
  for (const auto& remote : radio_.remotes_) {
    if (remote->robot || remote->hellos_sent >= radio_.pacing_.quick_hellos(now)) continue;
    remote->pause = std::min(remote->pause, pause);
    const double part = std::uniform_real_distribution(0.5, 1.5)(random_);
    remote->next = std::min(remote->next, now + std::chrono::duration_cast<Clock::duration>(part * pause));
  }
}

/// The robots that are still sought, of which each seeks others as this one does.
HelloPacing::Clock::duration RadioLink::Hellos::first_pause() const {
  const double others = radio_.others();
  if (!introduces()) return radio_.pacing_.first_pause(others, others);
  return radio_.pacing_.first_pause(others, static_cast<double>(sought()));
}

/// The number of robots elsewhere that are not known.
std::int64_t RadioLink::Hellos::sought() const {
  return std::ranges::count_if(
      radio_.remotes_, [this](const auto& remote) { return radio_.elsewhere(*remote) && !remote->robot; });
}

bool RadioLink::Hellos::joined_before(Clock::time_point joined) const {
  return radio_.opened_ - joined > kJoinsWithUs;
}

/// Sends to a robot of this fleet that `by` knows, and hears it. Only at an address of the configuration, and
/// where none is known. Returns whether it is new.
bool RadioLink::Hellos::introduce(const Introduction& introduction, const AgentId& by) {
  Prefix robot;
  std::ranges::copy(introduction.prefix, robot.value);
  const auto there = radio_.origin_of(introduction.address, introduction.port);
  RemoteLocator* remote = there ? radio_.remote_at(*there) : nullptr;
  const auto has_name = [&](const auto& peer) { return peer.second.agent == introduction.agent; };
  if (remote == nullptr || !remote->configured || remote->robot || introduction.agent == radio_.agent_ ||
      robot == radio_.participant_->getGuid().guidPrefix || radio_.peers_.contains(robot) ||
      std::ranges::any_of(radio_.peers_, has_name))
    return false;
  const auto now = Clock::now();
  const auto heard = now - introduction.heard_ago;
  {
    const std::scoped_lock lock(radio_.received_->mutex);
    radio_.received_->robots[robot].heard = heard;
  }
  spdlog::info("{}: knows {} at {} from {}", to_string(radio_.link_), introduction.agent.str(),
               to_text(remote->locator), by.str());
  remote->robot = robot;
  Peer& peer = radio_.peers_[robot];
  peer = {.agent = introduction.agent,
          .locator = remote->locator,
          .reads = reads_of(introduction.agent),
          .multicast = radio_.config_.multicast,
          .seeks = 0,  // `by` introduces the others to it
          .shares_settings = true,
          .joined = now - introduction.joined_ago,
          .introduced = heard,
          .last_sent = now,
          .last_hello = now};
  connect(robot, peer);
  if (!joined_before(peer.joined)) {
    const Clock::duration wait = to_duration(std::uniform_real_distribution(kMinWait, kMaxWait)(random_));
    remote->next = std::max(remote->next, now + wait);
  }
  radio_.executor_->wake();  // a call of matches() may wait for it
  return true;
}

/// Data of an introduced robot shows that it is there. It may be meant for this robot's start before, so that
/// only a Hello shows that this one is known.
void RadioLink::Hellos::hear_introduced() {
  for (const auto& remote : radio_.remotes_) {
    if (!remote->robot) continue;
    Peer& peer = radio_.peers_.at(*remote->robot);
    const auto heard = radio_.last_heard(*remote->robot);
    if (!peer.introduced || peer.spoke || !heard || *heard <= *peer.introduced) continue;
    peer.spoke = true;
    remote->heard = true;
    spdlog::info("{}: heard {} at {}", to_string(radio_.link_), peer.agent.str(), to_text(remote->locator));
    note(peer.agent, radio_.settings_, peer.multicast, remote->locator);
  }
}

void RadioLink::Hellos::connect(const Prefix& robot, const Peer& peer) {
  for (const auto& [key, end] : radio_.ends_) {
    end->meet(robot, peer);
    end->hear(robot);
  }
}

}  // namespace fleetmap::bus
