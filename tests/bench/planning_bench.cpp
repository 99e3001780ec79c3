// Prints how long fleets take for generated sites under each division, as Markdown tables.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "planning/sites.hpp"

namespace {

using namespace fleetmap::planning;

struct Case {
  testing::SiteSpec spec;
  bool mixed = false;
};

std::vector<Case> cases(bool large) {
  std::vector<Case> all = {
      {{.name = "rectangle 200 x 200 m", .every = 2}},
      {{.name = "few long lanes, 400 x 90 m"}, false},
      {{.name = "triangle 300 x 240 m", .taper = 0.9, .every = 2, .seed = 2}},
      {{.name = "ragged 300 x 300 m, gaps", .missing = 0.15, .ragged = 0.3, .every = 2, .seed = 3}},
      {{.name = "turned 20 deg, 300 x 200 m", .taper = 0.4, .turned = 0.35, .every = 2, .seed = 4}},
      {{.name = "few long lanes, cut at 100 m", .max_row_length = 100.0}},
      {{.name = "triangle, mixed speeds", .taper = 0.9, .every = 2, .seed = 2}, true},
  };
  for (const std::size_t k : {1u, 5u}) {
    all[k].spec.width = 400.0;
    all[k].spec.depth = 90.0;
  }
  for (const std::size_t k : {2u, 6u}) {
    all[k].spec.width = 300.0;
    all[k].spec.depth = 240.0;
  }
  all[3].spec.width = all[3].spec.depth = 300.0;
  all[4].spec.width = 300.0;
  if (large) {
    all = {{{.name = "1 km x 1 km"}}, {{.name = "1 km x 1 km, ragged", .ragged = 0.2, .seed = 5}, true}};
    for (Case& c : all) c.spec.width = c.spec.depth = 1000.0;
  }
  return all;
}

struct Outcome {
  double makespan = 0.0;
  double cpu = 0.0;
  std::size_t left_out = 0;
  double completion = 0.0;
  double without_stops = 0.0;
  std::size_t stops = 0;
  int tried = 0;
};

Outcome run(const Mission& mission, const std::vector<RobotAbility>& robots, DivisionMethod method,
            MissionConfig config = {}) {
  config.division.method = method;
  const double before = fleetmap::thread_cpu_seconds();
  const auto plan = plan_fleet(mission, robots, config);
  if (!plan) {
    std::printf("%s\n", plan.error().message.c_str());
    return {};
  }
  const ExchangePlan& exchange = *(*plan)->exchange;
  return {(*plan)->division.makespan,
          fleetmap::thread_cpu_seconds() - before,
          (*plan)->division.left_out.size(),
          exchange.completion,
          exchange.completion_without_stops,
          exchange.stops.size(),
          exchange.rejected + static_cast<int>(exchange.stops.size())};
}

void compare_divisions(bool large) {
  std::printf(
      "| site | rows | N_a | uniform [s] | balanced [s] | ratio | energy [s] | ratio | left out | CPU [s] "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases(large)) {
    const Mission mission = testing::site(c.spec);
    for (int count = 2; count <= 5; ++count) {
      std::vector<RobotAbility> robots = testing::fleet(count, c.mixed);
      if (c.mixed) robots[0].battery_wh = 25.0;  // and one battery is nearly empty
      const Outcome uniform = run(mission, robots, DivisionMethod::kUniform);
      const Outcome balanced = run(mission, robots, DivisionMethod::kBalanced);
      const Outcome energy = run(mission, robots, DivisionMethod::kEnergy);
      std::printf("| %s | %zu | %d | %.0f | %.0f | %.3f | %.0f | %.3f | %zu | %.2f |\n", c.spec.name.c_str(),
                  mission.rows.size(), count, uniform.makespan, balanced.makespan,
                  balanced.makespan / uniform.makespan, energy.makespan, energy.makespan / uniform.makespan,
                  energy.left_out, balanced.cpu);
      std::fflush(stdout);
    }
  }
}

struct Radio {
  const char* name;
  double bandwidth;      // bit/s
  double bytes_a_metre;  // of maps
};

void compare_exchange() {
  const Radio radios[] = {{"15 Mbit/s, 6 kB/m", 15e6, 6e3},
                          {"15 Mbit/s, 60 kB/m", 15e6, 60e3},
                          {"2 Mbit/s, 20 kB/m", 2e6, 20e3},
                          {"0.5 Mbit/s, 60 kB/m", 0.5e6, 60e3}};
  std::printf(
      "| site | radio | N_a | uniform [s] | balanced [s] | energy without stops [s] | energy [s] | saved | "
      "stops | tried | CPU [s] |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<Case> sites = {{{.name = "rectangle 200 x 200 m", .every = 2}},
                             {{.name = "triangle 300 x 300 m, mixed speeds", .taper = 0.9, .every = 3}, true},
                             {{.name = "square 400 x 400 m", .every = 4}}};
  sites[1].spec.width = sites[1].spec.depth = 300.0;
  sites[2].spec.width = sites[2].spec.depth = 400.0;
  for (const Case& c : sites) {
    const Mission mission = testing::site(c.spec);
    for (const Radio& radio : radios) {
      for (int count = 3; count <= 5; ++count) {
        const std::vector<RobotAbility> robots = testing::fleet(count, c.mixed);
        MissionConfig config;
        config.meeting.bandwidth = radio.bandwidth;
        config.meeting.map_bytes_per_metre = radio.bytes_a_metre;
        const Outcome uniform = run(mission, robots, DivisionMethod::kUniform, config);
        const Outcome balanced = run(mission, robots, DivisionMethod::kBalanced, config);
        const Outcome energy = run(mission, robots, DivisionMethod::kEnergy, config);
        const double saved = 1.0 - energy.completion / energy.without_stops;
        std::printf("| %s | %s | %d | %.0f | %.0f | %.0f | %.0f | %.1f %% | %zu | %d | %.2f |\n",
                    c.spec.name.c_str(), radio.name, count, uniform.completion, balanced.completion,
                    energy.without_stops, energy.completion, 100.0 * saved, energy.stops, energy.tried,
                    energy.cpu);
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace

/// `--large`: of 1 km²; `--exchange`: when all maps are exchanged, over several radios.
int main(int argc, char** argv) {
  const auto asked = [&](const char* what) { return argc > 1 && std::strcmp(argv[1], what) == 0; };
  asked("--exchange") ? compare_exchange() : compare_divisions(asked("--large"));
  return 0;
}
