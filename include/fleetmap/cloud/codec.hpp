#pragma once

#include <cstddef>

#include "fleetmap/cloud/codec_config.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

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

/// Decodes a cloud. Truncated, damaged or hostile bytes fail; memory stays within the need of `max_points`
/// points.
Result<PointCloud> decode(ByteView bytes, std::size_t max_points = kMaxEncodedPoints);

}  // namespace fleetmap::cloud
