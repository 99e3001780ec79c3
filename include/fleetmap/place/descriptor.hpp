#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::place {

/// A bird's-eye grid of the surroundings of a node, for place recognition without GPS: a square of 28 x 28
/// cells of 2.5 m around it, along base_link's heading and level; each cell is unseen, ground, low (0.5 m
/// above the ground around it) or high (1.5 m). It follows Scan Context (Kim and Kim, IROS 2018), but is
/// Cartesian, so that it can be shifted as well as turned, because two robots never stop at exactly the same
/// position.
class Descriptor {
 public:
  static constexpr int kCells = 28;           ///< along each side
  static constexpr double kCell = 2.5;        ///< m
  static constexpr std::size_t kBytes = 196;  ///< of encode(): two bits a cell

  /// Nothing observed.
  Descriptor() = default;
  /// From points in base_link and the direction against gravity in it (any length; z where it is not finite
  /// or zero). The points may be of any density, from one scan or many; those farther than 35 m along an axis
  /// and non-finite ones are left out.
  static Descriptor of(std::span<const Eigen::Vector3f> points_in_base, const Eigen::Vector3d& up_in_base);

  Bytes encode() const;
  /// Fails unless there are kBytes bytes with cells that encode() can have written.
  static Result<Descriptor> decode(ByteView bytes);

  /// Cells observed, and of these those with anything on the ground.
  int observed() const;
  int occupied() const;
  bool operator==(const Descriptor&) const = default;

 private:
  friend class DescriptorQuery;
  using Rows =
      std::array<std::uint32_t, kCells>;  ///< bit x of row y: the cell at ((x, y) - 14 + 1/2) * kCell
  Rows observed_{};
  Rows low_{};   ///< at least low
  Rows high_{};  ///< high
};

/// The best fit of two descriptors.
struct DescriptorMatch {
  /// [0, 1]: correlation of the heights over the cells that both have observed, less for a small overlap. In
  /// a repeating scene (rows of panels) unrelated places are similar, so a match is only a candidate.
  double similarity = 0.0;
  double yaw = 0.0;                                       ///< rad, of b as observed from a, both level
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();  ///< m, of b in a's level frame
  int overlap = 0;                                        ///< cells that both have observed
};

/// A descriptor made ready to be compared with many: turned by every yaw once (5 deg apart).
class DescriptorQuery {
 public:
  static constexpr int kYaws = 72;
  static constexpr int kShifts = 4;  ///< cells along each axis to either side that are tried: 10 m

  explicit DescriptorQuery(const Descriptor& b);
  /// The best of all turns and shifts of b against `a`. Similarity 0 where they have too little in common.
  DescriptorMatch compare(const Descriptor& a) const;

 private:
  /// Rows two by two in one word; the second set is offset by one row.
  static constexpr int kWords = Descriptor::kCells / 2;
  using Words = std::array<std::uint64_t, kWords + 1>;
  struct Turned {
    std::array<Words, 2> observed{}, low{}, high{};
  };
  std::array<Turned, kYaws> turned_;
};

/// DescriptorMatch of b as observed from a; one comparison by itself.
DescriptorMatch compare(const Descriptor& a, const Descriptor& b);

/// T_a_b (base_link of b in that of a) of the match, from each one's direction against gravity; the heights
/// are taken to be equal.
Pose relative_pose(const DescriptorMatch& match, const Eigen::Vector3d& up_in_a,
                   const Eigen::Vector3d& up_in_b);

}  // namespace fleetmap::place
