#include "bag_reader.hpp"

#include <algorithm>
#include <set>

#include "bag_metadata.hpp"
#include "bag_topics.hpp"
#include "checked_reader.hpp"
#include "database.hpp"
#include "ros_names.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kZstdMagic[] = {0x28, 0xb5, 0x2f, 0xfd};

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

Error compressed(const std::string& bag) {
  return Error{bag +
               ": the bag is zstd-compressed, which is not read here; unpack it with `ros2 bag convert`, or "
               "its files with `zstd -d *.db3.zstd` if they are compressed as a whole"};
}

Error mcap(const std::string& bag) {
  return Error{
      bag + ": mcap storage is not read here; convert the bag with `ros2 bag convert` to storage_id sqlite3"};
}

/// The database files of a bag, in order of time.
Result<std::vector<fs::path>> bag_files(const fs::path& path) {
  const std::string bag = path.string();
  if (bag.ends_with(".mcap")) return tl::unexpected(mcap(bag));
  if (bag.ends_with(".zstd")) return tl::unexpected(compressed(bag));
  if (!fs::is_directory(path)) return std::vector<fs::path>{path};
  std::vector<fs::path> files = files_with(path, ".db3");
  if (fs::exists(path / kMetadataFile)) {
    const auto metadata = read_metadata(path);
    if (!metadata) return tl::unexpected(metadata.error());
    if (metadata->storage == "mcap") return tl::unexpected(mcap(bag));
    if (metadata->storage != "sqlite3") {
      return failure(bag + ": storage '" + metadata->storage + "' is not read here; only sqlite3 is");
    }
    // Files that were unpacked by hand are taken as they are.
    if (metadata->compression_mode == "MESSAGE" || metadata->compression_mode == "message") {
      return tl::unexpected(compressed(bag));
    }
    if (metadata->compression_format.empty() && !metadata->files.empty()) {
      files.clear();
      for (const std::string& file : metadata->files) files.push_back(path / fs::path(file).filename());
    }
  }
  if (files.empty() && !files_with(path, ".zstd").empty()) return tl::unexpected(compressed(bag));
  if (files.empty() && !files_with(path, ".mcap").empty()) return tl::unexpected(mcap(bag));
  if (files.empty()) return failure(bag + ": has no .db3 file");
  for (const fs::path& file : files) {
    if (!fs::exists(file)) return failure(file.string() + ": is named in metadata.yaml but is not there");
  }
  return files;
}

Result<std::vector<BagTopic>> topics_in(const Database& database) {
  auto query = database.prepare("SELECT name, type FROM topics");
  if (!query) return tl::unexpected(query.error());
  std::vector<BagTopic> topics;
  int code = query->step();
  for (; code == SQLITE_ROW; code = query->step())
    topics.push_back({query->text(0), ros_type(query->text(1))});
  if (code != SQLITE_DONE) return tl::unexpected(database.error("read topics"));
  return topics;
}

/// One open split. The order is read as ids only, so that sorting never holds messages.
struct Split {
  Database database;
  Statement order;
  Statement fetch;
  std::map<std::int64_t, std::string> topics;  ///< by id
};

Result<Split> open_split(const fs::path& file) {
  auto database = Database::open_for_reading(file);
  if (!database) return tl::unexpected(database.error());
  auto order = database->prepare("SELECT id FROM messages ORDER BY timestamp, id");
  if (!order) return tl::unexpected(order.error());
  auto fetch = database->prepare("SELECT topic_id, timestamp, data FROM messages WHERE id = ?");
  if (!fetch) return tl::unexpected(fetch.error());
  auto query = database->prepare("SELECT id, name FROM topics");
  if (!query) return tl::unexpected(query.error());
  std::map<std::int64_t, std::string> topics;
  while (query->step() == SQLITE_ROW) topics.emplace(query->integer(0), query->text(1));
  return Split{std::move(*database), std::move(*order), std::move(*fetch), std::move(topics)};
}

class BagReader : public CheckedReader {
 public:
  BagReader(std::string source, std::vector<fs::path> files, std::map<std::string, Kind> kinds,
            ScanContent content)
      : CheckedReader(std::move(source)),
        files_(std::move(files)),
        kinds_(std::move(kinds)),
        content_(content) {}

  Result<std::optional<Sample>> next() override {
    while (!ended_) {
      recorded_.reset();
      auto sample = advance();
      if (!sample) ended_ = true;
      if (!sample || *sample) return sample;
    }
    return std::optional<Sample>();
  }
  std::optional<Stamp> recorded() const override { return recorded_; }

