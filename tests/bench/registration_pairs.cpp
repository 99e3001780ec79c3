// Pairs of nodes on generated sites, with truth: how often registration is right, wrong or undecided, how
// accurate, and at what cost. Made in three steps, each kept in a folder so that trying is quick:
//   bench_registration_pairs maps DIR SET      maps around nodes; dev, drift, noisy, more, earlier, final
//   bench_registration_pairs clouds DIR SET    spherized clouds of these
//   bench_registration_pairs register DIR SET  the table; METHOD=paper: by the paper's registration
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <future>
#include <map>
#include <numbers>
#include <random>

#include "bench/distinctive_structure.hpp"
#include "bench/node_files.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/registration_method.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/pair_worlds.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::registration;
using namespace fleetmap::registration::testing;

struct PairPlace {
  std::string name;
  std::function<Site()> make;
  Gathering how;
  unsigned seed;
};

/// Seeds of farms whose lanes can be driven are 1000 apart from those that cannot.
Site drivable_farm(const std::string& name, sim::SolarFarmConfig config) {
  while (!sim::make_solar_farm(config)) config.seed += 1000;
  return farm_site(name, config);
}

Site farm(const std::string& name, unsigned seed, bool hilly = false, double size = 200.0) {
  sim::SolarFarmConfig config;
  config.seed = seed;
  config.size_east = config.size_north = size;
  config.road_every = 6;
  config.cabins = 3;
  config.trees = 30;
  config.terrain.slope_east_rad = 0.009;
  if (hilly) {
    config.row_azimuth_rad = 75.0 * std::numbers::pi / 180.0;
    config.row_pitch = 8.0;
    config.table_length = 8.0;
    config.missing_tables = 0.06;
    config.trees = 90;
    config.margin = 20.0;
    config.terrain = {1.2, 60.0, 0.03, 3.0, 0.0, 0.0};
  }
  if (size < 100.0) {
    config.road_every = 2, config.cabins = 1, config.trees = 10, config.headland = 6.0, config.margin = 12.0;
    config.missing_tables = 0.05;
    config.terrain.rolling_amplitude = 0.25, config.terrain.rolling_wavelength = 50.0;
  }
  return drivable_farm(name, config);
}

/// Sites of a set. `final` was not used while the method was developed.
std::vector<PairPlace> places_of(const std::string& set) {
  std::vector<PairPlace> places;
  const auto add = [&](const std::string& kind, unsigned seed, const Gathering& how) {
    const std::string name = kind + std::to_string(seed);
    places.push_back({name,
                      [=] {
                        return kind == "wild"
                                   ? wild_site(name, seed)
                                   : farm(name, seed, kind == "hilly", kind == "small" ? 60.0 : 200.0);
                      },
                      how, seed});
  };
  Gathering clean, drift, noisy;
  drift.drift_m = 0.006, drift.drift_rad = 0.0004;
  noisy.range_noise_m = 0.10, noisy.drift_m = 0.006, noisy.drift_rad = 0.0004;
  if (set == "dev")
    add("farm", 1, clean), add("hilly", 2, clean), add("small", 3, clean), add("wild", 4, clean);
  if (set == "drift")
    add("farm", 5, drift), add("hilly", 6, drift), add("small", 7, drift), add("wild", 8, drift);
  if (set == "noisy") add("farm", 9, noisy), add("wild", 10, noisy);
  if (set == "more") {
    add("farm", 21, clean), add("farm", 22, drift), add("farm", 23, drift), add("farm", 24, noisy);
    add("hilly", 25, drift), add("hilly", 26, noisy), add("farm", 27, clean), add("farm", 28, drift);
  }
  if (set == "earlier") {  // what was measured, and so looked at, first
    for (unsigned k = 101; k <= 104; ++k) add("farm", k, k % 2 == 0 ? drift : clean);
    for (unsigned k = 111; k <= 112; ++k) add("hilly", k, k % 2 == 0 ? drift : clean);
    add("small", 121, drift), add("wild", 131, clean), add("wild", 132, drift), add("farm", 141, noisy);
  }
  if (set == "final") {
    for (unsigned k = 201; k <= 204; ++k) add("farm", k, k % 2 == 0 ? drift : clean);
    for (unsigned k = 211; k <= 212; ++k) add("hilly", k, k % 2 == 0 ? drift : clean);
    add("small", 221, drift), add("wild", 231, clean), add("wild", 232, drift);
    add("farm", 241, noisy), add("farm", 242, noisy), add("hilly", 243, noisy), add("wild", 244, noisy);
  }
  return places;
}

