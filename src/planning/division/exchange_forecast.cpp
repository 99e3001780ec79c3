#include "division/exchange_forecast.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::planning {
namespace {

constexpr double kEven = 1.0;         // B between two maps that are the same
constexpr double kMaxSteps = 5000.0;  // of a forecast; a longer one takes longer steps

class Simulation {
 public:
  Simulation(std::span<const Itinerary> fleet, std::size_t stops, const RendezvousConfig& config,
             const Pace& pace)
      : fleet_(fleet), config_(config), pace_(pace), robots_(fleet.size()), stops_(stops) {
    const std::size_t n = fleet.size();
    holds_.assign(n, std::vector<double>(n, 0.0));
    positions_.resize(n);
    out_.arrivals.assign(n, 0.0);
    out_.lengths.assign(n, 0.0);
    out_.begins.resize(n);
    out_.at_stop.assign(stops, {Forecast::kNever, Forecast::kNever});
    out_.leave.assign(stops, Forecast::kNever);
    double longest = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      out_.begins[k].assign(fleet[k].size(), Forecast::kNever);
      double time = 0.0;
      for (const Piece& piece : fleet[k]) {
        time += piece.path.times.back() * pace.of(k);
        if (piece.stop) stops_[*piece.stop].robots[stops_[*piece.stop].robots[0] == kNobody ? 0 : 1] = k;
      }
      longest = std::max(longest, time);
      begin_piece(k, 0.0);
    }
    step_ = std::max(config.sample_period, longest / kMaxSteps);
  }

  Forecast run(double give_up) {
    if (std::isfinite(give_up)) step_ = std::max(step_, give_up / kMaxSteps);
    for (double now = 0.0; now <= give_up; now += step_) {
      for (std::size_t k = 0; k < robots_.size(); ++k) advance(k, now);
      if (std::ranges::all_of(robots_, &Robot::there)) {
        if (all_in_reach()) out_.completion = completion(now);
        break;
      }
      flow();
      for (std::size_t s = 0; s < stops_.size(); ++s) end_exchange_if_even(s, now);
    }
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      out_.lengths[k] = holds_[k][k] / std::max(1e-9, bytes_per_metre());
      out_.bytes_total += holds_[k][k] * static_cast<double>(robots_.size() - 1);
    }
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
  struct Robot {
    std::size_t piece = 0;
    double since = 0.0;   // s, when the piece began
    double before = 0.0;  // m, driven before it
    bool waiting = false;
    bool there = false;
  };
  struct Stop {
    std::array<std::size_t, 2> robots{kNobody, kNobody};
    double even_since = Forecast::kNever;
  };
  struct Demand {
    std::size_t receiver;
    std::size_t map;
    double bytes;
  };

  /// Lengths are read back from bytes, so that even weightless maps need some weight.
  double bytes_per_metre() const { return std::max(1e-6, config_.map_bytes_per_metre); }

  void begin_piece(std::size_t k, double at) {
    Robot& robot = robots_[k];
    robot.since = at;
    robot.there = robot.piece == fleet_[k].size();
    if (robot.there) {
      out_.arrivals[k] = at;
    } else {
      out_.begins[k][robot.piece] = at;
    }
  }

  void advance(std::size_t k, double now) {
    Robot& robot = robots_[k];
    while (!robot.there && !robot.waiting) {
      const Piece& piece = fleet_[k][robot.piece];
      const double end = robot.since + piece.path.times.back() * pace_.of(k);
      if (end > now) break;
      robot.before += piece.length;
      if (piece.stop) {
        robot.waiting = true;
        out_.at_stop[*piece.stop][stops_[*piece.stop].robots[0] == k ? 0 : 1] = end;
      } else {
        ++robot.piece;
        begin_piece(k, end);
      }
    }
    double driven = robot.before;
    if (robot.there) {
      positions_[k] = fleet_[k].back().path.points.back();
    } else if (robot.waiting) {
      positions_[k] = fleet_[k][robot.piece].path.points.back();
    } else {
      const TimedPath& path = fleet_[k][robot.piece].path;
      positions_[k] = path.at((now - robot.since) / pace_.of(k));
      driven += path.driven((now - robot.since) / pace_.of(k));
    }
    holds_[k][k] = bytes_per_metre() * driven;
  }

