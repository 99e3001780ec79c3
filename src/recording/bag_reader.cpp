#include "bag_reader.hpp"

#include <algorithm>
#include <set>

#include "bag_file.hpp"
#include "bag_metadata.hpp"
#include "bag_topics.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/points_type.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
#include "fleetmap/sensor/lidar_frames.hpp"
#include "packet_reader.hpp"
#include "unpack.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMessageBytes = 256u << 20;

/// "bag_10.db3" comes after "bag_9.db3".
bool splits_in_order(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& path) {
    return std::make_pair(path.filename().string().size(), path.filename());
  };
  return key(a) < key(b);
}

std::vector<fs::path> files_with(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().ends_with(ending)) files.push_back(entry.path());
  }
  std::ranges::sort(files, splits_in_order);
  return files;
}

/// The files of a bag, in order of time.
Result<std::vector<fs::path>> bag_files(const fs::path& path) {
  const std::string bag = path.string();
  if (!is_folder(path)) return std::vector<fs::path>{path};
  std::vector<fs::path> files;
  if (is_there(path / kMetadataFile)) {
    const auto metadata = read_metadata(path);
    if (!metadata) return tl::unexpected(metadata.error());
    if (metadata->storage != "sqlite3" && metadata->storage != "mcap")
      return failure(bag + ": storage '" + metadata->storage + "' is not read here; sqlite3 and mcap are");
    for (const std::string& name : metadata->files) {
      const fs::path file = path / fs::path(name).filename();
      // One that was unpacked by hand is taken as it is.
      const bool unpacked = file.extension() == ".zstd" && is_there(path / file.stem());
      files.push_back(unpacked ? path / file.stem() : file);
    }
  }
  for (const char* ending : {".db3", ".mcap", ".db3.zstd", ".mcap.zstd", ".bag"}) {
    if (files.empty()) files = files_with(path, ending);
  }
  if (files.empty()) return failure(bag + ": has no .db3, .mcap or .bag file");
  for (const fs::path& file : files) {
    if (!is_there(file)) return failure(file.string() + ": is named in metadata.yaml but is not there");
  }
  return files;
}

class BagReader : public PacketReader {
 public:
  BagReader(std::string source, std::vector<fs::path> files, std::map<std::string, Kind> kinds,
            ScanContent content)
      : PacketReader(std::move(source), content), files_(std::move(files)), kinds_(std::move(kinds)) {}

  Result<std::optional<Sample>> next() override {
    while (true) {
      if (auto scan = next_scan()) {
        recorded_ = scan->recorded;
        return Sample(std::move(scan->scan));
      }
      if (ended_) return std::optional<Sample>();
      recorded_.reset();
      auto sample = advance();
      if (!sample) ended_ = true;
      if (!sample || *sample) return sample;
    }
  }
  std::optional<Stamp> recorded() const override { return recorded_; }
  const sensor::SensorFrames& frames() const override { return frames_; }

 private:
  /// Advances by one message; empty when it yields no sample.
  Result<std::optional<Sample>> advance() {
    if (!file_) {
      if (next_file_ == files_.size()) {
        ended_ = true;
        finish_packets();
        return std::optional<Sample>();
      }
      auto file = open_bag_file(files_[next_file_++]);
      if (!file) return tl::unexpected(file.error());
      // The record that names a topic may lie behind a message of it.
      if (const auto topics = (*file)->topics(); !topics) return tl::unexpected(topics.error());
      file_ = std::move(*file);
    }
    const auto message = file_->next();
    if (message && *message) return sample_in(**message);
    count_damage();
    if (!message) return tl::unexpected(message.error());
    file_.reset();
    return std::optional<Sample>();
  }

  void count_damage() {
    if (file_->damaged_parts() == 0) return;
    counters_.damaged_parts += file_->damaged_parts();
    warn(file_->damage());
  }

