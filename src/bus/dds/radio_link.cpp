#include "radio_link.hpp"

#include <fastdds/rtps/builtin/data/WriterProxyData.h>
#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>
#include <fastdds/rtps/writer/RTPSWriter.h>
#include <fastdds/rtps/writer/StatelessWriter.h>
#include <fastrtps/utils/IPLocator.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <stdexcept>
#include <utility>

#include "fleetmap/bus/wire_overhead.hpp"
#include "participant_qos.hpp"

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
using rtps::IPLocator;

constexpr auto kTick = std::chrono::milliseconds(50);
constexpr auto kReadsChange = std::chrono::milliseconds(100);  // until who is known hears of other topics
constexpr double kHelloBits = 8.0 * 260.0;                     // on the wire
/// What Hellos of all robots together may take of the medium, bit/s: in the mean while a fleet starts, and in
/// any second.
struct HelloRates {
  double mean, most;
};
constexpr HelloRates rates_of(Link link) {
  return link == Link::kLongRange ? HelloRates{62e3, 135e3} : HelloRates{620e3, 1350e3};
}
constexpr double kLongestSpread = 6.0;  // s: a fleet is to know itself within ten
constexpr auto kFirstPause =
    std::chrono::seconds(1);  // until a Hello is repeated, and a part of the spread besides
constexpr auto kLongestPause = std::chrono::seconds(2);  // and a second for each other robot
constexpr int kQuickHellos = 5;  // with this pause: the radio loses some; then the pause doubles each time
constexpr auto kAnswerAgain = std::chrono::milliseconds(300);
/// Whoever was heard so lately is still there. A robot that was killed and starts anew says Hello for longer.
constexpr auto kStillThere = std::chrono::seconds(2);
constexpr auto kAddressPeriod = std::chrono::seconds(1);
constexpr auto kJoinPause = std::chrono::seconds(30);   // after it failed
constexpr auto kNeverHeard = std::chrono::seconds(30);  // then it is said
constexpr std::size_t kMostNamesakes = 16;
constexpr std::size_t kMostWarnings = 128;                 // about others
constexpr std::size_t kMostPlaces = 256;                   // strangers may name so many
constexpr std::size_t kMostHellos = 256;                   // that wait for the callback thread
constexpr std::int16_t kHelloReader = 1, kDataReader = 2;  // entity ids
constexpr std::uint32_t kHelloWriters = 0xff0000;          // entity ids of writers from here on

rtps::EntityId_t writer_id(std::uint32_t key) {
  constexpr std::uint8_t kUserWriterWithoutKey = 0x03;
  rtps::EntityId_t id;
  id.value[0] = static_cast<std::uint8_t>(key >> 16);
  id.value[1] = static_cast<std::uint8_t>(key >> 8);
  id.value[2] = static_cast<std::uint8_t>(key);
  id.value[3] = kUserWriterWithoutKey;
  return id;
}

std::uint32_t key_of(const rtps::EntityId_t& id) {
  return static_cast<std::uint32_t>(id.value[0]) << 16 | static_cast<std::uint32_t>(id.value[1]) << 8 |
         id.value[2];
}

