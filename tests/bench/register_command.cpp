// Runs `fleetmap register` on pairs of clouds from the twin, and on small_gicp_pair where it is installed, by
// both methods, with priors of 1.5 m and 5 m and without: right, wrong, refused, CPU time, error. A Markdown
// table.
//   bench_register_command [--seed S] [--program FLEETMAP] [--folder DIR]
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/made_world.hpp"
#include "registration/pair_worlds.hpp"
#include "support/process.hpp"
#include "support/shared_data.hpp"

namespace {

using namespace fleetmap;
using namespace fleetmap::registration::testing;

constexpr const char* kWorlds[] = {"farm_60", "farm_120", "rolling_60", "woodland_60"};
constexpr int kSeeds = 3, kPairsPerSeed = 5;       // of each world
constexpr double kNearest = 1.0, kFarthest = 8.0;  // m, from node to node
constexpr double kSigmaYawDeg = 3.0;
constexpr double kPriors[] = {1.5, 5.0, 0.0};  // m, sigma of each horizontal axis; 0: none
constexpr const char* kMethods[] = {"correlation", "paper"};

struct Pair {
  std::filesystem::path target, source;
  Pose T_target_source = Pose::Identity();  ///< the truth
  unsigned seed = 0;                        ///< of the priors' errors
};

Site site_of(const std::string& name, unsigned seed) {
  const auto file = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config/worlds" / (name + ".yaml");
  const auto world = config::make_world(file, seed);
  if (!world) throw std::runtime_error(world.error().message);
  return {name, sim::Scene::create((*world)->mesh()).value(),
          [world = *world](const Eigen::Vector2d& p) { return world->ground_height(p); }, (*world)->aisles()};
}

/// A place on a lane, where a robot stands.
struct Station {
  std::size_t lane = 0;
  double along = 0.0, aside = 0.0;  ///< m, from the lane's start; to its left

  Eigen::Vector2d in(const Site& site) const {
    const sim::Aisle& aisle = site.lanes[lane];
    const Eigen::Vector2d ahead = (aisle.to - aisle.from).normalized();
    return aisle.from + along * ahead + aside * Eigen::Vector2d(-ahead.y(), ahead.x());
  }
};

Station drawn_station(const Site& site, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Station station;
  station.lane = random() % site.lanes.size();
  station.along = unit(random) * (site.lanes[station.lane].to - site.lanes[station.lane].from).norm();
  station.aside = unit(random) - 0.5;
  return station;
}

/// The cloud that a robot sends over the radio after it drove past `station` and stopped there in any
/// heading.
MappedNode node_at(const Site& site, const Station& station, std::mt19937_64& random) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Gathering how;
  how.drift_m = 0.006, how.drift_rad = 0.0004;
  const bool backwards = random() % 2 == 0;
  MappedNode node = map_node(site, site.lanes[station.lane], station.along, station.aside, backwards, how,
                             static_cast<unsigned>(random()));
  const double yaw = std::uniform_real_distribution<double>(0.0, kTurn)(random);
  const Pose T_node_turned = make_pose(rotation_from_rpy(0.0, 0.0, yaw), Eigen::Vector3d::Zero());
  node.map = transformed(node.map, T_node_turned.inverse());
  node.T_enu_node = node.T_enu_node * T_node_turned;
  const Eigen::Vector3d up = node.T_enu_node.linear().transpose() * Eigen::Vector3d::UnitZ();
  node.map = registration::spherize(node.map, up.cast<float>(), {}).value().decoded;
  return node;
}

Pair drawn_pair(const Site& site, std::mt19937_64& random, const std::filesystem::path& stem) {
  for (;;) {
    const Station a = drawn_station(site, random), b = drawn_station(site, random);
    const double apart = (a.in(site)-b.in(site)).norm();
    if (apart < kNearest || apart > kFarthest) continue;
    const MappedNode target = node_at(site, a, random), source = node_at(site, b, random);
    Pair pair{stem.string() + "_target.ply", stem.string() + "_source.ply",
              target.T_enu_node.inverse() * source.T_enu_node, static_cast<unsigned>(random())};
    if (!cloud::write_cloud(pair.target, target.map) || !cloud::write_cloud(pair.source, source.map))
      throw std::runtime_error("cannot write " + stem.string());
    return pair;
  }
}

std::vector<Pair> pairs_of(const std::string& world, unsigned seed, const std::filesystem::path& folder) {
  std::vector<Pair> pairs;
  for (unsigned k = 0; k < kSeeds; ++k) {
    const Site site = site_of(world, seed + k);
    std::mt19937_64 random(seed + k);
    for (int n = 0; n < kPairsPerSeed; ++n)
      pairs.push_back(drawn_pair(site, random, folder / (world + std::to_string(pairs.size()))));
  }
  return pairs;
}

std::vector<Pair> recorded_pair(unsigned seed) {
  const auto folder = testing::shared_data("small_gicp_pair");
  if (!folder) return {};
  Pair pair{*folder / "target.ply", *folder / "source.ply", Pose::Identity(), seed};
  std::ifstream file(*folder / "T_target_source.txt");
  for (int i = 0; i < 16; ++i) file >> pair.T_target_source.matrix()(i / 4, i % 4);
  if (!file) throw std::runtime_error("cannot read the truth of small_gicp_pair");
  return {pair};
}

