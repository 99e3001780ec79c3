#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::messages {

/// Activity of a robot in a mission.
enum class MissionState : std::uint8_t {
  kDriving,     ///< drives rows, or is ready to
  kMeeting,     ///< waits where all meet; takes over rows if there are any
  kDone,        ///< its mission is over
  kStuck,       ///< can't get on; has given away its rows
  kLowBattery,  ///< drives home; has given away its rows
  kLost,        ///< only said of others: nothing was heard for long
  kCalledHome,  ///< an operator called it home; has given away its rows
};
const char* to_string(MissionState state);

/// A set of a mission's rows, counted in the mission's order: row k is bit k % 8 of byte k / 8.
class RowSet {
 public:
  RowSet() = default;
  explicit RowSet(std::size_t rows) : bytes_((rows + 7) / 8) {}
  /// As another robot sent it; it may be of another mission, with more or fewer rows.
  explicit RowSet(Bytes bytes) : bytes_(std::move(bytes)) {}
  /// For a mission of `rows` rows: what lies beyond is cut off, what is missing is not set.
  RowSet(std::size_t rows, const Bytes& bytes);

  bool has(std::size_t row) const {
    return row / 8 < bytes_.size() && (bytes_[row / 8] >> (row % 8) & 1) != 0;
  }
  void set(std::size_t row, bool value = true);
  RowSet& operator|=(const RowSet& other);
  RowSet& operator&=(const RowSet& other);
  bool none() const;
  std::size_t count() const;
  const Bytes& bytes() const { return bytes_; }
  bool operator==(const RowSet&) const = default;

 private:
  Bytes bytes_;
};

/// State of the mission as one robot has it, sent every few seconds over the long range; about 120 bytes for
/// 200 rows. A robot that was just restarted can continue from any one of them and the mission's file.
struct MissionReport {
  static constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

  AgentId from;
  Stamp stamp;  ///< of the sender's clock; orders its reports
  MissionState state = MissionState::kDriving;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< ENU, m
  double battery = 1.0;                                ///< share left, [0, 1]
  std::uint32_t current = kNoRow;                      ///< index of the row under way
  RowSet done;                                         ///< driven by any robot, by the sender's reports; for
                                                       ///< rows of other robots this is not evidence
  RowSet claimed;                                      ///< planned by the sender, the one under way included
  RowSet failed;                                       ///< the sender tried and gave up
};

}  // namespace fleetmap::messages