  /// One step of the channel, whose rate is divided equally among the robots that lack something that a robot
  /// in reach holds.
  void flow() {
    const std::size_t n = robots_.size();
    demands_.clear();
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t map = 0; map < n; ++map) {
        double held = holds_[k][map];
        for (std::size_t other = 0; other < n; ++other) {
          if (other != k && holds_[other][map] > held && near(k, other)) held = holds_[other][map];
        }
        if (held > holds_[k][map]) demands_.push_back({k, map, held - holds_[k][map]});
      }
    }
    std::ranges::stable_sort(demands_, {}, &Demand::bytes);
    double budget = step_ * rate();
    for (std::size_t d = 0; d < demands_.size(); ++d) {
      const Demand& demand = demands_[d];
      const double bytes = std::min(demand.bytes, budget / static_cast<double>(demands_.size() - d));
      budget -= bytes;
      holds_[demand.receiver][demand.map] += bytes;
      const Robot& receiver = robots_[demand.receiver];
      if (receiver.waiting) out_.bytes_at_stops += bytes;
      if (!receiver.waiting && !receiver.there) out_.bytes_in_passing += bytes;
    }
  }
  bool near(std::size_t a, std::size_t b) const {
    return (positions_[a] - positions_[b]).squaredNorm() <= config_.c_max * config_.c_max;
  }

  void end_exchange_if_even(std::size_t s, double now) {
    Stop& stop = stops_[s];
    const auto [a, b] = stop.robots;
    if (a == kNobody || b == kNobody || !at(a, s) || !at(b, s)) return;
    bool even = true;
    for (std::size_t map = 0; map < robots_.size(); ++map) {
      even &= std::abs(holds_[a][map] - holds_[b][map]) <= kEven;
    }
    if (!even) return;
    stop.even_since = std::min(stop.even_since, now);
    if (now - stop.even_since < config_.stop_overhead) return;
    out_.leave[s] = now;
    for (const std::size_t k : {a, b}) {
      robots_[k].waiting = false;
      ++robots_[k].piece;
      begin_piece(k, now);
    }
  }
  bool at(std::size_t k, std::size_t s) const {
    return robots_[k].waiting && fleet_[k][robots_[k].piece].stop == s;
  }

  /// Directly or through others.
  bool all_in_reach() const {
    std::vector<std::size_t> reached{0};
    std::vector<bool> known(robots_.size(), false);
    known[0] = true;
    for (std::size_t next = 0; next < reached.size(); ++next) {
      for (std::size_t k = 0; k < robots_.size(); ++k) {
        if (known[k] || !near(reached[next], k)) continue;
        known[k] = true;
        reached.push_back(k);
      }
    }
    return reached.size() == robots_.size();
  }
  /// All robots are at the end, so the channel is busy until every robot has everything.
  double completion(double now) const {
    double bytes = 0.0;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      for (std::size_t map = 0; map < robots_.size(); ++map) bytes += holds_[map][map] - holds_[k][map];
    }
    const double latest = std::ranges::max(out_.arrivals);
    return std::max(latest, now - step_) + bytes / rate();
  }
  double rate() const { return config_.bandwidth * config_.efficiency / 8.0; }  // B/s

  std::span<const Itinerary> fleet_;
  const RendezvousConfig& config_;
  Pace pace_;
  std::vector<Robot> robots_;
  std::vector<Stop> stops_;
  std::vector<std::vector<double>> holds_;  // B, of each robot of each robot's map
  Polyline positions_;
  std::vector<Demand> demands_;
  double step_ = 1.0;
  Forecast out_;
};

}  // namespace

Forecast forecast_exchange(std::span<const Itinerary> fleet, std::size_t stops,
                           const RendezvousConfig& config, double give_up, const Pace& pace) {
  return Simulation(fleet, stops, config, pace).run(give_up);
}

}  // namespace fleetmap::planning
