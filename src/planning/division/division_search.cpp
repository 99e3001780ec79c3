#include "division/division_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

namespace fleetmap::planning {
namespace {

using Routes = std::vector<TimedRoute>;

constexpr double kOvertimeWeight = 100.0;  // a row that no battery allows is worse than any detour
constexpr double kSumWeight = 0.01;        // among equal makespans the shorter routes
constexpr double kMinGain = 1e-6;          // s
constexpr std::size_t kMaxPermutations = 120;
constexpr std::size_t kMaxOrdered = 300;  // rows of a share; ordering more of them takes too long

/// The minimised cost: mainly the time of the last robot, in s.
double price(const Routes& routes) {
  double last = 0.0;
  double sum = 0.0;
  double over = 0.0;
  for (const TimedRoute& route : routes) {
    last = std::max(last, route.time());
    sum += route.time();
    over += route.overtime();
  }
  return last + kSumWeight * sum + kOvertimeWeight * over;
}

/// price() with the times of routes a and b replaced.
double price_with(const Routes& routes, std::size_t a, double time_a, std::size_t b, double time_b) {
  double last = std::max(time_a, time_b);
  double sum = time_a + time_b;
  double over = routes[a].overtime_of(time_a) + routes[b].overtime_of(time_b);
  for (std::size_t k = 0; k < routes.size(); ++k) {
    if (k == a || k == b) continue;
    last = std::max(last, routes[k].time());
    sum += routes[k].time();
    over += routes[k].overtime();
  }
  return last + kSumWeight * sum + kOvertimeWeight * over;
}

struct Move {
  enum Kind { kRelocate, kSwap, kTails } kind = kRelocate;
  double price = 0.0;
  std::size_t a = 0, b = 0;  // routes
  std::size_t i = 0, j = 0;  // places
};

/// The best change between route a and the others.
std::optional<Move> best_move(const Routes& routes, std::size_t a) {
  Move best{Move::kRelocate, price(routes) - kMinGain};
  bool found = false;
  const auto consider = [&](const Move& move) {
    if (move.price < best.price) {
      best = move;
      found = true;
    }
  };
  const TimedRoute& from = routes[a];
  for (std::size_t i = 0; i < from.rows().size(); ++i) {
    const double without = from.time_without(i);
    for (std::size_t b = 0; b < routes.size(); ++b) {
      if (b == a) continue;
      for (std::size_t j = 0; j <= routes[b].rows().size(); ++j) {
        const double with = routes[b].time_with(j, from.rows()[i]);
        consider({Move::kRelocate, price_with(routes, a, without, b, with), a, b, i, j});
        if (j == routes[b].rows().size()) continue;
        const double mine = from.time_replaced(i, routes[b].rows()[j]);
        const double theirs = routes[b].time_replaced(j, from.rows()[i]);
        consider({Move::kSwap, price_with(routes, a, mine, b, theirs), a, b, i, j});
      }
    }
  }
  return found ? std::optional(best) : std::nullopt;
}

/// The best exchange of tails between route a and the others: dearer to price, so tried last.
std::optional<Move> best_tails(const Routes& routes, std::size_t a) {
  Move best{Move::kTails, price(routes) - kMinGain};
  bool found = false;
  const std::size_t size = routes[a].rows().size();
  for (std::size_t b = 0; b < routes.size(); ++b) {
    if (b == a) continue;
    for (std::size_t i = 0; i <= size; ++i) {
      for (std::size_t j = 0; j <= routes[b].rows().size(); ++j) {
        const double mine = routes[a].time_joined(i, routes[b], j);
        if (mine >= best.price) continue;
        const double theirs = routes[b].time_joined(j, routes[a], i);
        const double whole = price_with(routes, a, mine, b, theirs);
        if (whole >= best.price) continue;
        best = {Move::kTails, whole, a, b, i, j};
        found = true;
      }
    }
  }
  return found ? std::optional(best) : std::nullopt;
}

void carry_out(Routes& routes, const Move& move) {
  std::vector<std::size_t> a = routes[move.a].rows();
  std::vector<std::size_t> b = routes[move.b].rows();
  const auto i = static_cast<std::ptrdiff_t>(move.i);
  const auto j = static_cast<std::ptrdiff_t>(move.j);
  if (move.kind == Move::kRelocate) {
    b.insert(b.begin() + j, a[move.i]);
    a.erase(a.begin() + i);
  } else if (move.kind == Move::kSwap) {
    std::swap(a[move.i], b[move.j]);
  } else {
    const std::vector<std::size_t> tail(a.begin() + i, a.end());
    a.erase(a.begin() + i, a.end());
    a.insert(a.end(), b.begin() + j, b.end());
    b.erase(b.begin() + j, b.end());
    b.insert(b.end(), tail.begin(), tail.end());
  }
  routes[move.a].assign(std::move(a));
  routes[move.b].assign(std::move(b));
}

/// Reverses pieces and moves single rows within a route until it gets no shorter.
void shorten(TimedRoute& route) {
  constexpr std::size_t kLongestPiece = 40;
  for (bool better = true; better;) {
    better = false;
    const std::size_t n = route.rows().size();
    for (std::size_t i = 0; i + 1 < n && !better; ++i) {
      for (std::size_t j = i + 1; j < std::min(n, i + kLongestPiece) && !better; ++j) {
        std::vector<std::size_t> order = route.rows();
        std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                     order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        better = route.time_of_order(order) < route.time() - kMinGain;
        if (better) route.assign(std::move(order));
      }
    }
    for (std::size_t i = 0; i < n && !better; ++i) {
      TimedRoute rest = route;
      std::vector<std::size_t> order = route.rows();
      const std::size_t row = order[i];
      order.erase(order.begin() + static_cast<std::ptrdiff_t>(i));
      rest.assign(std::move(order));
      for (std::size_t j = 0; j < n && !better; ++j) {
        if (rest.time_with(j, row) >= route.time() - kMinGain) continue;
        order = rest.rows();
        order.insert(order.begin() + static_cast<std::ptrdiff_t>(j), row);
        route.assign(std::move(order));
        better = true;
      }
    }
  }
}

std::size_t worst(const Routes& routes) {
  std::size_t a = 0;
  for (std::size_t k = 1; k < routes.size(); ++k) {
    if (routes[k].time() + kOvertimeWeight * routes[k].overtime() >
        routes[a].time() + kOvertimeWeight * routes[a].overtime()) {
      a = k;
    }
  }
  return a;
}

void improve(Routes& routes) {
  for (TimedRoute& route : routes) shorten(route);
  for (int guard = 0; guard < 10'000; ++guard) {
    const std::size_t a = worst(routes);
    auto move = best_move(routes, a);
    if (!move) move = best_tails(routes, a);
    if (!move) return;
    carry_out(routes, *move);
    shorten(routes[move->a]);
    shorten(routes[move->b]);
  }
}

/// Moves a few neighbouring rows of a random route into another one.
void disturb(Routes& routes, std::mt19937_64& random) {
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (int times = 0; times < 2; ++times) {
    const std::size_t a = times == 0 ? worst(routes) : below(routes.size());
    const std::size_t b = (a + 1 + below(routes.size() - 1)) % routes.size();
    std::vector<std::size_t> from = routes[a].rows();
    std::vector<std::size_t> to = routes[b].rows();
    if (from.empty()) continue;
    const std::size_t first = below(from.size());
    const std::size_t count = std::min(from.size() - first, 1 + below(3));
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
    const auto place = to.begin() + static_cast<std::ptrdiff_t>(below(to.size() + 1));
    to.insert(place, begin, begin + static_cast<std::ptrdiff_t>(count));
    from.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    routes[a].assign(std::move(from));
    routes[b].assign(std::move(to));
  }
}

/// Neighbouring rows to the workers in this order, each as many as it drives within `limit`; the last one
/// takes the rest.
Routes contiguous(const Routes& empty, std::span<const std::size_t> rows, std::span<const std::size_t> order,
                  double limit) {
  Routes routes = empty;
  std::size_t next = 0;
  for (std::size_t k = 0; k < order.size() && next < rows.size(); ++k) {
    TimedRoute& route = routes[order[k]];
    const bool last = k + 1 == order.size();
    std::vector<std::size_t> mine{rows[next++]};
    route.assign(mine);
    for (; next < rows.size() && (last || route.time_with(mine.size(), rows[next]) <= limit); ++next) {
      mine.push_back(rows[next]);
      route.assign(mine);
    }
  }
  return routes;
}

Routes best_contiguous(const Routes& empty, std::span<const std::size_t> rows) {
  std::vector<std::size_t> order(empty.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Routes best = contiguous(empty, rows, order, 0.0);
  std::size_t tried = 0;
  do {
    double low = 0.0;
    double high = price(best);
    for (int step = 0; step < 12; ++step) {
      const double limit = 0.5 * (low + high);
      Routes routes = contiguous(empty, rows, order, limit);
      double longest = 0.0;
      for (const TimedRoute& route : routes) longest = std::max(longest, route.time());
      (longest <= limit ? high : low) = limit;
      if (price(routes) < price(best)) best = std::move(routes);
    }
  } while (++tried < kMaxPermutations && std::ranges::next_permutation(order).found);
  return best;
}

Routes empty_routes(const TravelCosts& costs, std::span<const Worker> workers,
                    std::span<const Travel> to_end) {
  Routes routes;
  for (const Worker& worker : workers) routes.emplace_back(costs, to_end, worker);
  return routes;
}

}  // namespace

std::vector<TimedRoute> uniform_division(const TravelCosts& costs, std::span<const std::size_t> rows,
                                         std::span<const Worker> workers, std::span<const Travel> to_end) {
  Routes routes = empty_routes(costs, workers, to_end);
  for (std::size_t k = 0; k < routes.size(); ++k) {
    const std::size_t first = k * rows.size() / routes.size();
    const std::size_t end = (k + 1) * rows.size() / routes.size();
    std::vector<std::size_t> share(rows.begin() + static_cast<std::ptrdiff_t>(first),
                                   rows.begin() + static_cast<std::ptrdiff_t>(end));
    routes[k].assign(share);
    std::ranges::reverse(share);
    if (routes[k].time_of_order(share) < routes[k].time() - kMinGain) routes[k].assign(std::move(share));
    if (end - first <= kMaxOrdered) shorten(routes[k]);
  }
  return routes;
}

std::vector<TimedRoute> search_division(const TravelCosts& costs, std::span<const std::size_t> rows,
                                        std::span<const Worker> workers, std::span<const Travel> to_end,
                                        const DivisionConfig& config) {
  Routes best = uniform_division(costs, rows, workers, to_end);
  improve(best);
  Routes other = best_contiguous(empty_routes(costs, workers, to_end), rows);
  improve(other);
  if (price(other) < price(best)) best = std::move(other);
  if (workers.size() < 2 || rows.size() < 2) return best;
  std::mt19937_64 random(config.seed);
  // A round costs about the square of the rows; their number keeps a large site within seconds.
  const int rounds =
      std::min(config.search_rounds, static_cast<int>(200'000 / (rows.size() * rows.size())) + 10);
  for (int round = 0; round < rounds; ++round) {
    Routes trial = best;
    disturb(trial, random);
    improve(trial);
    if (price(trial) < price(best) - kMinGain) best = std::move(trial);
  }
  return best;
}

}  // namespace fleetmap::planning
