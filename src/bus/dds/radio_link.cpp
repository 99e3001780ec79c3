#include "radio_link.hpp"

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "participant_qos.hpp"
#include "radio_received.hpp"
#include "radio_topic.hpp"
#include "rtps_messages.hpp"
#include "sealed_transport.hpp"

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using rtps::IPLocator;

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
      received_(std::make_shared<Received>()),
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
                if (const auto alive = weak.lock()) alive->tick();
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
    places_.clear();
  }
  opened_ = Clock::now();
  return joined;
}

Status RadioLink::make_entities() {
  const std::string name = to_string(link_);
  auto attributes = radio_attributes(config_, link_, agent_, observes_, profile_);
  if (guard_) seal_transports(attributes, guard_);
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

  for (const Locator& place : listening_places(config_, profile_)) {
    if (Status added = add_place(place, /*configured=*/true); !added) return added;
  }
  return {};
}

/// Reliable radios repair without end what does not fit; the exchange asks for what it lacks.
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
      for (const auto& place : places_) {
        // Who was not heard may have heard; an observer has more places than a radio takes at once.
        if (place->robot || !observes_) say_hello(*place, /*leaves=*/true);
      }
    }
    rtps::RTPSDomain::removeRTPSParticipant(participant_);
  }
  forget_topics();  // whose ends refer to members of this
}

std::unique_ptr<LinkEnd::TopicEnd> RadioLink::make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) {
  check_profile(qos_, topic);
  return std::make_unique<End>(*this, topic, inbox);
}

/// Joins once the own address is there, and says when it comes and goes: sockets are bound to it and outlive
/// its absence.
void RadioLink::watch_address(Clock::time_point now) {
  if (now < next_look_) return;
  next_look_ = now + kAddressPeriod;
  const Status there = check_address(config_, to_string(link_));
  if (there && participant_ == nullptr) {
    if (const Status joined = join(); !joined) {
      next_look_ = now + kJoinPause;
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
  survey.robots = heard_;
  survey.places = places_.size();
  for (const auto& place : places_) {
    if (elsewhere(*place) && !place->heard) survey.silent.push_back(to_text(place->locator));
  }
  survey.notices = refused_;
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
    if (traffic.messages > 0) traffic.delay /= static_cast<std::int64_t>(traffic.messages);
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

/// Where robots of this link listen besides: the group and port that RTPS has for data. A group of our own at
/// the port of discovery would not be heard, since that socket is bound to discovery's group.
RadioLink::Locator RadioLink::group() const {
  Locator locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(locator, 239, 255, 0, 1);
  const auto& ports = profile_.wire_protocol().port;
  locator.port = ports.portBase + ports.domainIDGain * config_.domain + ports.offsetd2;
  return locator;
}

}  // namespace fleetmap::bus
