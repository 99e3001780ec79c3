#include "radio_link.hpp"

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/writer/StatelessWriter.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "participant_qos.hpp"
#include "radio_greetings.hpp"
#include "radio_hellos.hpp"
#include "radio_received.hpp"
#include "radio_topic.hpp"
#include "radio_transport.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using rtps::IPLocator;

/// A peer that was heard more recently than this is still there. A robot that was killed and starts again
/// waits for so long.
constexpr auto kStillThere = std::chrono::seconds(2);
constexpr std::size_t kMaxRemotes = 256;  // strangers may announce this many addresses
constexpr auto kAddressPeriod = std::chrono::seconds(1);
constexpr auto kJoinPause = std::chrono::seconds(30);      // after it failed
constexpr std::int16_t kHelloReader = 1, kDataReader = 2;  // entity ids

}  // namespace

RadioLink::RadioLink(Link link, const DdsBusConfig& config, QosFile qos, std::shared_ptr<Executor> executor)
    : LinkEnd(link, config_of(config, link), std::move(executor)),
      agent_(config.agent),
      settings_(config.settings),
      observes_(config.observes),
      qos_(std::move(qos)),
      guard_(config.keys ? std::make_shared<RadioGuard>(*config.keys, config.agent, link) : nullptr),
      pacing_({config_.fleet_bits_per_second, guard_ != nullptr, observes_}),
      notices_(link, config_.multicast, settings_),
      received_(std::make_shared<Received>()),
      hellos_(std::make_unique<Hellos>(*this)),
      greetings_(std::make_unique<Greetings>(*this)),
      hello_listener_(std::make_unique<HelloListener>(received_)),
      data_listener_(std::make_unique<DataListener>(received_, executor_, guard_ ? kSealBytes : 0)) {}

Result<std::shared_ptr<LinkEnd>> RadioLink::create(Link link, const DdsBusConfig& config, QosFile qos,
                                                   std::shared_ptr<Executor> executor) {
  std::shared_ptr<RadioLink> result(new RadioLink(link, config, std::move(qos), std::move(executor)));
  if (const Status prepared = result->prepare(); !prepared) return tl::unexpected(prepared.error());
  if (const Status there = check_address(result->config_, to_string(link)); !there) {
    // A radio that is switched on later must not keep the robot from mapping.
    result->warning_ = there.error().message + "; the link is silent until it is there";
    result->address_there_ = false;
  } else if (const Status joined = result->join(); !joined) {
    return tl::unexpected(joined.error());
  }
  result->stop_timer_ = result->executor_->add_timer(
      kTick, {std::string("greetings on ") + to_string(link), [weak = std::weak_ptr<RadioLink>(result)] {
                if (const auto alive = weak.lock()) alive->hellos_->tick();
              }});
  return std::shared_ptr<LinkEnd>(std::move(result));
}

Status RadioLink::prepare() {
  if (Status best_effort = check_best_effort(); !best_effort) return best_effort;
  auto profile = participant_profile(qos_, link_);
  if (!profile) return tl::unexpected(profile.error());
  profile_ = *std::move(profile);
  const auto& discovery = profile_.wire_protocol().builtin.discovery_config;
  lease_ = std::chrono::nanoseconds(discovery.leaseDuration.to_ns());
  announcement_ = std::chrono::nanoseconds(discovery.leaseDuration_announcementperiod.to_ns());
  return {};
}

Status RadioLink::join() {
  const Status joined = make_entities();
  if (!joined && participant_ != nullptr) {
    rtps::RTPSDomain::removeRTPSParticipant(participant_);
    participant_ = nullptr;
    data_reader_ = nullptr;
    remotes_.clear();
  }
  opened_ = Clock::now();
  return joined;
}

Status RadioLink::make_entities() {
  const std::string name = to_string(link_);
  auto attributes = radio_attributes(config_, link_, agent_, observes_, profile_);
  prepare_transports(attributes, guard_);
  participant_ = rtps::RTPSDomain::createParticipant(config_.domain, attributes);
  if (participant_ == nullptr) {
    return failure(name + ": cannot join DDS domain " + std::to_string(config_.domain) + " on " +
                   own_address(config_) + "; its log says why");
  }
  IPLocator::setIPv4(own_, own_address(config_));
  own_.kind = LOCATOR_KIND_UDPv4;
  own_.port = participant_->getRTPSParticipantAttributes().defaultUnicastLocatorList.begin()->port;

  const auto reader = [this](std::int16_t entity, std::unique_ptr<rtps::ReaderHistory>& history,
                             rtps::ReaderListener* listener) {
    auto attributes = best_effort<rtps::ReaderAttributes>();
    attributes.endpoint.setEntityID(entity);
    if (config_.multicast && entity == kDataReader) {
      attributes.endpoint.unicastLocatorList =
          participant_->getRTPSParticipantAttributes().defaultUnicastLocatorList;
      attributes.endpoint.multicastLocatorList.push_back(group());
    }
    history = std::make_unique<rtps::ReaderHistory>(unbounded_history());
    return rtps::RTPSDomain::createRTPSReader(participant_, attributes, payloads_, history.get(), listener);
  };
  data_reader_ = reader(kDataReader, data_history_, data_listener_.get());
  rtps::RTPSReader* hello_reader = reader(kHelloReader, hello_history_, hello_listener_.get());
  if (data_reader_ == nullptr || hello_reader == nullptr)
    return failure(name + ": Fast DDS is out of resources for two readers");
  hello_reader->enableMessagesFromUnkownWriters(true);

  for (const Locator& remote : listening_places(config_, profile_)) {
    if (Status added = add_remote(remote, /*configured=*/true); !added) return added;
  }
  return {};
}

