#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "fleetmap/core/bytes.hpp"

/// Bytes of LAS 1.4, point data record format 6 ("LAS Specification 1.4 - R15", ASPRS 2019): the format in
/// which surveyors and geographic programs exchange point clouds.
namespace fleetmap::cloud {

/// m, of a stored coordinate, which is a whole number of these from the offset.
inline constexpr double kLasStep = 0.001;
inline constexpr std::size_t kLasRecordSize = 30;  ///< bytes of a point

/// Contents of a file's header besides the sums over its points.
struct LasDescription {
  std::string wkt;                         ///< coordinate reference system, OGC 01-009
  std::string text;                        ///< the same for people: text area description
  std::string software;                    ///< the first 32 characters are written
  std::array<std::uint8_t, 16> project{};  ///< GUID, the same in all files of one map
  std::uint16_t day_of_year = 0;           ///< of creation, UTC, from 1; 0: not given
  std::uint16_t year = 0;                  ///< 0: not given
  Eigen::Vector3i offset = {0, 0, 0};      ///< m
};

/// A point as LAS stores it, in the file's coordinate reference system.
struct LasPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, in the file's reference system
  std::uint16_t intensity = 0;                         ///< over the whole range of 16 bits
  std::uint16_t source = 0;                            ///< point source ID; 0: this file
};

/// A position in steps from the offset. Empty where it is not finite, or too far away for 32 bits (2147 km).
std::optional<Eigen::Vector3i> las_steps(const Eigen::Vector3d& position, const Eigen::Vector3i& offset);

/// Sums over the points of a file, for its header.
struct LasTotals {
  std::uint64_t points = 0;
  Eigen::Vector3i min = {0, 0, 0};  ///< steps; of no points zero
  Eigen::Vector3i max = {0, 0, 0};

  void add(const Eigen::Vector3i& steps);
};

/// Header and variable length records: all that stands before the first point. Its length does not depend on
/// `totals`. wkt and text are cut after 65,534 bytes.
Bytes las_header(const LasDescription& description, const LasTotals& totals);

/// Appends the record of a point: one return of one, never classified, without a time.
void append_las_record(Bytes& records, const Eigen::Vector3i& steps, const LasPoint& point);

}  // namespace fleetmap::cloud
