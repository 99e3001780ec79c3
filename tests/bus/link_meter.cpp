// Measures what a link carries: run one end in each of two network namespaces (measure_links.sh does so).
//   link_meter long-send|long-receive|short-send|short-receive --iface DEV --address IP --peer IP --qos DIR
//              --seconds N [--bucket KBIT_S]
// Long range: one cloud of 25,000 bytes after the other, in datagrams, the receiver asking for what is
// missing, and five messages of 200 bytes a second beside them. Short range: chunks of 8 kB, asked for in
// windows. The two ends share the machine's clock, so that latencies are from publish call to callback.
// Prints one JSON line at the end.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <set>
#include <string>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/exchange/token_bucket.hpp"
#include "wire_meter.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::bus;
using namespace std::chrono_literals;

const Topic kNode{Link::kLongRange, "meter/node", "meter::Node", "small"};
const Topic kAnswer{Link::kLongRange, "meter/answer", "meter::Answer", "small"};
const Topic kFragment{Link::kLongRange, "meter/fragment", "meter::Fragment", "cloud"};
const Topic kRequest{Link::kShortRange, "meter/request", "meter::Request", "control"};
const Topic kChunk{Link::kShortRange, "meter/chunk", "meter::Chunk", "bulk"};
constexpr std::size_t kFragmentPayload = 1100;
constexpr std::size_t kCloudBytes = 25000;
constexpr std::uint16_t kFragments = (kCloudBytes + kFragmentPayload - 1) / kFragmentPayload;
constexpr std::size_t kChunkPayload = 8192;
constexpr std::uint32_t kWindow = 128;  // chunks
constexpr double kBurstBytes = 3000.0;  // about two full datagrams

/// Header of every message. An answer carries the missing indices after it, and none when all have arrived.
struct Header {
  std::int64_t stamp_ns = 0;  ///< of the first publish of the whole
  std::uint32_t id = 0;
  std::uint16_t index = 0;
  std::uint16_t extra = 0;
};

Bytes pack(const Header& header, std::size_t payload) {
  Bytes cdr(4 + sizeof header + payload);
  cdr[1] = 1;
  std::memcpy(cdr.data() + 4, &header, sizeof header);
  return cdr;
}

Header unpack(const Bytes& cdr) {
  Header header;
  std::memcpy(&header, cdr.data() + 4, sizeof header);
  return header;
}