constexpr int kClusters = 5, kNodesPerCluster = 7;

/// Nodes in clusters: a lane and a station on it, and others within a few lanes and 15 m along.
std::vector<MappedNode> nodes_of(const PairPlace& place) {
  const Site site = place.make();
  std::mt19937_64 random(place.seed * 7919 + 13);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  struct Station {
    std::size_t lane;
    double along, aside;
    bool backwards;
  };
  std::vector<Station> stations;
  for (int cluster = 0; cluster < kClusters; ++cluster) {
    const auto lane0 = static_cast<int>(unit(random) * static_cast<double>(site.lanes.size()));
    const double along0 = unit(random);
    for (int k = 0; k < kNodesPerCluster; ++k) {
      const int lane = std::clamp(lane0 + static_cast<int>(5 * unit(random)) - 2, 0,
                                  static_cast<int>(site.lanes.size()) - 1);
      const sim::Aisle& aisle = site.lanes[static_cast<std::size_t>(lane)];
      const double length = (aisle.to - aisle.from).norm();
      const double along = std::clamp(along0 * length + 24.0 * (unit(random) - 0.5), 0.5, length - 0.5);
      stations.push_back(
          {static_cast<std::size_t>(lane), along, 0.5 * (unit(random) - 0.5), unit(random) < 0.5});
    }
  }
  std::vector<MappedNode> nodes(stations.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < stations.size(); k = next++) {
      nodes[k] = map_node(site, site.lanes[stations[k].lane], stations[k].along, stations[k].aside,
                          stations[k].backwards, place.how, place.seed * 1000 + static_cast<unsigned>(k));
    }
  };
  auto other = std::async(std::launch::async, work);
  work();
  other.get();
  return nodes;
}

void make_maps(const std::filesystem::path& dir, const std::string& set) {
  for (const PairPlace& place : places_of(set)) {
    const auto path = dir / (place.name + ".maps");
    if (std::filesystem::exists(path)) continue;
    write_nodes(path, nodes_of(place));
    std::printf("%s\n", path.c_str());
  }
}

SpherizeConfig spherize_config() {
  SpherizeConfig config;
  if (const char* radius = std::getenv("RADIUS")) config.radius_m = std::stof(radius);
  if (const char* ground = std::getenv("GROUND")) config.ground_voxel_m = std::stof(ground);
  return config;
}

void make_clouds(const std::filesystem::path& dir, const std::string& set, const std::string& tag) {
  for (const PairPlace& place : places_of(set)) {
    std::vector<MappedNode> nodes = read_nodes(dir / (place.name + ".maps"));
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t k = next++; k < nodes.size(); k = next++) {
        const Eigen::Vector3f up =
            (nodes[k].T_enu_node.linear().transpose() * Eigen::Vector3d::UnitZ()).cast<float>();
        auto cloud = spherize(nodes[k].map, up, spherize_config());
        if (k == 0)
          std::printf("%s: %zu points, voxel %.2f, %zu bytes\n", place.name.c_str(), cloud->encoded,
                      static_cast<double>(cloud->voxel_m), cloud->bytes.size());
        nodes[k].map = std::move(cloud->decoded);
      }
    };
    auto other = std::async(std::launch::async, work);
    work();
    other.get();
    write_nodes(dir / (place.name + tag + ".clouds"), nodes);
  }
}

struct Tally {
  int pairs = 0, right = 0, wrong = 0, ambiguous_with = 0, ambiguous_without = 0, rejected = 0;
  std::vector<double> cpu_ms, translation_m, rotation_rad, nees;
  double squares[6] = {};
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}
double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

bool is_right(const Pose& truth, const Pose& T) {
  const Pose d = truth.inverse() * T;
  return d.translation().norm() < 0.5 && so3_log(d.linear()).norm() < 2.0 * std::numbers::pi / 180.0;
}

