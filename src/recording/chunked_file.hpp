#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bag_file.hpp"

namespace fleetmap::recording {

/// A file whose messages lie in chunks, or singly, in the order in which they were written. Gives them by the
/// time of reception, without holding more than the chunks that overlap in time.
class ChunkedFile : public BagFile {
 public:
  Result<std::vector<BagTopic>> topics() override;
  Result<std::optional<BagMessage>> next() override;
  std::uint64_t damaged_parts() const override { return damaged_ + (cut_.empty() ? 0 : 1); }
  std::string damage() const override;

 protected:
  static constexpr std::uint64_t kMaxRecordBytes = 256u << 20;  ///< writers make chunks of some MB

  /// A chunk or message that was found and not read yet.
  struct Found {
    std::uint64_t at = 0;      ///< where it begins in the file
    std::uint64_t length = 0;  ///< bytes
    std::uint64_t start = 0;   ///< ns since the Unix epoch, no message in it is earlier
    bool chunk = false;
  };

  ChunkedFile(std::filesystem::path file, std::ifstream stream, std::uint64_t size)
      : file_(std::move(file)), stream_(std::move(stream)), size_(size) {}

  /// Reads what was found and gives its messages to hold(). Damage is left out; an error means that the file
  /// cannot be read at all.
  virtual Status load(const Found& found) = 0;
  /// Whether all topics are named outside of the messages; else all of these are loaded for topics().
  virtual bool topics_are_named() = 0;
  /// A message as CDR; valid until the next call.
  virtual ByteView cdr_of(const BagTopic& topic, ByteView data) = 0;

  /// Everything was found.
  void sort_found();
  /// Names what hold() will be given.
  void name_topic(std::uint32_t connection, BagTopic topic);
  const std::map<std::uint32_t, BagTopic>& named() const { return topics_; }
  /// Bytes for hold(), which count as long as a message needs them.
  std::shared_ptr<const Bytes> block_of(Bytes bytes);
  void hold(std::shared_ptr<const Bytes> block, std::uint64_t time, std::uint32_t connection, ByteView data);
  Result<Bytes> read(std::uint64_t at, std::uint64_t count);
  /// Counts a damaged part, and keeps the cause of the first.
  void leave_out(const std::string& why);
  /// Counts and keeps that the file ends within a record that begins at a byte, or before its last one.
  void note_cut(std::uint64_t at, const char* remedy);

  const std::filesystem::path& file() const { return file_; }
  std::uint64_t size() const { return size_; }
  std::vector<Found> found_;

 private:
  /// A message that waits for its turn; its bytes are part of what `block` holds.
  struct Held {
    std::shared_ptr<const Bytes> block;
    std::uint32_t connection = 0;
    ByteView data;
  };

  Status load_once();

  std::filesystem::path file_;
  std::ifstream stream_;
  std::uint64_t size_;
  std::map<std::uint32_t, BagTopic> topics_;  ///< by connection
  std::size_t next_ = 0;                      ///< of found_
  std::size_t block_bytes_ = 0;               ///< of all blocks that are held
  std::multimap<std::uint64_t, Held> held_;   ///< by time
  Held current_;
  std::uint64_t damaged_ = 0;
  std::string first_damage_;
  std::string cut_;  ///< the cut and its remedy
};

}  // namespace fleetmap::recording
