#include "radio_rates.hpp"

namespace fleetmap::apps {
namespace {

constexpr const char* kSubmapChunk = "submap_chunk";

double rate(std::uint64_t before, std::uint64_t now, double seconds) {
  return now > before && seconds > 0.0 ? static_cast<double>(now - before) / seconds : 0.0;
}

}  // namespace

std::string kind_of_topic(const std::string& topic) {
  const std::size_t begin = topic.find('/') + 1;  // 0 without one
  return topic.substr(begin, topic.find('/', begin) - begin);
}

monitor::RadioNow RadioRates::add(const RadioCounters& counters, const std::vector<bus::HeardTraffic>& heard,
                                  Stamp now) {
  Second second{now, counters.sent_bytes, {}, heard};
  for (const bus::TopicStats& topic : counters.topics) {
    if (topic.link == bus::Link::kOnboard) continue;
    Sums& bytes = second.kinds[{topic.link, kind_of_topic(topic.topic)}];
    bytes.sent += topic.sent_bytes + topic.sent_messages * counters.message_bytes;
    bytes.received += topic.received_bytes + topic.received_messages * counters.message_bytes;
  }
  monitor::RadioNow radio;
  if (!window_.empty()) {
    const double elapsed = to_seconds(now - window_.back().at);
    radio.sent = rate(window_.back().sent_bytes, second.sent_bytes, elapsed);
    std::uint64_t received = 0;
    for (const bus::HeardTraffic& traffic : heard)
      if (traffic.link == bus::Link::kLongRange) received += traffic.bytes;
    radio.received = rate(0, received, elapsed);
  }
  window_.push_back(std::move(second));
  while (now - window_.front().at > kWindow) window_.pop_front();
  radio.kinds = kind_rates();
  radio.peers = peer_rates();
  return radio;
}

std::vector<monitor::KindRate> RadioRates::kind_rates() const {
  std::vector<monitor::KindRate> rates;
  const auto& before = window_.front().kinds;
  for (const auto& [kind, bytes] : window_.back().kinds) {
    const auto found = before.find(kind);
    const Sums first = found == before.end() ? Sums{} : found->second;
    if (bytes.sent == first.sent && bytes.received == first.received) continue;
    rates.push_back({bus::to_string(kind.first), kind.second, rate(first.sent, bytes.sent, seconds()),
                     rate(first.received, bytes.received, seconds())});
  }
  return rates;
}

std::vector<monitor::PeerRate> RadioRates::peer_rates() const {
  std::map<Peer, bus::HeardTraffic> sums;
  for (std::size_t k = 1; k < window_.size(); ++k) {  // the first second began before the window
    for (const bus::HeardTraffic& traffic : window_[k].heard) {
      bus::HeardTraffic& sum = sums[{traffic.link, traffic.from}];
      sum.messages += traffic.messages;
      sum.bytes += traffic.bytes;
      sum.lost += traffic.lost;
      sum.timed += traffic.timed;
      sum.delay += traffic.delay * static_cast<std::int64_t>(traffic.timed);
    }
  }
  std::vector<monitor::PeerRate> rates;
  for (const auto& [peer, sum] : sums) {
    if (sum.messages == 0) continue;
    const auto messages = static_cast<double>(sum.messages), lost = static_cast<double>(sum.lost);
    rates.push_back({peer.second, bus::to_string(peer.first), rate(0, sum.bytes, seconds()),
                     lost / (lost + messages),
                     sum.timed > 0 ? std::optional(to_seconds(sum.delay) / static_cast<double>(sum.timed))
                                   : std::nullopt});
  }
  return rates;
}

double RadioRates::submap_rate() const {
  for (const monitor::KindRate& one : kind_rates())
    if (one.kind == kSubmapChunk && one.link == bus::to_string(bus::Link::kShortRange)) return one.received;
  return 0.0;
}

}  // namespace fleetmap::apps
