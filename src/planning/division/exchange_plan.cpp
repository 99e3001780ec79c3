#include "fleetmap/planning/division/exchange_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "division/drive.hpp"
#include "division/exchange_forecast.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kWithinReach = 0.8;   // of C_max: what two who stop are apart at most
constexpr std::size_t kBins = 8;       // of the time of the mission: one stop a pair is tried in each
constexpr std::size_t kMaxTried = 48;  // pairs of gaps between rows, before each stop that is added
/// Delays of robots under which a stop must still gain, since robots are late by some percent.
constexpr Pace kLate[] = {{1.05, 0}, {1.05, 1}};
constexpr double kPrefersEarly = 0.02;  // s a second that a robot waits at a stop, even if it has time

/// Two robots, each before a certain piece of its drive.
struct Gap {
  std::array<std::size_t, 2> robots{};
  std::array<std::size_t, 2> pieces{};
  double time = 0.0;   // s, when the later one is there
  double price = 0.0;  // s, a guess at how much later the fleet gets to the meeting
};

class Planner {
 public:
  Planner(const RoutePlanner& routes, const Mission& mission, std::span<const RobotAbility> fleet,
          const RendezvousConfig& config, const ExchangeRules& rules)
      : routes_(routes), mission_(mission), fleet_(fleet), config_(config), rules_(rules) {}

  ExchangePlan plan(std::span<const RobotRoute> routes, const Polyline& meeting) {
    for (std::size_t k = 0; k < fleet_.size(); ++k) add_drive(fleet_[k], routes[k].visits, meeting[k]);
    meeting_ = meeting;
    now_ = forecast_exchange(drives_, 0, config_, Forecast::kNever);
    plan_.completion_without_stops = completion(now_);
    while (rules_.stops && add_stop()) {
    }
    plan_.completion = completion(now_);
    plan_.arrivals = now_.arrivals;
    plan_.lengths = now_.lengths;
    plan_.transfer_at_meeting = plan_.completion - std::ranges::max(now_.arrivals);
    plan_.bytes_total = now_.bytes_total;
    plan_.bytes_in_passing = now_.bytes_in_passing;
    plan_.bytes_at_stops = now_.bytes_at_stops;
    for (std::size_t s = 0; s < plan_.stops.size(); ++s) {
      plan_.stops[s].leave = now_.leave[s];
      for (std::size_t part = 0; part < 2; ++part) plan_.stops[s].parts[part].arrival = now_.at_stop[s][part];
    }
    return std::move(plan_);
  }

 private:
  void add_drive(const RobotAbility& robot, std::span<const RowVisit> visits, const Eigen::Vector2d& end) {
    Itinerary drive;
    Pose2 pose = robot.start;
    for (std::size_t k = 0; k <= visits.size(); ++k) {
      const Piece piece = piece_from(robot, pose, k, k < visits.size() ? &visits[k] : nullptr, end);
      pose = {piece.path.points.back(), last_yaw_};
      drive.push_back(piece);
    }
    drives_.push_back(std::move(drive));
    visits_.push_back({visits.begin(), visits.end()});
  }

  /// The way to a row and the row, or the way to `end`.
  Piece piece_from(const RobotAbility& robot, const Pose2& pose, std::size_t after, const RowVisit* visit,
                   const Eigen::Vector2d& end) {
    Drive drive(robot, pose);
    visit ? drive.add_row(routes_, mission_, *visit) : drive.add_way(routes_, end);
    last_yaw_ = drive.pose().yaw;
    return {drive.path(), length_of(drive.path().points), after, pose, std::nullopt};
  }

  /// Time of completion, s. If the places at the meeting are too far apart to exchange all maps, computed as
  /// if they were not.
  double completion(const Forecast& forecast) const {
    if (std::isfinite(forecast.completion)) return forecast.completion;
    return std::ranges::max(forecast.arrivals) +
           forecast.bytes_total * 8.0 / (config_.bandwidth * config_.efficiency);
  }