  Result<std::optional<Sample>> sample_in(const BagMessage& message) {
    const auto kind = kinds_.find(message.topic);
    if (kind == kinds_.end()) return std::optional<Sample>();
    std::optional<Sample> sample;
    if (is_zstd(message.cdr)) {  // no CDR begins so
      const auto cdr = unpack_zstd(message.cdr, kMaxMessageBytes);
      sample = cdr ? decode(kind->second, *cdr, message) : undecodable(message.topic, cdr.error());
    } else {
      sample = decode(kind->second, message.cdr, message);
    }
    if (!sample) return std::optional<Sample>();
    if (to_ns(stamp_of(*sample)) == 0 && message.received_ns > 1'000'000'000)
      restamp(*sample, message.received_ns, message.topic);
    if (!admit(*sample)) return std::optional<Sample>();
    recorded_ = stamp_from_ns(message.received_ns);
    return sample;
  }

  std::optional<Sample> decode(Kind kind, ByteView cdr, const BagMessage& message) {
    const std::string& topic = message.topic;
    switch (kind) {
      case Kind::kPackets:
        add_packets(cdr, message);
        return std::nullopt;  // a message ends within a turn; next_scan() returns those that are complete
      case Kind::kScan:
      case Kind::kLivox: {
        note_frame(sensor::Source::kLidar, cdr);
        const auto type =
            kind == Kind::kLivox ? ros_codec::PointsType::kLivoxDriver2 : ros_codec::PointsType::kPointCloud2;
        if (stamps_only()) {
          const auto stamp = ros_codec::stamp_of_points(cdr, type);
          if (!stamp) return undecodable(topic, stamp.error());
          sensor::Scan scan;
          scan.stamp = *stamp;
          return Sample(std::move(scan));
        }
        auto decoded = ros_codec::decode_points(cdr, type);
        if (!decoded) return undecodable(topic, decoded.error());
        if (!admit_points(*decoded, "a scan on " + topic)) return std::nullopt;
        return Sample(std::move(decoded->scan));
      }
      case Kind::kImu:
        return sample_of<sensor::Imu>(cdr, topic, sensor::Source::kImu);
      case Kind::kFix:
        return sample_of<sensor::Fix>(cdr, topic, sensor::Source::kGps);
      case Kind::kTransforms:
        add_transforms(cdr, topic);
        return std::nullopt;
      default:
        return sample_of<sensor::Wheel>(cdr, topic, sensor::Source::kWheel);
    }
  }

  void add_packets(ByteView cdr, const BagMessage& message) {
    const auto decoded = ros_codec::decode_velodyne_scan(cdr);
    if (!decoded) return void(undecodable(message.topic, decoded.error()));
    note_frame(sensor::Source::kLidar, cdr);
    const Stamp recorded = stamp_from_ns(message.received_ns);
    for (const auto& packet : decoded->packets) {
      Stamp arrival = packet.received;
      if (to_ns(arrival) == 0) {
        arrival = recorded;
        skip(&Counters::unstamped_messages,
             message.topic + ": a packet has no stamp; the time of recording is taken instead");
      }
      add_packet(packet.data, arrival, recorded);
    }
  }

  template <class T>
  std::optional<Sample> sample_of(ByteView cdr, const std::string& topic, sensor::Source source) {
    note_frame(source, cdr);
    auto decoded = ros_codec::decode<T>(cdr);
    if (!decoded) return undecodable(topic, decoded.error());
    return Sample(std::move(*decoded));
  }

  void note_frame(sensor::Source source, ByteView cdr) {
    std::string& id = frames_.ids[static_cast<std::size_t>(source)];
    if (!id.empty() && source != sensor::Source::kLidar) return;
    const std::string named = ros_codec::frame_id_of(cdr).value_or(std::string());
    if (id.empty()) id = named;
    if (source != sensor::Source::kLidar) return;
    if (const auto finding = lidar_frames_.add(named)) {
      warn(*finding);
      add_finding(*finding);
    }
  }

  void add_transforms(ByteView cdr, const std::string& topic) {
    const auto transforms = ros_codec::decode_transforms(cdr);
    if (!transforms) return void(undecodable(topic, transforms.error()));
    frames_.add(*transforms);
  }

  std::optional<Sample> undecodable(const std::string& topic, const Error& error) {
    skip(&Counters::undecodable_messages, topic + ": " + error.message);
    return std::nullopt;
  }

  void restamp(Sample& sample, std::int64_t received_ns, const std::string& topic) {
    std::visit([&](auto& s) { s.stamp = stamp_from_ns(received_ns); }, sample);
    skip(&Counters::unstamped_messages,
         topic + ": header stamp is 0; the time of recording is taken instead");
  }

  std::vector<fs::path> files_;
  std::map<std::string, Kind> kinds_;
  std::size_t next_file_ = 0;
  std::unique_ptr<BagFile> file_;
  bool ended_ = false;
  std::optional<Stamp> recorded_;
  sensor::SensorFrames frames_;
  sensor::LidarFrames lidar_frames_;
};

}  // namespace

bool is_bag(const fs::path& path) {
  const auto has_ending = [](const fs::path& file) {
    const fs::path name = file.extension() == ".zstd" ? file.stem() : file.filename();
    return name.extension() == ".db3" || name.extension() == ".mcap" || file.extension() == ".bag";
  };
  if (!is_folder(path)) return has_ending(path);
  std::error_code error;
  return is_there(path / kMetadataFile) ||
         std::any_of(fs::directory_iterator(path, error), fs::directory_iterator(),
                     [&](const auto& entry) { return has_ending(entry.path()); });
}

Result<std::unique_ptr<Reader>> open_bag(const fs::path& path, const ReaderConfig& config,
                                         ScanContent content) {
  auto files = bag_files(path);
  if (!files) return tl::unexpected(files.error());
  std::set<BagTopic> topics;  // a later split may bring topics that the first one lacks
  for (const fs::path& name : *files) {
    const auto file = open_bag_file(name);
    if (!file) return tl::unexpected(file.error());
    const auto found = (*file)->topics();
    if (!found) return tl::unexpected(found.error());
    topics.insert(found->begin(), found->end());
  }
  auto kinds =
      select_topics({topics.begin(), topics.end()}, config.topics, path.string(), config.scans_needed);
  if (!kinds) return tl::unexpected(kinds.error());
  return std::make_unique<BagReader>(path.string(), std::move(*files), std::move(*kinds), content);
}

}  // namespace fleetmap::recording