/// Reliable radios repair without end what does not fit the rate; the exchange requests what it lacks.
Status RadioLink::check_best_effort() const {
  for (const std::string& profile : profiles_of(link_)) {
    if (writer_policy(qos_, profile).best_effort) continue;
    return failure(qos_.path.string() + ": <data_writer> \"" + profile + "\" is reliable; " +
                   to_string(link_) + " is best effort, since what is lost is asked for again");
  }
  return {};
}

RadioLink::~RadioLink() {
  if (stop_timer_) stop_timer_();
  if (participant_ != nullptr) {
    {
      const std::scoped_lock lock(mutex_);
      for (const auto& remote : remotes_) {
        // A robot that was not heard may have heard us; an observer has more addresses than a radio can carry
        // at once.
        if (remote->robot || !observes_) hellos_->send_hello(*remote, /*leaves=*/true);
      }
    }
    rtps::RTPSDomain::removeRTPSParticipant(participant_);
  }
  forget_topics();  // the ends of topics refer to members of this
}

std::unique_ptr<LinkEnd::TopicEnd> RadioLink::make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) {
  check_profile(qos_, topic);
  return std::make_unique<End>(*this, topic, inbox);
}

/// Joins once the own address is there, and logs when it comes and goes: sockets are bound to it and outlive
/// its absence.
void RadioLink::watch_address(Clock::time_point now) {
  if (now < next_address_check_) return;
  next_address_check_ = now + kAddressPeriod;
  const Status there = check_address(config_, to_string(link_));
  if (there && participant_ == nullptr) {
    if (const Status joined = join(); !joined) {
      next_address_check_ = now + kJoinPause;
      return spdlog::error("{}", joined.error().message);
    }
  }
  if (there.has_value() == address_there_) return;
  address_there_ = there.has_value();
  if (there) {
    spdlog::info("{}: {} is there", to_string(link_), own_address(config_));
  } else {
    spdlog::warn("{}; the link is silent until it is there", there.error().message);
  }
}

RadioSurvey RadioLink::survey() const {
  const std::scoped_lock lock(mutex_);
  RadioSurvey survey;
  if (participant_ == nullptr || !address_there_) {
    const Status there = check_address(config_, to_string(link_));
    survey.problem =
        there ? std::string(to_string(link_)) + ": not joined; the log says why" : there.error().message;
  }
  survey.robots = notices_.robots();
  survey.places = remotes_.size();
  for (const auto& remote : remotes_) {
    if (elsewhere(*remote) && !remote->heard) survey.silent.push_back(to_text(remote->locator));
  }
  survey.refused = notices_.refusals();
  survey.different_settings = notices_.differences();
  return survey;
}

std::optional<AgentId> RadioLink::robot_of(const Inbox::Sender& sender) const {
  Prefix prefix;
  std::ranges::copy(sender, prefix.value);
  const auto peer = peers_.find(prefix);
  return peer == peers_.end() ? std::nullopt : std::optional(peer->second.agent);
}

void RadioLink::take_heard_traffic(std::vector<HeardTraffic>& all) {
  const std::scoped_lock lock(mutex_);
  const std::scoped_lock received(received_->mutex);
  for (auto& [prefix, robot] : received_->robots) {
    const auto peer = peers_.find(prefix);
    if (peer == peers_.end() || robot.traffic.messages + robot.traffic.hellos == 0) continue;
    HeardTraffic& traffic = all.emplace_back(std::exchange(robot.traffic, {}));
    traffic.link = link_;
    traffic.from = peer->second.agent;
    if (traffic.timed > 0) traffic.delay /= static_cast<std::int64_t>(traffic.timed);
  }
}

rtps::ReaderProxyData RadioLink::reader_of(const Prefix& robot, const Peer& peer) const {
  rtps::ReaderProxyData data(1, config_.multicast ? 1 : 0);
  data.guid({robot, data_reader_->getGuid().entityId});
  data.topicKind(rtps::NO_KEY);
  data.add_unicast_locator(peer.locator);
  // Fast DDS takes it once two readers of a topic have it.
  if (config_.multicast && peer.multicast) data.add_multicast_locator(group());
  return data;
}