/// The same on every robot.
std::uint32_t key_of(const Topic& topic) {
  const std::string text = topic.name + '|' + topic.type;
  const ContentHash hash = content_hash({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const std::uint32_t key = static_cast<std::uint32_t>(hash[0]) << 16 |
                            static_cast<std::uint32_t>(hash[1]) << 8 | static_cast<std::uint32_t>(hash[2]);
  return key >= kHelloWriters ? key ^ 0x800000u : key;
}

std::string to_text(const rtps::Locator_t& locator) {
  return IPLocator::toIPv4string(locator) + ":" + std::to_string(locator.port);
}

/// Sends one change; what a full history holds gives way.
bool send(rtps::RTPSWriter& writer, rtps::WriterHistory& history, const Bytes& cdr, std::size_t depth) {
  while (history.getHistorySize() >= depth && history.remove_min_change()) {
  }
  rtps::CacheChange_t* change =
      writer.new_change([&cdr]() -> std::uint32_t { return payload_size(cdr); }, rtps::ALIVE);
  if (change == nullptr) return false;
  if (write_payload(cdr, change->serializedPayload)) return history.add_change(change);
  writer.release_change(change);
  return false;
}

rtps::HistoryAttributes unbounded_history() { return {rtps::DYNAMIC_RESERVE_MEMORY_MODE, 256, 0, 0}; }

/// What all endpoints on radios are.
template <class Attributes>
Attributes best_effort() {
  Attributes attributes;
  attributes.endpoint.reliabilityKind = rtps::BEST_EFFORT;
  attributes.endpoint.durabilityKind = rtps::VOLATILE;
  attributes.endpoint.topicKind = rtps::NO_KEY;
  eprosima::fastdds::dds::DataSharingQosPolicy off;
  off.off();
  attributes.endpoint.set_data_sharing_configuration(off);
  return attributes;
}

/// Takes a change out of its reader's history; empty for what is no message.
std::optional<Bytes> taken(rtps::RTPSReader& reader, const rtps::CacheChange_t* change) {
  std::optional<Bytes> cdr(std::in_place);
  if (!read_payload(change->serializedPayload, *cdr)) cdr.reset();
  reader.getHistory()->remove_change(const_cast<rtps::CacheChange_t*>(change));
  return cdr;
}

/// By the clocks of the machine that set the stamp and of this one.
Duration since(const rtps::Time_t& stamp) {
  rtps::Time_t now;
  rtps::Time_t::now(now);
  return Duration(now.to_ns() - stamp.to_ns());
}

}  // namespace

/// What Fast DDS's threads leave for the callback thread. Its lock is never held while Fast DDS is called.
struct RadioLink::Received {
  struct Topic {
    std::shared_ptr<Inbox> inbox;
    std::function<void()> dispatch;
  };
  struct Robot {
    Clock::time_point heard;
    std::map<EntityKey, std::uint64_t> numbers;  ///< of the last message of each of its writers
    HeardTraffic traffic;                        ///< since it was last asked for; `delay` is their sum
  };
  std::mutex mutex;
  std::map<EntityKey, Topic> topics;
  std::map<Prefix, Robot> robots;
  std::deque<std::pair<Prefix, Bytes>> hellos;
};

class RadioLink::HelloListener final : public rtps::ReaderListener {
 public:
  explicit HelloListener(std::shared_ptr<Received> received) : received_(std::move(received)) {}
  void onNewCacheChangeAdded(rtps::RTPSReader* reader, const rtps::CacheChange_t* change) override {
    const Prefix sender = change->writerGUID.guidPrefix;
    std::optional<Bytes> cdr = taken(*reader, change);
    if (!cdr) return;
    const std::scoped_lock lock(received_->mutex);
    if (received_->hellos.size() < kMostHellos) received_->hellos.emplace_back(sender, *std::move(cdr));
  }

 private:
  const std::shared_ptr<Received> received_;
};

class RadioLink::DataListener final : public rtps::ReaderListener {
 public:
  DataListener(std::shared_ptr<Received> received, std::shared_ptr<Executor> executor)
      : received_(std::move(received)), executor_(std::move(executor)) {}
  void onNewCacheChangeAdded(rtps::RTPSReader* reader, const rtps::CacheChange_t* change) override {
    const rtps::GUID_t writer = change->writerGUID;
    const std::uint64_t number = change->sequenceNumber.to64long();
    const Duration delay = since(change->sourceTimestamp);
    std::optional<Bytes> cdr = taken(*reader, change);
    if (!cdr) return;
    std::function<void()> dispatch;
    {
      const std::scoped_lock lock(received_->mutex);
      Received::Robot& robot = received_->robots[writer.guidPrefix];
      robot.heard = Clock::now();
      count(robot, key_of(writer.entityId), number, cdr->size(), delay);
      const auto topic = received_->topics.find(key_of(writer.entityId));
      if (topic == received_->topics.end()) return;
      topic->second.inbox->put(*std::move(cdr));
      dispatch = topic->second.dispatch;
    }
    executor_->post(dispatch);
  }

 private:
  static void count(Received::Robot& robot, EntityKey writer, std::uint64_t number, std::size_t payload,
                    Duration delay) {
    const auto [last, first] = robot.numbers.try_emplace(writer, number);
    if (!first && number > last->second) robot.traffic.lost += number - last->second - 1;
    last->second = number;
    ++robot.traffic.messages;
    robot.traffic.bytes += wire_bytes(payload);
    robot.traffic.delay += delay;
  }

  const std::shared_ptr<Received> received_;
  const std::shared_ptr<Executor> executor_;
};

class RadioLink::End final : public TopicEnd {
 public:
  End(RadioLink& link, const Topic& topic, std::shared_ptr<Inbox> inbox)
      : link_(link), topic_(topic), key_(key_of(topic)), inbox_(std::move(inbox)) {
    const auto [other, fresh] = link_.ends_.emplace(key_, this);
    if (!fresh) {
      throw std::logic_error("topics " + topic.name + " and " + other->second->topic_.name +
                             " have the same entity id; give that robot another name");
    }
  }
  ~End() override { link_.ends_.erase(key_); }

  void open_writer() override {
    if (writer_ != nullptr || link_.participant_ == nullptr)
      return;  // else with the first message after it joins
    const WriterPolicy policy = writer_policy(link_.qos_, topic_.profile);
    depth_ = policy.depth;
    auto attributes = best_effort<rtps::WriterAttributes>();
    attributes.mode = policy.synchronous ? rtps::SYNCHRONOUS_WRITER : rtps::ASYNCHRONOUS_WRITER;
    history_ = std::make_unique<rtps::WriterHistory>(unbounded_history());
    writer_ = rtps::RTPSDomain::createRTPSWriter(link_.participant_, writer_id(key_), attributes,
                                                 link_.payloads_, history_.get());
    if (writer_ == nullptr) throw std::logic_error("Fast DDS makes no writer of " + topic_.name);
    for (const auto& [robot, peer] : link_.peers_) meet(robot, peer);
  }
  void open_reader() override {
    if (link_.reads_.contains(key_)) return;
    {
      const std::scoped_lock lock(link_.received_->mutex);
      link_.received_->topics[key_] = {inbox_, link_.dispatcher(topic_.name)};
    }
    link_.reads_.insert(key_);
    for (const auto& [robot, peer] : link_.peers_) hear(robot);
    link_.reads_changed();
  }
  void close_reader() override {
    if (!link_.reads_.contains(key_)) return;
    {
      const std::scoped_lock lock(link_.received_->mutex);
      link_.received_->topics.erase(key_);
    }
    link_.reads_.erase(key_);
    for (const auto& [robot, peer] : link_.peers_) unhear(robot);
    link_.reads_changed();
  }
  bool write(const Bytes& cdr) override {
    const auto now = Clock::now();
    bool anyone = false;
    for (auto& [robot, peer] : link_.peers_) {
      if (!peer.reads.contains(key_)) continue;
      peer.told = now;
      anyone = true;
    }
    return !anyone || send(*writer_, *history_, cdr, depth_);
  }
  DdsBus::Matches matches() const override {
    DdsBus::Matches result;
    for (const auto& [robot, peer] : link_.peers_) result.readers += peer.reads.contains(key_);
    if (writer_ == nullptr) result.readers = 0;
    if (link_.reads_.contains(key_)) result.writers = link_.peers_.size();
    return result;
  }

  /// Sends to `robot` if it reads this topic, else no more.
  void meet(const Prefix& robot, const Peer& peer) {
    if (writer_ == nullptr) return;
    if (peer.reads.contains(key_)) {
      writer_->matched_reader_add(link_.reader_of(robot, peer));
    } else {
      part(robot);
    }
  }
  /// Hears `robot` on this topic.
  void hear(const Prefix& robot) {
    if (!link_.reads_.contains(key_)) return;
    rtps::WriterProxyData data(0, 0);
    data.guid(writer_of(robot));
    data.topicKind(rtps::NO_KEY);
    link_.data_reader_->matched_writer_add(data);
  }
  void forget(const Prefix& robot) {
    part(robot);
    unhear(robot);
  }

 private:
  void part(const Prefix& robot) {
    if (writer_ != nullptr) writer_->matched_reader_remove({robot, data_reader_id()});
  }
  void unhear(const Prefix& robot) { link_.data_reader_->matched_writer_remove(writer_of(robot)); }
  rtps::EntityId_t data_reader_id() const { return link_.data_reader_->getGuid().entityId; }
  rtps::GUID_t writer_of(const Prefix& robot) const { return {robot, writer_id(key_)}; }

  RadioLink& link_;
  const Topic topic_;
  const EntityKey key_;
  const std::shared_ptr<Inbox> inbox_;
  std::size_t depth_ = 1;
  std::unique_ptr<rtps::WriterHistory> history_;
  rtps::RTPSWriter* writer_ = nullptr;
};

RadioLink::RadioLink(Link link, const DdsBusConfig& config, QosFile qos, std::shared_ptr<Executor> executor)
    : LinkEnd(link, config_of(config, link), std::move(executor)),
      agent_(config.agent),
      settings_(config.settings),
      observes_(config.observes),
      qos_(std::move(qos)),
      received_(std::make_shared<Received>()),
      hello_listener_(std::make_unique<HelloListener>(received_)),
      data_listener_(std::make_unique<DataListener>(received_, executor_)) {}

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
  result->stop_timer_ = result->executor_->add_timer(kTick, [weak = std::weak_ptr<RadioLink>(result)] {
    if (const auto alive = weak.lock()) alive->tick();
  });
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
  participant_ = rtps::RTPSDomain::createParticipant(
      config_.domain, radio_attributes(config_, link_, agent_, observes_, profile_));
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

/// Over which the Hellos of a fleet that starts at once are spread, each robot's to each other's.
RadioLink::Clock::duration RadioLink::spread() const {
  if (observes_) return {};
  const double seconds = others() * (others() + 1.0) * kHelloBits / rates_of(link_).mean;
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::min(seconds, kLongestSpread)));
}