struct Options {
  std::string role, iface, address, peer, qos;
  double seconds = 30.0;
  double bucket_kbit_s = 0.0;  ///< 0: no bucket
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return -1.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class LongSender {
 public:
  LongSender(Bus& bus, const Options& options)
      : bus_(bus),
        paced_(options.bucket_kbit_s > 0.0),
        bucket_(paced_ ? options.bucket_kbit_s * 125.0 : 1.0, kBurstBytes) {
    handles_.push_back(bus.subscribe(kAnswer, [this](const Bytes& cdr) { answered(cdr); }));
    handles_.push_back(bus.every(200ms, [this] {
      send(kNode, pack({to_ns(bus_.now()), nodes_++, 0, 0}, 200));
    }));
    handles_.push_back(bus.every(2ms, [this] { drain(); }));
    handles_.push_back(bus.every(500ms, [this] {
      if (bus_.now() - heard_ > 4s) send_fragment(0);  // everything was lost, the answer as well
    }));
    next_cloud();
  }
  void report() const { std::printf("\"nodes_sent\": %u, \"clouds_begun\": %u", nodes_, cloud_); }

 private:
  void next_cloud() {
    ++cloud_;
    began_ = heard_ = bus_.now();
    for (std::uint16_t i = 0; i < kFragments; ++i) send_fragment(i);
  }
  void send_fragment(std::uint16_t index) {
    send(kFragment, pack({to_ns(began_), cloud_, index, kFragments}, kFragmentPayload));
  }
  void answered(const Bytes& cdr) {
    const Header header = unpack(cdr);
    if (header.id != cloud_) return;
    heard_ = bus_.now();
    if (header.extra == 0) {
      next_cloud();
      return;
    }
    for (std::uint16_t i = 0; i < header.extra; ++i) {
      std::uint16_t index = 0;
      std::memcpy(&index, cdr.data() + 4 + sizeof header + 2 * i, 2);
      send_fragment(index);
    }
  }
  void send(const Topic& topic, Bytes cdr) {
    if (!paced_) return bus_.publish(topic, cdr);
    (topic.name == kFragment.name ? large_ : small_).emplace_back(topic, std::move(cdr));
    drain();
  }
  void drain() {
    for (auto* queue : {&small_, &large_}) {
      while (!queue->empty()) {
        const auto& [topic, cdr] = queue->front();
        if (!bucket_.take(static_cast<double>(wire_bytes(cdr.size())), bus_.now())) return;
        bus_.publish(topic, cdr);
        queue->pop_front();
      }
    }
  }

  Bus& bus_;
  bool paced_;
  exchange::TokenBucket bucket_;
  std::deque<std::pair<Topic, Bytes>> small_, large_;
  std::uint32_t nodes_ = 0;
  std::uint32_t cloud_ = 0;
  Stamp began_, heard_;
  std::vector<Handle> handles_;
};

class LongReceiver {
 public:
  explicit LongReceiver(Bus& bus) : bus_(bus) {
    handles_.push_back(bus.subscribe(kNode, [this](const Bytes& cdr) {
      node_ms_.push_back(static_cast<double>(to_ns(bus_.now()) - unpack(cdr).stamp_ns) * 1e-6);
    }));
    handles_.push_back(bus.subscribe(kFragment, [this](const Bytes& cdr) { fragment(cdr); }));
    handles_.push_back(bus.every(200ms, [this] {
      if (current_ == 0 || bus_.now() - last_ < 600ms) return;
      last_ = bus_.now();
      answer();
    }));
  }
  void report() const {
    std::printf(
        "\"clouds\": %zu, \"cloud_ms_p50\": %.0f, \"cloud_ms_p95\": %.0f, \"nodes\": %zu, \"node_ms_p50\": "
        "%.1f, "
        "\"node_ms_p95\": %.0f",
        cloud_ms_.size(), percentile(cloud_ms_, 0.5), percentile(cloud_ms_, 0.95), node_ms_.size(),
        percentile(node_ms_, 0.5), percentile(node_ms_, 0.95));
  }

 private:
  void fragment(const Bytes& cdr) {
    const Header header = unpack(cdr);
    if (header.id < current_) return;
    if (header.id > current_) {
      current_ = header.id;
      missing_.clear();
      for (std::uint16_t i = 0; i < kFragments; ++i) missing_.insert(i);
    }
    last_ = bus_.now();
    if (missing_.erase(header.index) == 0 || !missing_.empty()) return;
    cloud_ms_.push_back(static_cast<double>(to_ns(bus_.now()) - header.stamp_ns) * 1e-6);
    answer();
  }
  void answer() {
    Bytes cdr = pack({0, current_, 0, static_cast<std::uint16_t>(missing_.size())}, 2 * missing_.size());
    std::size_t at = 4 + sizeof(Header);
    for (const std::uint16_t index : missing_) {
      std::memcpy(cdr.data() + at, &index, 2);
      at += 2;
    }
    bus_.publish(kAnswer, cdr);
  }

  Bus& bus_;
  std::uint32_t current_ = 0;
  std::set<std::uint16_t> missing_;
  Stamp last_;
  std::vector<double> cloud_ms_, node_ms_;
  std::vector<Handle> handles_;
};

class ShortSender {
 public:
  explicit ShortSender(Bus& bus) {
    handle_ = bus.subscribe(kRequest, [&bus](const Bytes& cdr) {
      const Header header = unpack(cdr);
      for (std::uint16_t i = 0; i < header.extra; ++i) {
        bus.publish(kChunk, pack({to_ns(bus.now()), header.id + i, 0, 0}, kChunkPayload));
      }
    });
  }
  void report() const { std::printf("\"window\": %u", kWindow); }

 private:
  Handle handle_;
};

class ShortReceiver {
 public:
  explicit ShortReceiver(Bus& bus) : bus_(bus) {
    handles_.push_back(bus.subscribe(kChunk, [this](const Bytes& cdr) { chunk(cdr); }));
    handles_.push_back(bus.every(500ms, [this] {
      if (bus_.now() - last_ > 2s) request(kWindow);  // the beginning, or a window was lost
    }));
    request(kWindow);
  }
  void report() const {
    const double seconds = to_seconds(last_ - first_);
    std::printf("\"chunks\": %zu, \"asked\": %u, \"goodput_mbit_s\": %.2f, \"chunk_ms_p50\": %.0f", chunks_,
                asked_, static_cast<double>(bytes_) * 8e-6 / seconds, percentile(chunk_ms_, 0.5));
  }

