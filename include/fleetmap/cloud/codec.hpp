#pragma once

#include <cstddef>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

struct CodecConfig {
  double resolution_m =
      0.01;  ///< m, grid that coordinates are rounded to: the error per axis is at most half of it
  bool encode_intensities = true;  ///< as 8 bits over their range, where the cloud has them
  Status validate() const;
};

/// Most points that one encoded cloud may hold; decode refuses more before it allocates anything for them.
inline constexpr std::size_t kMaxEncodedPoints = std::size_t{1} << 22;

/// Most points that an encoding of `bytes` may hold. Clouds of a LiDAR take a byte or two a point; a header
/// that claims more would cost memory and time that its bytes do not pay for.
constexpr std::size_t max_points_in(std::size_t bytes) {
  const std::size_t points = 8 * bytes < 65'536 ? 65'536 : 8 * bytes;
  return points < kMaxEncodedPoints ? points : kMaxEncodedPoints;
}

/// Compresses a cloud (Draco's k-d tree coding of our own integer grid). The same cloud gives the same bytes.
/// Points come back in another order; none is lost or joined. Fails on non-finite points, more than
/// kMaxEncodedPoints or than max_points_in() its encoding, or an extent of more than 2^30 grid steps.
Result<Bytes> encode(const PointCloud& cloud, const CodecConfig& config);

/// The cloud that `bytes` hold. Truncated, damaged or hostile bytes give an Error; memory stays within what
/// `max_points` points need.
Result<PointCloud> decode(ByteView bytes, std::size_t max_points = kMaxEncodedPoints);

struct FitConfig {
  std::size_t max_bytes = 25'000;      ///< of the whole encoding (paper: 25 kB on the long-range link)
  float min_voxel_m = 0.05f;           ///< m, finest voxel tried
  float max_voxel_m = 20.0f;           ///< m, coarsest voxel tried
  double voxel_over_resolution = 6.0;  ///< the codec's resolution is the voxel's edge divided by this
  bool encode_intensities = false;
  int max_encodings = 8;  ///< bound on the search
  Status validate() const;
};

/// A cloud thinned until its encoding fits a byte budget.
struct FittedCloud {
  Bytes bytes;
  PointCloud decoded;       ///< what every receiver of `bytes` sees
  float voxel_m = 0.0f;     ///< m, of the thinning
  double resolution_m = 0;  ///< m, of the coding
  int encodings = 0;        ///< how many were tried
};

/// The finest voxel grid (centroids) whose encoding fits `max_bytes`, found to within a few per cent of the
/// budget. Fails on non-finite points and where even `max_voxel_m` does not fit.
Result<FittedCloud> encode_within(const PointCloud& cloud, const FitConfig& config);

}  // namespace fleetmap::cloud
