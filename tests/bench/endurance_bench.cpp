// Measures the cost of a robot's exchange, store and loop closing after 20,000 own nodes (24 hours at one
// node every 4.3 s), in virtual time with light clouds: the table of docs/results/performance.md.
//   bench_endurance [ROBOTS [NODES]]    3 robots, 20000 nodes each
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "bench/process_use.hpp"
#include "draws.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fault_injection/exchange_fleet.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "store/items.hpp"
#include "synthetic_survey.hpp"

namespace {

using namespace fleetmap;
using bench::files_mb;
using bench::resident_mb;
using fault_injection::Draws;
using fault_injection::Packet;
using messages::Reach;

constexpr Duration kTick = std::chrono::milliseconds(100);  // five of an agent's FleetLink
constexpr double kSpacing = 6.0;                            // m between nodes
constexpr double kSpeed = kSpacing * 20'000 / 86'400.0;     // m/s
constexpr double kApart = 1'000.0;                          // m, from robot to robot along the path
constexpr double kRow = 1'000.0, kRowSpacing = 12.0;        // m
constexpr int kRows = 84;                                   // 1 km2; the whole path takes 17 h
/// Robots are within each other's Wi-Fi for the last five minutes of every hour.
constexpr Duration kHour = std::chrono::hours(1), kMeeting = std::chrono::minutes(5);
constexpr Duration kRegistration = std::chrono::seconds(1);
constexpr double kLoss = 0.05;
constexpr double kSigma = 0.7, kOdometrySigma = 0.02;  // m, of GPS and of the odometry from node to node
constexpr std::size_t kPoints = 50;                    // of a submap
constexpr std::uint64_t kSeed = 1;

/// ENU, rows driven to and fro and back to the first one.
Pose on_path(double s) {
  constexpr double kStep = kRow + kRowSpacing, kBack = (kRows - 1) * kRowSpacing;
  s = std::fmod(s, (kRows - 1) * kStep + kRow + kBack);
  const int row = static_cast<int>(s / kStep);
  const double at = s - row * kStep;
  const bool east = row % 2 == 0;
  Eigen::Vector3d p(std::min(at, kRow), row * kRowSpacing + std::max(at - kRow, 0.0), 0.0);
  double yaw = at < kRow ? 0.0 : std::numbers::pi / 2.0;
  if (!east) {
    p.x() = kRow - p.x();
    yaw = std::numbers::pi - yaw;
  }
  if (const double back = s - ((kRows - 1) * kStep + kRow); back > 0.0) {
    p = {0.0, kBack - back, 0.0};
    yaw = -std::numbers::pi / 2.0;
  }
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw), p);
}

Matrix6d covariance(double sigma) {
  Vector6d variances;
  variances << 1.0, 1.0, 1.0, 0.01, 0.01, 0.01;
  return Matrix6d(sigma * sigma * variances.asDiagonal());
}

Bytes random_bytes(Draws& draws, std::size_t size) {
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(draws.bits());
  return bytes;
}

/// Robots that drive the same rows one after the other: each node lies where the others' nodes lie.
class Endurance : private fault_injection::ExchangeFleet {
 public:
  Endurance(std::size_t robots, std::uint32_t nodes, const std::filesystem::path& folder)
      : ExchangeFleet(folder, fleet_of(robots), kTick), nodes_(nodes), begun_(now()), draws_(kSeed, 1) {
    for (const AgentId& name : config_.fleet) {
      const Status started = start(name, {}, {}, [](store::Store&) { return Result<std::uint16_t>(0); });
      if (!started) throw std::runtime_error(started.error().message);
    }
  }
  ~Endurance() override { close_stores(); }

  /// Until every robot has made so many nodes.
  void run_until(std::uint32_t nodes) {
    while (made_ < std::min(nodes, nodes_)) {
      step();
      for (const auto& [name, entry] : robots()) {
        Robot& robot = this->robot(name);
        robot.events.clear();
        robot.received.clear();
      }
      make_nodes();
      register_pairs();
    }
  }

  const Robot& first() const { return robots().begin()->second; }
  double hours() const { return to_seconds(now() - begun_) / 3600.0; }
  double seconds_of_placement() const {
    const store::Store& store = *first().store;
    const auto nodes = output::nodes_of(store);
    const auto alignments = output::alignments_of(store);
    double seconds = 0.0;
    {
      const CpuTimer timer(seconds);
      graph::compute_placement(nodes, alignments, site_, {});
    }
    return seconds;
  }

 private:
  struct Job {
    Stamp due;
    AgentId robot;
    exchange::NodePair pair;
  };

  static exchange::ExchangeConfig fleet_of(std::size_t robots) {
    exchange::ExchangeConfig config;
    for (std::size_t k = 0; k < robots; ++k)
      config.fleet.push_back(AgentId::parse("r" + std::to_string(k + 1)).value());
    config.payload_size = [](const messages::Message& message) {
      return fleet_codec::encode(message).size();
    };
    return config;
  }

  Pose T_enu(const NodeId& id) const {
    return on_path(kApart * (std::stod(id.agent.str().substr(1)) - 1.0) + kSpacing * id.seq);
  }