  bool add_stop() {
    const double latest = std::ranges::max(now_.arrivals);
    // Even if nothing were left to be exchanged at the meeting, it could not be worth it.
    if (!std::isfinite(now_.completion) || now_.completion - latest < config_.min_gain) return false;
    double best = now_.completion - std::max(config_.min_gain, 1e-3);
    std::vector<double> late;
    for (const Pace& pace : kLate) {
      late.push_back(forecast_exchange(drives_, plan_.stops.size(), config_, 2.0 * best, pace).completion);
    }
    Forecast best_forecast;
    std::vector<Itinerary> best_drives;
    Detour best_stop;
    for (const Gap& gap : gaps(latest)) {
      for (const auto& places : places_for(gap)) {
        std::vector<Itinerary> drives = drives_;
        Detour stop;
        for (std::size_t part = 0; part < 2; ++part) {
          stop.parts[part] = insert(drives, gap.robots[part], gap.pieces[part], places[part]);
        }
        Forecast forecast = forecast_exchange(drives, plan_.stops.size() + 1, config_, best);
        if (!(forecast.completion < best) || !batteries_last(forecast) || !lasts(drives, late)) {
          ++plan_.rejected;
          continue;
        }
        best = forecast.completion;
        best_forecast = std::move(forecast);
        best_drives = std::move(drives);
        best_stop = stop;
      }
    }
    if (best_drives.empty()) return false;
    best_stop.saving = now_.completion - best;
    now_ = std::move(best_forecast);
    drives_ = std::move(best_drives);
    plan_.stops.push_back(best_stop);
    return true;
  }

  /// Possible stops of two robots, the most promising first: after their first row, one stop a gap.
  std::vector<Gap> gaps(double latest) const {
    std::vector<Gap> all;
    for (std::size_t a = 0; a < drives_.size(); ++a) {
      for (std::size_t b = a + 1; b < drives_.size(); ++b) {
        std::array<Gap, kBins> best;
        for (Gap& gap : best) gap.price = Forecast::kNever;
        for (const std::size_t i : open_pieces(a)) {
          for (const std::size_t j : open_pieces(b)) {
            const Gap gap = priced({{a, b}, {i, j}}, latest);
            auto bin = static_cast<std::size_t>(gap.time / latest * static_cast<double>(kBins));
            bin = std::min(bin, kBins - 1);
            if (gap.price < best[bin].price) best[bin] = gap;
          }
        }
        std::ranges::copy_if(best, std::back_inserter(all), [&](const Gap& g) { return g.price < latest; });
      }
    }
    std::ranges::stable_sort(all, {}, &Gap::price);
    if (all.size() > kMaxTried) all.resize(kMaxTried);
    return all;
  }
  std::vector<std::size_t> open_pieces(std::size_t k) const {
    std::vector<std::size_t> open;
    for (std::size_t p = 1; p < drives_[k].size(); ++p) {
      if (!drives_[k][p].stop && !drives_[k][p - 1].stop) open.push_back(p);
    }
    return open;
  }
  Gap priced(Gap gap, double latest) const {
    std::array<double, 2> free{};
    std::array<Eigen::Vector2d, 2> from;
    for (std::size_t part = 0; part < 2; ++part) {
      free[part] = now_.begins[gap.robots[part]][gap.pieces[part]];
      from[part] = drives_[gap.robots[part]][gap.pieces[part]].begin.position;
    }
    const double speed = std::min(fleet_[gap.robots[0]].speed, fleet_[gap.robots[1]].speed);
    const double way = std::max(0.0, (from[0] - from[1]).norm() - kWithinReach * config_.c_max) / speed;
    gap.time = std::max(free[0], free[1]);
    for (std::size_t part = 0; part < 2; ++part) {
      const double delay = gap.time - free[part] + way;
      const double slack = latest - now_.arrivals[gap.robots[part]];
      gap.price += std::max(0.0, delay - slack) + kPrefersEarly * delay;
    }
    return gap;
  }

