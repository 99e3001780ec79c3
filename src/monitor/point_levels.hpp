#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"

namespace fleetmap::monitor {

/// Indices of all points, coarse before fine: the first ones are one point of each voxel of a coarse grid,
/// then of grids of half the edge, and so on. Any prefix therefore is a thinned cloud that covers the whole.
/// The same cloud gives the same order. Points that are not finite are left out.
std::vector<std::uint32_t> coarse_to_fine(const cloud::PointCloud& cloud);

/// A submap as the page draws it, in the node's frame.
///
/// Points are 16-bit steps of `scale` around `centre`: 8 bytes each (x, y, z, intensity), so that a graphics
/// card takes them as they are. The error per axis is at most scale / 2.
struct QuantisedCloud {
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< m
  float scale = 1.0f;                                ///< m per step
  std::vector<std::int16_t> values;                  ///< 4 a point, coarse to fine
  std::size_t whole = 0;                             ///< points of the submap; these are its first ones

  std::size_t size() const { return values.size() / 4; }
};
QuantisedCloud quantised(const cloud::PointCloud& cloud);
/// prefix_of() it, in less time.
QuantisedCloud quantised_prefix(const cloud::PointCloud& cloud, std::size_t points);
/// The first points of a cloud, as many as there are.
QuantisedCloud prefix_of(const QuantisedCloud& cloud, std::size_t points);

/// Bytes of points [from, from + count) for the page, little-endian: "FMP1", centre (3 float), scale (float),
/// points of the whole submap (uint32), `from` (uint32), points here (uint32), reserved (uint32), then the
/// points.
Bytes encoded_points(const QuantisedCloud& cloud, std::size_t from, std::size_t count);
inline constexpr std::size_t kPointHeaderBytes = 36;
/// The cloud of which encoded_points() made the front of `bytes`, from its first point on. Nothing where they
/// are cut short or no such points.
std::optional<QuantisedCloud> decoded_points(ByteView bytes);

}  // namespace fleetmap::monitor