Status RadioLink::add_place(const Locator& locator, bool configured) {
  if (locator == own_ || (!configured && places_.size() >= kMostPlaces)) return {};
  auto place = std::make_unique<Place>();
  place->locator = locator;
  place->configured = configured;
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
  if (place.robot) std::copy_n(place.robot->value, hello.knows.size(), hello.knows.begin());
  hello.leaves = leaves;
  hello.sender = agent_;
  std::copy_n(IPLocator::getIPv4(own_), hello.address.size(), hello.address.begin());
  hello.port = static_cast<std::uint16_t>(own_.port);
  hello.settings = settings_;
  hello.link = link_;
  for (const EntityKey key : reads_) {
    if (hello.reads.size() < kMostReads) hello.reads.push_back(key);
  }
  send(*place.writer, *place.history, encode(hello), 1);
  const auto now = Clock::now();
  // Robots that start together would else meet in step.
  const double jitter = std::uniform_real_distribution(0.5, 1.5)(random_);
  place.next = now + std::chrono::duration_cast<Clock::duration>(jitter * place.pause);
  // In a small fleet a robot that comes into reach again is to be known within ten seconds.
  const Clock::duration least = kFirstPause;
  const Clock::duration most = std::min<Clock::duration>(
      announcement_,
      kLongestPause + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(others())));
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
  for (const auto& [sender, cdr] : hellos) {
    if (const auto hello = decode_hello(cdr)) {
      take(sender, *hello);
    } else {
      take_other(cdr);
    }
  }
  for (const Prefix& robot : silent()) forget(robot);
  const auto now = Clock::now();
  for (const auto& place : places_) {
    if (place->next == Clock::time_point{}) {
      // Those that must be repeated are few.
      place->pause = std::chrono::duration_cast<Clock::duration>(kFirstPause) + spread() / 2;
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
  const auto pause = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>((others() + 1.0) * kHelloBits / rates_of(link_).most));
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

void RadioLink::take(const Prefix& sender, const Hello& hello) {
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
    if (heard_lately(*place->robot)) return;
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
    received_->robots[sender].heard = Clock::now();
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
  for (const auto& [key, end] : ends_) {
    end->meet(sender, peer);
    end->hear(sender);
  }
  const Prefix& own = participant_->getGuid().guidPrefix;
  const bool knows_us = std::ranges::equal(hello.knows, own.value);
  place->mistakes_us = !knows_us && std::ranges::any_of(hello.knows, std::identity{});
  if (!knows_us || replaced) {
    if (known && place->next == Clock::time_point::max()) place->asks_again = true;  // no answer is under way
    place->next = Clock::time_point::min();  // before those to robots that may not be there
  } else if (peer.greeted == Clock::time_point{}) {
    peer.greeted = Clock::now();  // by what made it know us
  }
  executor_->post([] {});  // wakes who waits for it
}

/// For survey().
void RadioLink::note(const Hello& hello, const Locator& from) {
  const std::string place = to_text(from);
  const auto known = std::ranges::find_if(heard_, [&](const RadioSurvey::Robot& robot) {
    return robot.agent == hello.sender && robot.place == place;
  });
  if (known != heard_.end()) {
    known->settings = hello.settings;
  } else if (heard_.size() < kMostPlaces) {
    const bool here = IPLocator::compareAddress(from, own_) || IPLocator::isLocal(from);
    heard_.push_back({hello.sender, place, here, domain_of(from.port, profile_),
                      std::chrono::duration_cast<Duration>(Clock::now() - opened_), hello.settings});
  }
}

bool RadioLink::first_time(const std::string& warning) {
  return warnings_.size() < kMostWarnings && warnings_.insert(warning).second;
}

/// Once per robot and difference.
void RadioLink::compare(const Hello& hello) {
  if (!settings_ || !hello.settings) return;
  for (const std::string& difference : differences(hello.sender.str(), *hello.settings, *settings_)) {
    if (first_time(difference)) spdlog::warn("{}: {}", to_string(link_), difference);
  }
}

/// A robot with which no exchange is possible.
void RadioLink::refuse(const Locator& from, const std::string& why) {
  if (Place* place = place_at(from)) place->heard = true;
  if (!first_time(to_text(from) + why)) return;
  refused_.push_back(to_text(from) + ": " + why);
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

bool RadioLink::heard_lately(const Prefix& robot) const {
  const std::scoped_lock lock(received_->mutex);
  const auto last = received_->robots.find(robot);
  return last != received_->robots.end() && Clock::now() - last->second.heard < kStillThere;
}

void RadioLink::take_heard_traffic(std::vector<HeardTraffic>& all) {
  const std::scoped_lock lock(mutex_);
  const std::scoped_lock received(received_->mutex);
  for (auto& [prefix, robot] : received_->robots) {
    const auto peer = peers_.find(prefix);
    if (peer == peers_.end() || robot.traffic.messages == 0) continue;
    HeardTraffic& traffic = all.emplace_back(std::exchange(robot.traffic, {}));
    traffic.link = link_;
    traffic.from = peer->second.agent;
    traffic.delay /= static_cast<std::int64_t>(traffic.messages);
  }
}

void RadioLink::forget(Prefix robot) {
  if (peers_.erase(robot) == 0) return;
  for (const auto& [key, end] : ends_) end->forget(robot);
  std::erase_if(places_, [&](const auto& place) {
    if (place->robot != robot) return false;
    place->robot.reset();
    place->next = {};  // as at the start
    if (!place->configured) rtps::RTPSDomain::removeRTPSWriter(place->writer);
    return !place->configured;
  });
  const std::scoped_lock lock(received_->mutex);
  received_->robots.erase(robot);
}

rtps::ReaderProxyData RadioLink::reader_of(const Prefix& robot, const Peer& peer) const {
  rtps::ReaderProxyData data(1, config_.multicast ? 1 : 0);
  data.guid({robot, data_reader_->getGuid().entityId});
  data.topicKind(rtps::NO_KEY);
  data.add_unicast_locator(peer.locator);
  // Fast DDS takes it once two readers of a topic have it.
  if (config_.multicast) data.add_multicast_locator(group());
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
