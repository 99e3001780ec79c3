#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "fleetmap/cloud/las_format.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::cloud {

/// Writes a LAS file piece by piece, as a WholeFile.
class LasWriter {
 public:
  static Result<LasWriter> create(const std::filesystem::path& file,
                                  std::shared_ptr<const LasDescription> description);

  /// Points that are not finite, or too far from the offset, are left out and counted. After an error the
  /// file cannot be finished.
  Status add(std::span<const LasPoint> points);
  Status finish();
  std::uint64_t points() const { return totals_.points; }
  std::uint64_t left_out() const { return left_out_; }

 private:
  LasWriter(WholeFile file, std::shared_ptr<const LasDescription> description);

  WholeFile file_;
  std::shared_ptr<const LasDescription> description_;
  LasTotals totals_;
  std::uint64_t left_out_ = 0;
};

}  // namespace fleetmap::cloud