/// The multicast group at which robots of this link also listen, with RTPS's port of data. A group of our own
/// at the port of discovery would not be heard, since that socket is bound to discovery's group.
RadioLink::Locator RadioLink::group() const {
  Locator locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(locator, 239, 255, 0, 1);
  const auto& ports = profile_.wire_protocol().port;
  locator.port = ports.portBase + ports.domainIDGain * config_.domain + ports.offsetd2;
  return locator;
}

/// Robots that share the medium with this one, as configured: what goes to this machine does not take it.
bool RadioLink::elsewhere(const RemoteLocator& remote) const {
  return remote.configured && !IPLocator::compareAddress(remote.locator, own_) &&
         !IPLocator::isLocal(remote.locator);
}

/// The number of robots that send Hellos as this one does: all others while a fleet starts. An observer joins
/// one that may be using the radio, and takes a quarter of the Hellos' part.
double RadioLink::others() const {
  if (observes_) return 3.0;
  return static_cast<double>(
      std::ranges::count_if(remotes_, [this](const auto& remote) { return elsewhere(*remote); }));
}

Status RadioLink::add_remote(const Locator& locator, bool configured) {
  if (locator == own_ || (!configured && remotes_.size() >= kMaxRemotes)) return {};
  auto remote = std::make_unique<RemoteLocator>();
  remote->locator = locator;
  remote->configured = configured;
  remote->pause = pacing_.first_pause(others(), others());
  remote->history = std::make_unique<rtps::WriterHistory>(unbounded_history());
  auto attributes = best_effort<rtps::WriterAttributes>();
  attributes.mode = rtps::SYNCHRONOUS_WRITER;
  const std::uint32_t number = ++hello_writers_ % (0xffffff - kHelloWriters);
  remote->writer = rtps::RTPSDomain::createRTPSWriter(participant_, writer_id(kHelloWriters + number),
                                                      attributes, payloads_, remote->history.get());
  auto* writer = dynamic_cast<rtps::StatelessWriter*>(remote->writer);
  rtps::LocatorList_t there;
  there.push_back(locator);
  if (writer == nullptr || !writer->set_fixed_locators(there))
    return failure(std::string(to_string(link_)) + ": Fast DDS makes no writer to " + to_text(locator));
  remotes_.push_back(std::move(remote));
  return {};
}

RadioLink::RemoteLocator* RadioLink::remote_at(const Locator& locator) {
  const auto remote =
      std::ranges::find_if(remotes_, [&](const auto& other) { return other->locator == locator; });
  return remote == remotes_.end() ? nullptr : remote->get();
}

/// A Hello may claim any address; no robot listens at these.
bool RadioLink::plausible(const Locator& locator) const {
  const std::uint8_t first = IPLocator::getIPv4(locator)[0];
  constexpr std::uint8_t kMulticast = 224;
  return first != 0 && first < kMulticast && IPLocator::isLocal(locator) == IPLocator::isLocal(own_) &&
         locator != own_;
}

/// Returns the address from which the Hello claims to come; empty if no robot can listen there.
std::optional<RadioLink::Locator> RadioLink::origin_of(const std::array<std::uint8_t, 4>& address,
                                                       std::uint16_t port) const {
  Locator from;
  from.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(from, address.data());
  from.port = port;
  return plausible(from) ? std::optional(from) : std::nullopt;
}

std::optional<RadioLink::Clock::time_point> RadioLink::last_heard(const Prefix& robot) const {
  const std::scoped_lock lock(received_->mutex);
  const auto last = received_->robots.find(robot);
  return last == received_->robots.end() ? std::nullopt : std::optional(last->second.heard);
}

bool RadioLink::heard_itself(const RemoteLocator& remote) const {
  return remote.robot && !peers_.at(*remote.robot).introduced;
}

bool RadioLink::heard_recently(const Prefix& robot) const {
  const auto heard = last_heard(robot);
  return heard && Clock::now() - *heard < kStillThere;
}

void RadioLink::forget(Prefix robot) {
  if (peers_.erase(robot) == 0) return;
  introductions_.forget(Hellos::bytes_of(robot));
  for (const auto& [key, end] : ends_) end->forget(robot);
  std::erase_if(remotes_, [&](const auto& remote) {
    if (remote->robot != robot) return false;
    remote->robot.reset();
    remote->next = {};  // as at the start
    remote->claimed.reset();
    remote->names_predecessor = remote->missed_answer = false;
    if (!remote->configured) rtps::RTPSDomain::removeRTPSWriter(remote->writer);
    return !remote->configured;
  });
  const std::scoped_lock lock(received_->mutex);
  received_->robots.erase(robot);
}

}  // namespace fleetmap::bus
