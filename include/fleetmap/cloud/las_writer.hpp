#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "fleetmap/cloud/las_format.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Writes a LAS file piece by piece. The file appears whole with finish(), or not at all; until then its
/// bytes are in FILE.part beside it, which is open only while something is written: a map may be divided into
/// more files than a process may have open. Errors name the file and the cause.
class LasWriter {
 public:
  /// Replaces a FILE.part that is there.
  static Result<LasWriter> create(const std::filesystem::path& file,
                                  std::shared_ptr<const LasDescription> description);
  LasWriter(LasWriter&& other) noexcept;
  ~LasWriter();

  /// Points that are not finite, or too far from the offset, are left out and counted. After an error the
  /// file cannot be finished.
  Status add(std::span<const LasPoint> points);
  Status finish();
  std::uint64_t points() const { return totals_.points; }
  std::uint64_t left_out() const { return left_out_; }

 private:
  LasWriter(std::filesystem::path file, std::shared_ptr<const LasDescription> description);
  std::filesystem::path part() const { return file_.string() + ".part"; }
  Status failed(int error);
  Status write(const char* mode, ByteView bytes, bool durable);

  std::filesystem::path file_;
  std::shared_ptr<const LasDescription> description_;
  LasTotals totals_;
  std::uint64_t left_out_ = 0;
  bool unfinished_ = false;  ///< there is a part
  bool damaged_ = false;     ///< and it lacks points
};

}  // namespace fleetmap::cloud