/// Arguments of a prior that errs by its sigma, twice as much in height; empty for none.
std::vector<std::string> drawn_prior_arguments(const Pair& pair, double sigma) {
  if (sigma == 0.0) return {};
  std::mt19937_64 random(pair.seed);
  std::normal_distribution<double> gauss;
  const Eigen::Matrix3d R = pair.T_target_source.linear();
  Eigen::Vector3d at = pair.T_target_source.translation();
  for (int k = 0; k < 3; ++k) at[k] += (k == 2 ? 2.0 : 1.0) * sigma * gauss(random);
  const double yaw_deg = std::atan2(R(1, 0), R(0, 0)) / kDegree + kSigmaYawDeg * gauss(random);
  const auto text = [](double value) { return std::to_string(value); };
  return {"--prior=" + text(at.x()) + "," + text(at.y()) + "," + text(at.z()) + "," + text(yaw_deg),
          "--sigma=" + text(sigma) + "," + text(kSigmaYawDeg)};
}

/// s, of all children that have ended.
double cpu_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Tally {
  int right = 0, wrong = 0, refused = 0;
  std::vector<double> cpu_ms, error_mm;  ///< of all; of the right ones
};

void count(const Pair& pair, const nlohmann::json& result, Tally& tally) {
  if (result.at("verdict") != "accepted") {
    ++tally.refused;
    return;
  }
  Pose T = Pose::Identity();
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) T.matrix()(r, c) = result.at("T_target_source").at(r).at(c);
  const PoseError error = error_between(pair.T_target_source, T);
  if (error.translation_m >= 0.5 || error.rotation_rad >= 2.0 * kDegree) {
    ++tally.wrong;
    return;
  }
  ++tally.right;
  tally.error_mm.push_back(1e3 * error.translation_m);
}

void register_pair(const std::string& program, const std::string& method, const Pair& pair, double sigma,
                   Tally& tally) {
  std::vector<std::string> command{program,
                                   "register",
                                   pair.source.string(),
                                   pair.target.string(),
                                   "--set",
                                   "registration.method=" + method};
  const auto prior = drawn_prior_arguments(pair, sigma);
  command.insert(command.end(), prior.begin(), prior.end());
  const double before = cpu_of_children();
  testing::Process process(command);
  const int exit_code = process.wait();
  tally.cpu_ms.push_back(1e3 * (cpu_of_children() - before));
  const std::string output = process.output();
  const std::size_t json = output.find("{\n");  // after the warning that a prior is not used
  if (exit_code != 0 || json == std::string::npos) throw std::runtime_error(output);
  count(pair, nlohmann::json::parse(output.substr(json)), tally);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// A row of the table; each cell holds a number for each prior.
void print(const std::string& name, std::size_t pairs, const char* method,
           const std::vector<Tally>& tallies) {
  const auto cell = [&](auto value_of) {
    std::string text;
    for (const Tally& tally : tallies) {
      if (!text.empty()) text += " / ";
      text += std::to_string(static_cast<int>(value_of(tally) + 0.5));
    }
    return text;
  };
  std::printf("|%s|%zu|%s|%s|%s|%s|%s|%s|\n", name.c_str(), pairs, method,
              cell([](const Tally& t) { return t.right; }).c_str(),
              cell([](const Tally& t) { return t.wrong; }).c_str(),
              cell([](const Tally& t) { return t.refused; }).c_str(),
              cell([](const Tally& t) { return median(t.cpu_ms); }).c_str(),
              cell([](const Tally& t) { return median(t.error_mm); }).c_str());
  std::fflush(stdout);
}

void register_all(const std::string& program, const std::string& name, const std::vector<Pair>& pairs) {
  if (pairs.empty()) return;
  for (const char* method : kMethods) {
    std::vector<Tally> tallies(std::size(kPriors));
    for (std::size_t k = 0; k < tallies.size(); ++k)
      for (const Pair& pair : pairs) register_pair(program, method, pair, kPriors[k], tallies[k]);
    print(name, pairs.size(), method, tallies);
  }
}

}  // namespace

int main(int argc, char** argv) {
  unsigned seed = 301;
  std::string program = std::string(FLEETMAP_BINARY_DIR) + "/bin/fleetmap";
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "bench_register_command";
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--seed") == 0) seed = static_cast<unsigned>(std::stoul(argv[i + 1]));
    if (std::strcmp(argv[i], "--program") == 0) program = argv[i + 1];
    if (std::strcmp(argv[i], "--folder") == 0) folder = argv[i + 1];
  }
  try {
    std::filesystem::create_directories(folder);
    std::printf(
        "With a prior of 1.5 m / of 5 m / with none; CPU of the command and error of the right ones: "
        "medians.\n\n");
    std::printf(
        "|pairs|number|method|right|wrong|refused|CPU ms|error mm|\n|---|---|---|---|---|---|---|---|\n");
    for (const char* world : kWorlds) register_all(program, world, pairs_of(world, seed, folder));
    register_all(program, "small_gicp_pair", recorded_pair(seed));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
