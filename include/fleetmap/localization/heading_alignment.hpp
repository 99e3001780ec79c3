#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace fleetmap::localization {

/// Finds the heading from motion: fits the dead-reckoned track (heading counted from an arbitrary start) onto
/// the GPS track of the last few dozen metres. Works on curves as on straights; needs the track to be longer
/// than the GPS is wrong.
class HeadingAlignment {
 public:
  struct Estimate {
    double yaw_offset = 0.0;  ///< rad, to be added to the dead-reckoned yaw
    double sigma =
        0.0;  ///< rad; conservative: takes GPS errors at both ends as unrelated, all others as slow
  };

  /// Robot moved `distance` (m, signed) ahead while its dead-reckoned yaw was `yaw`.
  void advance(double distance, double yaw);
  /// A fix of the antenna in ENU with its standard deviation, and the antenna's horizontal offset in the
  /// dead-reckoned frame. Returns true if the fix extended the track (and so the estimate may be new).
  bool add_fix(const Eigen::Vector2d& p_enu, double sigma, const Eigen::Vector2d& antenna_offset);
  /// The same where nothing measures distance: the fixes' own displacement counts as driven straight ahead
  /// along `yaw`. A robot that reverses then gets its heading wrong by half a turn.
  bool add_fix_without_odometer(const Eigen::Vector2d& p_enu, double sigma, double yaw);
  /// Empty while the track is too short, or where both tracks do not fit.
  std::optional<Estimate> estimate() const;
  void clear();

 private:
  static constexpr std::size_t kCapacity = 24;
  struct Match {
    Eigen::Vector2d gps = Eigen::Vector2d::Zero();
    Eigen::Vector2d reckoned = Eigen::Vector2d::Zero();
    double sigma = 0.0;
  };
  void push(const Match& match);

  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
  double travelled_ = 0.0;  ///< m since the last match
  double last_yaw_ = 0.0;
  std::array<Match, kCapacity> matches_;
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace fleetmap::localization