void count(const Pose& truth, const RegistrationResult& result, double cpu_ms, Tally& tally) {
  ++tally.pairs;
  tally.cpu_ms.push_back(cpu_ms);
  const bool in_set = std::any_of(result.modes.begin(), result.modes.end(),
                                  [&](const Mode& mode) { return is_right(truth, mode.T_target_source); });
  if (result.verdict == Verdict::rejected) ++tally.rejected;
  if (result.verdict == Verdict::ambiguous) ++(in_set ? tally.ambiguous_with : tally.ambiguous_without);
  if (result.verdict != Verdict::accepted) return;
  ++(is_right(truth, result.T_target_source) ? tally.right : tally.wrong);
  if (!is_right(truth, result.T_target_source)) return;
  const Vector6d error = se3_log(truth.inverse() * result.T_target_source);
  tally.translation_m.push_back(error.head<3>().norm());
  tally.rotation_rad.push_back(error.tail<3>().norm());
  tally.nees.push_back(error.dot(result.covariance.ldlt().solve(error)));
  for (int k = 0; k < 6; ++k) tally.squares[k] += error[k] * error[k];
}

void print(const std::string& name, const Tally& t) {
  std::printf(
      "%-18s %5d | %5d %5d | %5d %5d | %5d | %6.1f %6.1f | %6.1f %6.1f %6.1f | %5.2f %5.2f | %6.2f %6.2f |",
      name.c_str(), t.pairs, t.right, t.wrong, t.ambiguous_with, t.ambiguous_without, t.rejected,
      quantile(t.cpu_ms, 0.5), quantile(t.cpu_ms, 0.99), 1e3 * quantile(t.translation_m, 0.5),
      1e3 * quantile(t.translation_m, 0.9), 1e3 * quantile(t.translation_m, 0.99),
      57.3 * quantile(t.rotation_rad, 0.5), 57.3 * quantile(t.rotation_rad, 0.9), mean(t.nees) / 6.0,
      quantile(t.nees, 0.5) / 6.0);
  const double n = std::max<double>(1.0, static_cast<double>(t.nees.size()));
  for (int k = 0; k < 6; ++k) std::printf(" %.1f", 1e3 * std::sqrt(t.squares[k] / n));
  std::printf("\n");
}

std::string named(double sigma) {
  return sigma < 0.0    ? "elsewhere"
         : sigma == 0.0 ? "no prior"
                        : "sigma " + std::to_string(sigma).substr(0, 4);
}

/// The prior of a pair at the given sigma; nothing if the pair is not tried at it. A negative sigma gives the
/// prior of another place, 0 none.
struct PriorOfPair {
  bool tried = false;
  std::optional<Prior> prior;
};

PriorOfPair prior_of_pair(const MappedNode& a, const MappedNode& b, double sigma, std::size_t i,
                          std::size_t j, unsigned seed) {
  const double apart = (a.T_enu_node.inverse() * b.T_enu_node).translation().norm();
  if (sigma < 0.0) {
    if (apart < 95.0 || (i + j) % 5 != 0) return {};
    Pose elsewhere = b.T_enu_node;
    elsewhere.translation() = a.T_enu_node.translation() + Eigen::Vector3d(4.0, 7.0, 0.2);
    return {true, drawn_prior(a.T_enu_node, elsewhere, -sigma, 0.05, 0.02, seed)};
  }
  if (apart > 25.0) return {};
  if (sigma == 0.0) return {true, std::nullopt};
  return {true, drawn_prior(a.T_enu_node, b.T_enu_node, sigma, 0.05, 0.02, seed)};
}

void print_details(const Pose& truth, const RegistrationResult& result, std::size_t i, std::size_t j) {
  std::printf("  %zu %zu apart %.1f %s right %d excess %.3f modes %zu score %.4f %s\n", i, j,
              truth.translation().norm(), to_string(result.verdict),
              static_cast<int>(is_right(truth, result.T_target_source)), result.excess, result.modes.size(),
              result.modes.empty() ? 0.0 : result.modes[0].score, result.reason.c_str());
  for (std::size_t m = 0; m < std::min<std::size_t>(3, result.modes.size()); ++m) {
    const Pose d = truth.inverse() * result.modes[m].T_target_source;
    const Vector6d e = se3_log(d), sd = result.modes[m].covariance.diagonal().cwiseSqrt();
    std::printf(
        "      mode %zu weight %.4f score %.3f inl %.3f ovl %.3f rmse %.3f  error %.3f %.3f %.3f "
        "mrad %.2f %.2f %.2f sd %.3f %.3f %.3f mrad %.2f %.2f %.2f\n",
        m, result.modes[m].weight, result.modes[m].score, result.modes[m].inlier_fraction,
        result.modes[m].overlap, result.modes[m].rmse, e[0], e[1], e[2], 1e3 * e[3], 1e3 * e[4], 1e3 * e[5],
        sd[0], sd[1], sd[2], 1e3 * sd[3], 1e3 * sd[4], 1e3 * sd[5]);
  }
}