 private:
  /// Advances by one message; empty when it yields no sample.
  Result<std::optional<Sample>> advance() {
    if (!split_) {
      if (next_file_ == files_.size()) {
        ended_ = true;
        return std::optional<Sample>();
      }
      auto split = open_split(files_[next_file_++]);
      if (!split) return tl::unexpected(split.error());
      split_.emplace(std::move(*split));
    }
    const int code = split_->order.step();
    if (code == SQLITE_DONE) {
      split_.reset();
      return std::optional<Sample>();
    }
    if (code != SQLITE_ROW) return tl::unexpected(split_->database.error("read on after " + given()));
    return fetch(split_->order.integer(0));
  }

  Result<std::optional<Sample>> fetch(std::int64_t id) {
    Statement& row = split_->fetch;
    row.reset();
    row.bind(1, id);
    const int code = row.step();
    if (code == SQLITE_DONE) return std::optional<Sample>();
    if (code != SQLITE_ROW) return tl::unexpected(split_->database.error("read on after " + given()));
    const auto topic = split_->topics.find(row.integer(0));
    if (topic == split_->topics.end()) return std::optional<Sample>();
    const auto kind = kinds_.find(topic->second);
    if (kind == kinds_.end()) return std::optional<Sample>();
    const ByteView cdr = row.blob(2);
    if (cdr.size() >= 4 && std::equal(std::begin(kZstdMagic), std::end(kZstdMagic), cdr.begin())) {
      return tl::unexpected(compressed(source()));
    }
    auto sample = decode(kind->second, cdr, topic->second);
    if (!sample) return std::optional<Sample>();
    if (to_ns(stamp_of(*sample)) == 0 && row.integer(1) > 1'000'000'000)
      restamp(*sample, row.integer(1), topic->second);
    if (!admit(*sample)) return std::optional<Sample>();
    recorded_ = stamp_from_ns(row.integer(1));
    return sample;
  }

  std::optional<Sample> decode(Kind kind, ByteView cdr, const std::string& topic) {
    switch (kind) {
      case Kind::kScan: {
        if (content_ == ScanContent::kStampOnly) {
          const auto stamp = ros_codec::stamp_of_scan(cdr);
          if (!stamp) return undecodable(topic, stamp.error());
          sensor::Scan scan;
          scan.stamp = *stamp;
          return Sample(std::move(scan));
        }
        auto decoded = ros_codec::decode_scan(cdr);
        if (!decoded) return undecodable(topic, decoded.error());
        if (!admit_points(*decoded, "a scan on " + topic)) return std::nullopt;
        return Sample(std::move(decoded->scan));
      }
      case Kind::kImu:
        return sample_of<sensor::Imu>(cdr, topic);
      case Kind::kFix:
        return sample_of<sensor::Fix>(cdr, topic);
      default:
        return sample_of<sensor::Wheel>(cdr, topic);
    }
  }

  template <class T>
  std::optional<Sample> sample_of(ByteView cdr, const std::string& topic) {
    auto decoded = ros_codec::decode<T>(cdr);
    if (!decoded) return undecodable(topic, decoded.error());
    return Sample(std::move(*decoded));
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

  std::string given() const {
    return std::to_string(counters_.scans + counters_.imus + counters_.fixes + counters_.wheels) + " samples";
  }

  std::vector<fs::path> files_;
  std::map<std::string, Kind> kinds_;
  ScanContent content_;
  std::size_t next_file_ = 0;
  std::optional<Split> split_;
  bool ended_ = false;
  std::optional<Stamp> recorded_;
};

}  // namespace

bool looks_like_bag(const fs::path& path) {
  if (fs::is_directory(path)) {
    return fs::exists(path / kMetadataFile) || !files_with(path, ".db3").empty() ||
           !files_with(path, ".db3.zstd").empty() || !files_with(path, ".mcap").empty();
  }
  const std::string name = path.filename().string();
  return name.ends_with(".db3") || name.ends_with(".db3.zstd") || name.ends_with(".mcap");
}

Result<std::unique_ptr<Reader>> open_bag(const fs::path& path, const Topics& wanted, ScanContent content) {
  auto files = bag_files(path);
  if (!files) return tl::unexpected(files.error());
  std::set<BagTopic> topics;  // a later split may bring topics that the first one lacks
  for (const fs::path& file : *files) {
    const auto database = Database::open_for_reading(file);
    if (!database) return tl::unexpected(database.error());
    const auto found = topics_in(*database);
    if (!found) return tl::unexpected(found.error());
    topics.insert(found->begin(), found->end());
  }
  auto kinds = select_topics({topics.begin(), topics.end()}, wanted, path.string());
  if (!kinds) return tl::unexpected(kinds.error());
  return std::make_unique<BagReader>(path.string(), std::move(*files), std::move(*kinds), content);
}

}  // namespace fleetmap::recording
