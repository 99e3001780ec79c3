#include "fleetmap/recording/bag_writer.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "bag_metadata.hpp"
#include "fleetmap/core/paths.hpp"
#include "mcap_storage.hpp"
#include "offered_qos.hpp"
#include "ros_names.hpp"
#include "sqlite_storage.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFlushBytes = 4'000'000;
constexpr std::int64_t kFlushNs = 1'000'000'000;

constexpr const char* kEndings[] = {"_0.mcap", "_0.db3"};

}  // namespace

struct BagWriter::Impl {
  fs::path dir;
  std::unique_ptr<StorageFile> file;
  BagMetadata metadata;
  std::map<std::string, std::size_t, std::less<>> topics;  ///< places in metadata
  std::size_t pending_bytes = 0;
  std::optional<std::int64_t> pending_since;
  bool any = false;
  bool closed = false;

  Result<std::size_t> topic(std::string_view name, std::string_view type, Durability offered);
  Status flush();
  Status close();
};

Result<std::size_t> BagWriter::Impl::topic(std::string_view name, std::string_view type, Durability offered) {
  const std::string ros_name = ros_topic(name);
  if (const auto known = topics.find(ros_name); known != topics.end()) return known->second;
  const WrittenTopic added{ros_name, ros_type(type), offered_qos(offered)};
  if (auto status = file->add_topic(added); !status) return tl::unexpected(status.error());
  metadata.topics.push_back({added.name, added.type, 0, added.offered_qos});
  return topics.emplace(ros_name, metadata.topics.size() - 1).first->second;
}

Status BagWriter::Impl::flush() {
  pending_bytes = 0;
  pending_since.reset();
  return file->flush();
}

Status BagWriter::Impl::close() {
  if (closed) return {};
  closed = true;
  if (auto status = file->close(); !status) return status;
  return write_metadata(dir, metadata);
}

Result<BagWriter> BagWriter::create(const fs::path& dir, const BagFormat& format) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(dir, error);
  fs::create_directories(absolute, error);
  if (error) return failure(dir.string() + ": cannot be made: " + error.message());
  const std::string name = absolute.filename().string();
  const auto holds = [&](const char* ending) { return is_there(absolute / (name + ending)); };
  if (is_there(absolute / kMetadataFile) || std::ranges::any_of(kEndings, holds))
    return failure(dir.string() + ": holds a bag already; record to another folder");
  const bool mcap = format.storage == BagStorage::kMcap;
  const std::string file_name = name + kEndings[mcap ? 0 : 1];
  auto file = mcap ? create_mcap_storage(absolute / file_name, format.compression)
                   : create_sqlite_storage(absolute / file_name);
  if (!file) return tl::unexpected(file.error());
  auto impl = std::make_unique<Impl>();
  impl->dir = absolute;
  impl->file = std::move(*file);
  impl->metadata.storage = mcap ? "mcap" : "sqlite3";
  impl->metadata.files = {file_name};
  return BagWriter(std::move(impl));
}

BagWriter::BagWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BagWriter::BagWriter(BagWriter&&) noexcept = default;
BagWriter& BagWriter::operator=(BagWriter&& other) noexcept {
  std::swap(impl_, other.impl_);  // `other` closes the bag that this one wrote
  return *this;
}
BagWriter::~BagWriter() {
  if (!impl_) return;
  if (const auto status = impl_->close(); !status) spdlog::error("recording: {}", status.error().message);
}

Status BagWriter::write(std::string_view topic, std::string_view type, Stamp received, ByteView cdr,
                        Durability offered) {
  if (impl_->closed) return failure(impl_->dir.string() + ": the bag is closed");
  const auto place = impl_->topic(topic, type, offered);
  if (!place) return tl::unexpected(place.error());
  const std::int64_t ns = to_ns(received);
  if (auto status = impl_->file->write(*place, ns, cdr); !status) return status;
  BagMetadata& metadata = impl_->metadata;
  ++metadata.topics[*place].messages;
  metadata.first_ns = impl_->any ? std::min(metadata.first_ns, ns) : ns;
  metadata.last_ns = impl_->any ? std::max(metadata.last_ns, ns) : ns;
  impl_->any = true;
  impl_->pending_bytes += cdr.size();
  if (!impl_->pending_since) impl_->pending_since = ns;
  if (impl_->pending_bytes >= kFlushBytes || ns - *impl_->pending_since >= kFlushNs) return impl_->flush();
  return {};
}

Status BagWriter::flush() {
  if (impl_->closed) return {};
  return impl_->flush();
}

Status BagWriter::close() { return impl_->close(); }

}  // namespace fleetmap::recording