  /// Either stays where it is and the other one comes, or both come.
  std::vector<std::array<Eigen::Vector2d, 2>> places_for(const Gap& gap) const {
    std::array<Eigen::Vector2d, 2> from;
    for (std::size_t part = 0; part < 2; ++part) {
      from[part] = drives_[gap.robots[part]][gap.pieces[part]].begin.position;
    }
    const double reach = kWithinReach * config_.c_max;
    if ((from[0] - from[1]).norm() <= reach) return {from};
    const auto way = routes_.route(from[0], from[1]);
    if (!way) return {};
    const double length = length_of(*way);
    std::vector<std::array<Eigen::Vector2d, 2>> places;
    for (const double share : {0.0, 0.5, 1.0}) {
      // The two go toward each other: first so far that it is enough for sure, then as little as is.
      double enough = length;
      double too_little = std::max(0.0, (from[0] - from[1]).norm() - reach);
      const auto at = [&](double go) {
        return std::array<Eigen::Vector2d, 2>{point_at(*way, share * go),
                                              point_at(*way, length - (1.0 - share) * go)};
      };
      while (enough - too_little > 1.0) {
        const double go = 0.5 * (enough + too_little);
        const auto [a, b] = at(go);
        ((a - b).norm() <= reach ? enough : too_little) = go;
      }
      places.push_back(at(enough));
    }
    return places;
  }
  static Eigen::Vector2d point_at(const Polyline& line, double along) {
    for (std::size_t k = 1; k < line.size(); ++k) {
      const double step = (line[k] - line[k - 1]).norm();
      if (along <= step && step > 0.0) return line[k - 1] + (line[k] - line[k - 1]) * along / step;
      along -= step;
    }
    return line.back();
  }

  /// The way to the stop goes before the piece, which then begins there.
  Detour::Part insert(std::vector<Itinerary>& drives, std::size_t robot, std::size_t piece,
                      const Eigen::Vector2d& place) {
    Itinerary& drive = drives[robot];
    const std::size_t after = drive[piece].after;
    Piece to = piece_from(fleet_[robot], drive[piece].begin, after, nullptr, place);
    to.stop = plan_.stops.size();
    const RowVisit* visit = after < visits_[robot].size() ? &visits_[robot][after] : nullptr;
    drive[piece] = piece_from(fleet_[robot], {place, last_yaw_}, after, visit, meeting_[robot]);
    const Eigen::Vector2d position = to.path.points.back();
    drive.insert(drive.begin() + static_cast<std::ptrdiff_t>(piece), std::move(to));
    return {robot, after, position, 0.0};
  }

  /// True if the gain remains when robots are late, so that it does not depend on a chance meeting.
  bool lasts(const std::vector<Itinerary>& drives, std::span<const double> late) const {
    for (std::size_t k = 0; k < std::size(kLate); ++k) {
      const double bound = late[k] - std::max(config_.min_gain, 1e-3);
      const Forecast forecast = forecast_exchange(drives, plan_.stops.size() + 1, config_,
                                                  std::min(bound, 2.0 * now_.completion), kLate[k]);
      if (!(forecast.completion < bound)) return false;
    }
    return true;
  }

  bool batteries_last(const Forecast& forecast) const {
    for (std::size_t k = 0; k < fleet_.size(); ++k) {
      const auto energy = [&](const Forecast& f) {
        return f.arrivals[k] * fleet_[k].power_idle_w / 3600.0 + f.lengths[k] * fleet_[k].energy_per_metre_wh;
      };
      const double planned = energy(forecast);
      const double budget = fleet_[k].battery_wh * (1.0 - rules_.battery_reserve);
      if (planned > budget && planned > energy(now_)) return false;
    }
    return true;
  }

  const RoutePlanner& routes_;
  const Mission& mission_;
  std::span<const RobotAbility> fleet_;
  const RendezvousConfig& config_;
  const ExchangeRules& rules_;
  std::vector<std::vector<RowVisit>> visits_;
  Polyline meeting_;
  std::vector<Itinerary> drives_;
  Forecast now_;  ///< of drives_
  ExchangePlan plan_;
  double last_yaw_ = 0.0;
};

}  // namespace

ExchangePlan plan_exchange(const RoutePlanner& planner, const Mission& mission,
                           std::span<const RobotAbility> fleet, std::span<const RobotRoute> routes,
                           const Polyline& meeting, const RendezvousConfig& config,
                           const ExchangeRules& rules) {
  if (fleet.empty()) return {};
  return Planner(planner, mission, fleet, config, rules).plan(routes, meeting);
}

}  // namespace fleetmap::planning