  void make_nodes() {
    if (to_seconds(now() - begun_) * kSpeed < kSpacing * made_) return;
    for (const AgentId& name : config_.fleet) {
      const NodeId id{name, made_};
      Bytes submap = random_bytes(draws_, kPoints * 3 * sizeof(float));
      graph::Node node;
      node.id = id;
      node.stamp = now();
      const Pose T = T_enu(id);
      node.T_odom_base = T_enu({name, 0}).inverse() * T;
      if (made_ > 0) node.odom_covariance = covariance(kOdometrySigma);
      node.G.emplace();
      node.G->stamp = node.stamp;
      node.G->position = site_.to_geo(
          T.translation() + kSigma * Eigen::Vector3d(draws_.normal(), draws_.normal(), draws_.normal()));
      node.G->q_enu_base = Eigen::Quaterniond(T.linear());
      node.G->covariance = covariance(kSigma);
      node.descriptor = random_bytes(draws_, 160);
      node.submap_hash = content_hash(submap);
      node.submap_bytes = static_cast<std::uint32_t>(submap.size());
      const auto put = robot(name).exchange->on_own_node(fleet_codec::quantised(node).value(), submap, now());
      if (!put || *put != store::Put::kAdded) throw std::runtime_error(to_string(id) + " is not stored");
    }
    ++made_;
  }

  void register_pairs() {
    for (; !jobs_.empty() && jobs_.front().due <= now(); jobs_.pop_front()) {
      const Job& job = jobs_.front();
      Robot& robot = this->robot(job.robot);
      graph::Alignment alignment;
      alignment.i = job.pair.ours;
      alignment.j = job.pair.theirs;
      alignment.computed_by = job.robot;
      alignment.seq = robot.store->next_alignment_seq(0);
      graph::AlignmentMode& mode = alignment.modes.front();
      mode.T_i_j = T_enu(alignment.i).inverse() * T_enu(alignment.j);
      mode.rmse = 0.1;
      mode.inlier_fraction = 0.8;
      mode.score = 0.7;
      mode.covariance = covariance(kOdometrySigma);
      const auto put = robot.exchange->on_own_alignment(fleet_codec::quantised(alignment).value(), now());
      if (!put || *put != store::Put::kAdded) robot.cloud_client->on_rejected(job.pair, now());
    }
  }

  void on_sent(const Packet&) override {}
  std::vector<Duration> arrivals(const Packet& packet, const AgentId&) override {
    const Duration of_hour = (now() - begun_) % kHour;
    if (packet.outgoing.reach == Reach::kShortRange && of_hour < kHour - kMeeting) return {};
    if (draws_.chance(kLoss)) return {};
    return {kTick};
  }
  void on_event(const AgentId&, Robot& robot, const exchange::Event& event) override {
    if (const auto* needed = std::get_if<exchange::CloudNeeded>(&event)) {
      const Status provided = robot.exchange->provide_cloud(
          needed->node, fault_injection::SyntheticSurvey::cloud_around(needed->node), now());
      if (!provided) throw std::runtime_error(provided.error().message);
    }
  }
  void on_received(const AgentId& name, Robot&, const loop_closure::ReceivedCloud& received) override {
    jobs_.push_back({now() + kRegistration, name, received.candidate.pair()});
  }

  std::uint32_t nodes_;
  Stamp begun_;
  LocalFrame site_{geo_point_from_degrees(49.0, 8.4, 110.0)};
  Draws draws_;
  std::uint32_t made_ = 0;  ///< by each robot
  std::deque<Job> jobs_;
};

void measure(std::size_t robots, std::uint32_t nodes) {
  const testing::TemporaryFolder folder;
  Endurance fleet(robots, nodes, folder / "");
  const auto count = static_cast<double>(robots);
  std::printf(
      "| own nodes | hours | nodes, alignments, submaps held | CPU ms a node | RSS MB a robot | kB a node "
      "held | "
      "store, log MB | placement ms |\n|---|---|---|---|---|---|---|---|\n");
  constexpr std::uint32_t kSlice = 1000;
  const double empty_mb = resident_mb();
  for (std::uint32_t at = kSlice; at <= nodes; at += kSlice) {
    const double before = process_cpu_seconds();
    fleet.run_until(at);
    const double cpu_ms = 1e3 * (process_cpu_seconds() - before) / kSlice / count;
    const double mb = (resident_mb() - empty_mb) / count;
    const store::Store& store = *fleet.first().store;
    const auto held = static_cast<double>(store.nodes().size());
    const bool shown = at == kSlice || at % 5000 == 0;
    std::printf("| %u | %.1f | %zu, %zu, %zu | %.2f | %.0f | %.2f | %.0f, %.1f | %.0f |\n", at, fleet.hours(),
                store.nodes().size(), store.alignments().size(), store.submap_set().size(), cpu_ms, mb,
                1e3 * mb / held, files_mb(folder / "", ".db") / count,
                files_mb(folder / "", ".db-wal") / count, shown ? 1e3 * fleet.seconds_of_placement() : 0.0);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  measure(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 3,
          argc > 2 ? static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)) : 20'000);
}