/// Tallies over all sites: by sigma, and by the similarity of the two clouds elsewhere (at 10 m).
struct Totals {
  std::map<std::string, Tally> by_sigma, by_similarity;
};

void count_alike(const MappedNode& a, const MappedNode& b, const Pose& truth,
                 const RegistrationResult& result, double cpu_ms, Totals& totals) {
  const double alike = SelfSimilarity(a.map, b.map, truth).up_to(20.0);
  const int tenth = std::min(static_cast<int>(10.0 * alike), 10);
  count(truth, result, cpu_ms, totals.by_similarity["alike " + std::to_string(0.1 * tenth).substr(0, 3)]);
}

Tally register_pairs(const PairPlace& place, const std::vector<MappedNode>& nodes,
                     const RegistrationConfig& config, double sigma, Totals& totals) {
  const MapDrift drift = MapDrift::straight(place.how.drift_m, place.how.drift_rad, place.how.reach_m);
  Tally tally;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < nodes.size(); ++j) {
      const unsigned seed = place.seed * 100000 + static_cast<unsigned>(i * 300 + j);
      const PriorOfPair pair = prior_of_pair(nodes[i], nodes[j], sigma, i, j, seed);
      if (!pair.tried) continue;
      const Pose truth = nodes[i].T_enu_node.inverse() * nodes[j].T_enu_node;
      const double start = thread_cpu_seconds();
      const auto result = register_clouds(nodes[i].map, nodes[j].map, config, pair.prior, {drift, drift});
      const double cpu_ms = 1e3 * (thread_cpu_seconds() - start);
      count(truth, result, cpu_ms, tally);
      count(truth, result, cpu_ms, totals.by_sigma["all, " + named(sigma)]);
      if (sigma == 10.0) count_alike(nodes[i], nodes[j], truth, result, cpu_ms, totals);
      if (std::getenv("DETAILS") != nullptr) print_details(truth, result, i, j);
    }
  }
  return tally;
}

void register_all(const std::filesystem::path& dir, const std::string& set, const std::string& tag) {
  RegistrationConfig config;
  if (const char* name = std::getenv("METHOD")) config.method = registration_method(name).value();
  std::printf(
      "site, sigma            n | right wrong | amb+  amb-  | rej.  | CPU 50/99 ms  | error 50/90/99 mm     "
      "| deg 50/90   | NEES/6 mean, median | rms xyz mm, mrad\n");
  Totals totals;
  const char* only_site = std::getenv("SITE");
  const char* only_sigma = std::getenv("SIGMA");
  for (const PairPlace& place : places_of(set)) {
    if (only_site != nullptr && place.name != only_site) continue;
    const std::vector<MappedNode> nodes = read_nodes(dir / (place.name + tag + ".clouds"));
    for (const double sigma : {1.5, 5.0, 10.0, -5.0, 0.0}) {
      if (only_sigma != nullptr && std::abs(std::stod(only_sigma) - sigma) > 0.1) continue;
      print(place.name + " " + named(sigma), register_pairs(place, nodes, config, sigma, totals));
      std::fflush(stdout);
    }
  }
  for (const auto& [name, tally] : totals.by_sigma) print(name, tally);
  for (const auto& [name, tally] : totals.by_similarity) print(name, tally);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "bench_registration_pairs maps|clouds|register DIR SET [TAG]\n");
    return 2;
  }
  const std::string step = argv[1], tag = argc > 4 ? argv[4] : "";
  if (step == "maps") make_maps(argv[2], argv[3]);
  if (step == "clouds") make_clouds(argv[2], argv[3], tag);
  if (step == "register") register_all(argv[2], argv[3], tag);
  return 0;
}
