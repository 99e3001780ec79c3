#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fleet_feed.hpp"
#include "fleetmap/core/thread_pool.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"
#include "fleetmap/sim/world.hpp"
#include "twin_truth.hpp"

namespace fleetmap::apps {

/// Robots of the digital twin, in virtual time: what they are commanded moves them, what they sense is given.
class TwinFeed final : public FleetFeed {
 public:
  /// `threads` cast rays beside the one that runs the events; they have no influence on what comes out. All
  /// stamps are `later` than those of a first run: two runs at one time would share GPS's slow error.
  static Result<std::unique_ptr<TwinFeed>> create(std::shared_ptr<const sim::World> world,
                                                  const GeoPoint& origin,
                                                  const std::vector<sim::RobotTwinConfig>& robots,
                                                  unsigned threads, Duration later);

  Stamp start() const override { return start_; }
  std::optional<GeoPoint> origin() const override { return origin_; }
  Status begin(bus::LocalNetwork& network, Deliver deliver) override;
  void command(std::size_t member, double forward_speed, double yaw_rate) override;
  void switch_power(std::size_t member, bool on) override;
  void stop() override { stopped_ = true; }
  bool ended(std::size_t) const override { return stopped_ && pending_.empty(); }
  std::string problem(std::size_t) const override { return {}; }
  FeedSeconds cpu_seconds() const override { return seconds_; }
  recording::Counters counters(std::size_t) const override { return {}; }
  std::optional<bus::EnuPosition> position(std::size_t member) const override;
  std::optional<GlobalPose> guide(std::size_t member) const override;
  std::optional<double> battery(std::size_t member) const override;

  /// True poses of the member every 0.1 s, base_link in ENU.
  const output::Trajectory& truth(std::size_t member) const { return robots_[member].truth.poses(); }
  const sim::RobotTwin& twin(std::size_t member) const { return robots_[member].twin; }

 private:
  static constexpr Stamp kFirstStart{std::chrono::hours(24 * 365 * 50)};
  struct CastPart {
    std::vector<sensor::ScanPoint> points;
    double cpu_seconds = 0.0;
  };
  /// A scan whose rays are being cast, part by part as their poses come to be known: that keeps the casting
  /// threads busy all the time, not only between a scan's last ray and its delivery.
  struct Sweep {
    std::uint64_t number = 0;
    std::size_t begun = 0;  ///< firings, see sim::firings()
    std::vector<std::pair<std::shared_ptr<CastPart>, std::future<void>>> parts;
  };
  struct Pending {
    std::size_t member = 0;
    Stamp stamp;
    Sweep sweep;
  };
  struct Robot {
    sim::RobotTwin twin;
    TruthTrack truth;
    bool on = true;
    Sweep sweep = {};  ///< of the scan under way
  };
  TwinFeed(std::shared_ptr<const sim::Scene> scene, const GeoPoint& origin, unsigned threads, Duration later)
      : scene_(std::move(scene)), origin_(origin), start_(kFirstStart + later), pool_(threads) {}
  void tick();
  void deliver_pending();
  void sense(std::size_t member);
  /// Begins to cast the firings of the job up to `end` that were not begun before.
  void cast(std::size_t member, const sim::ScanJob& job, std::size_t end);

  std::shared_ptr<const sim::Scene> scene_;
  GeoPoint origin_;
  Stamp start_;
  std::vector<Robot> robots_;
  std::deque<Pending> pending_;
  bus::LocalNetwork* network_ = nullptr;
  Deliver deliver_;
  bool stopped_ = false;
  FeedSeconds seconds_;
  ThreadPool pool_;  ///< last: its threads end before what they write to goes
};

}  // namespace fleetmap::apps