 private:
  void request(std::uint32_t count) {
    last_ = bus_.now();
    bus_.publish(kRequest, pack({0, asked_, 0, static_cast<std::uint16_t>(count)}, 0));
    asked_ += count;
  }
  void chunk(const Bytes& cdr) {
    last_ = bus_.now();
    if (chunks_++ == 0) first_ = last_;
    if (last_ > first_) bytes_ += kChunkPayload;
    chunk_ms_.push_back(static_cast<double>(to_ns(last_) - unpack(cdr).stamp_ns) * 1e-6);
    if (chunks_ % (kWindow / 4) == 0) request(kWindow / 4);
  }

  Bus& bus_;
  std::uint32_t asked_ = 0;
  std::size_t chunks_ = 0;
  std::size_t bytes_ = 0;
  Stamp first_, last_;
  std::vector<double> chunk_ms_;
  std::vector<Handle> handles_;
};

Options parse(int argc, char** argv) {
  Options options;
  std::map<std::string, std::string*> texts = {{"--iface", &options.iface},
                                               {"--address", &options.address},
                                               {"--peer", &options.peer},
                                               {"--qos", &options.qos}};
  if (argc > 1) options.role = argv[1];
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--seconds") options.seconds = std::stod(argv[i + 1]);
    if (name == "--bucket") options.bucket_kbit_s = std::stod(argv[i + 1]);
    if (const auto text = texts.find(name); text != texts.end()) *text->second = argv[i + 1];
  }
  return options;
}

/// `sent` and `heard` are the topics whose discovery is waited for; what it costs on the wire is counted.
template <class Role>
int measure(DdsBus& bus, const Options& options, const Topic& sent, const Topic& heard, auto make) {
  WireMeter wire(options.iface);
  const Handle sampling = bus.every(100ms, [&] { wire.sample(); });
  bus.advertise(sent);
  const Handle hearing = bus.subscribe(heard, [](const Bytes&) {});
  bus.run_until([&] { return bus.matches(sent).readers > 0 && bus.matches(heard).writers > 0; }, 30s);
  const Stamp end = bus.now() + from_seconds(options.seconds);
  Role role = make();
  bus.run_until([&] { return bus.now() >= end; }, from_seconds(options.seconds + 1.0));
  std::printf("{\"role\": \"%s\", ", options.role.c_str());
  role.report();
  std::uint64_t dropped = 0;
  for (const TopicStats& stats : bus.stats()) dropped += stats.dropped_messages;
  std::printf(", \"dropped\": %llu, \"wire_kbit_s\": %.1f, \"wire_peak_kbit_s\": %.0f}\n",
              static_cast<unsigned long long>(dropped), wire.mean_kbit_s(), wire.peak_kbit_s());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  DdsBusConfig config;
  config.agent = AgentId::parse("meter").value();
  config.qos_directory = options.qos;
  config.onboard.enabled = false;
  const bool long_range = options.role.starts_with("long");
  config.long_range.enabled = long_range;
  config.short_range.enabled = !long_range;
  for (DdsLinkConfig* radio : {&config.long_range, &config.short_range}) {
    radio->address = options.address;
    radio->peers = {options.peer};
    radio->queue_messages = 4096;
  }
  auto bus = DdsBus::create(config);
  if (!bus) {
    std::fprintf(stderr, "%s\n", bus.error().message.c_str());
    return 1;
  }
  DdsBus& made = **bus;
  if (options.role == "long-send") {
    made.advertise(kNode);
    return measure<LongSender>(made, options, kFragment, kAnswer, [&] { return LongSender(made, options); });
  }
  if (options.role == "long-receive") {
    return measure<LongReceiver>(made, options, kAnswer, kFragment, [&] { return LongReceiver(made); });
  }
  if (options.role == "short-send") {
    return measure<ShortSender>(made, options, kChunk, kRequest, [&] { return ShortSender(made); });
  }
  if (options.role == "short-receive") {
    return measure<ShortReceiver>(made, options, kRequest, kChunk, [&] { return ShortReceiver(made); });
  }
  std::fprintf(stderr, "usage: link_meter long-send|long-receive|short-send|short-receive --iface ...\n");
  return 2;
}
