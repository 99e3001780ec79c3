#include "fleetmap/sensor/turn_lag.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::sensor {
namespace {

constexpr double kLagStep = 0.02;    // s
constexpr double kShows = 0.005;     // rad by which the turns of two lags differ
constexpr double kMisfitLeft = 0.5;  // of the one without lag
constexpr double kLaterMisfitLeft = 0.25;
constexpr double kSameLag = 0.05;  // s

}  // namespace

Duration TurnLag::reach() { return from_seconds((kLags + 1) * kLagStep); }

bool TurnLag::add(const RunningIntegral& gyro, Stamp from, Stamp to, double turned) {
  ByLag turns{};
  double smallest = 1e9, largest = 0.0;
  for (int k = -kLags; k <= kLags; ++k) {
    const Duration lag = from_seconds(k * kLagStep);
    const auto turn = gyro.between(from + lag, to + lag);
    if (!turn) return false;
    turns.at(static_cast<std::size_t>(k + kLags)) = turn->z();
    const double misfit = (turn->z() - turned) * (turn->z() - turned);
    smallest = std::min(smallest, misfit);
    largest = std::max(largest, misfit);
  }
  if (!window_from_) window_from_ = from;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    gyro_squares_.at(k) += turns.at(k) * turns.at(k);
    products_.at(k) += turns.at(k) * turned;
  }
  turn_squares_ += turned * turned;
  // A lag shows where the turn rate changes; in steady turns and at standstill it does not.
  steps_ += largest - smallest > kShows * kShows ? 1 : 0;
  if (steps_ >= (first_checked_ ? config_.later_steps : config_.first_steps)) check();
  return true;
}

double TurnLag::misfit(std::size_t k) const {
  const double scaled = products_.at(k) * products_.at(k) / std::max(turn_squares_, 1e-12);
  return gyro_squares_.at(k) - (config_.same_scale ? 2.0 * products_.at(k) - turn_squares_ : scaled);
}

void TurnLag::check() {
  const bool first = !std::exchange(first_checked_, true);
  std::size_t best = 0;
  for (std::size_t k = 1; k < gyro_squares_.size(); ++k) best = misfit(k) < misfit(best) ? k : best;
  const double lag = (static_cast<double>(best) - kLags) * kLagStep;
  const auto usual = static_cast<std::size_t>(std::lround(usual_ / kLagStep) + kLags);
  const bool lags = std::abs(lag - usual_) >= (first ? config_.min_lag : config_.min_later_lag) - 1e-6 &&
                    misfit(best) <= (first ? kMisfitLeft : kLaterMisfitLeft) * misfit(usual);
  const Found now{lag, first, *window_from_};
  if (first && config_.first_is_usual) {
    usual_ = lag;
  } else if (lags && !found_any_) {
    const bool again = suspected_ && std::abs(suspected_->lag - lag) <= kSameLag;
    if (first || again) {
      found_any_ = true;
      found_ = Found{lag, first, again ? suspected_->since : now.since};
    }
  }
  suspected_ = lags && !first ? std::optional(now) : std::nullopt;
  gyro_squares_ = products_ = {};
  turn_squares_ = 0.0;
  steps_ = 0;
  window_from_.reset();
}

std::optional<TurnLag::Found> TurnLag::take_found() { return std::exchange(found_, std::nullopt); }

}  // namespace fleetmap::sensor
