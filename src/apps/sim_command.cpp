#include <spdlog/spdlog.h>

#include <atomic>
#include <iostream>
#include <memory>
#include <thread>

#include "commands.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"
#include "fleetmap/wire/sensors.hpp"
#include "fleetmap/wire/topics.hpp"
#include "live_bus.hpp"
#include "options.hpp"
#include "sample_player.hpp"
#include "twin_results.hpp"
#include "twin_setup.hpp"
#include "twin_truth.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);
constexpr Duration kBatteryPeriod = std::chrono::seconds(1);
constexpr Duration kTooLate = std::chrono::milliseconds(500);

struct SimOptions {
  std::string config;
  std::string out;
  double duration = 0.0;
  std::vector<std::string> set;
};

/// One robot of the twin on its own onboard domain, in real time, with a thread of its own.
class LiveRobot {
 public:
  static Result<std::unique_ptr<LiveRobot>> create(const config::FleetConfig::Member& member,
                                                   const TwinSetup& setup,
                                                   std::shared_ptr<const sim::Scene> scene) {
    bus::DdsBusConfig dds = member.dds;
    // It stands for sensors and chassis: the radios are the agent's.
    dds.long_range.enabled = false;
    dds.short_range.enabled = false;
    auto bus = join_dds(dds);
    if (!bus) return tl::unexpected(bus.error());
    auto twin = sim::RobotTwin::create(setup.world, setup.origin, member.robot, (*bus)->now());
    if (!twin) return failure("agent " + member.agent.id.str() + ": " + twin.error().message);
    return std::unique_ptr<LiveRobot>(
        new LiveRobot(member, setup.origin, std::move(*bus), std::move(*twin), std::move(scene)));
  }
  ~LiveRobot() { stop(); }

  void start() {
    thread_ = std::thread([this] { bus_->run_until(stop_); });
  }
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    bus_->finish_work();
  }
  const std::string& name() const { return name_; }
  const std::vector<agent::StampedPose>& truth() const { return truth_.poses(); }
  double odometer() const { return twin_.odometer(); }

 private:
  LiveRobot(const config::FleetConfig::Member& member, const GeoPoint& origin,
            std::unique_ptr<bus::DdsBus> bus, sim::RobotTwin twin, std::shared_ptr<const sim::Scene> scene)
      : name_(member.agent.id.str()),
        names_(member.agent.perception.topics),
        site_(origin),
        bus_(std::move(bus)),
        twin_(std::move(twin)),
        scene_(std::move(scene)) {
    for (const bus::Topic& topic : sensor_topics(names_)) bus_->advertise(topic);
    bus_->advertise(wire::topics::battery());
    handles_.push_back(bus_->subscribe(wire::topics::cmd_vel(), [this](const Bytes& cdr) {
      if (const auto command = wire::decode<wire::VelocityCommand>(cdr))
        twin_.command(command->forward_speed, command->yaw_rate);
    }));
    if (twin_.config().guided) lead();
    handles_.push_back(bus_->every(kTick, {"twin", [this] { tick(); }}));
    handles_.push_back(bus_->every(kBatteryPeriod, [this] {
      bus_->publish(wire::topics::battery(),
                    wire::encode(sensor::Battery{bus_->now(), battery_share(twin_)}));
    }));
  }

  /// Tells the robot where it is.
  void lead() {
    bus_->advertise(wire::topics::guide_pose());
    handles_.push_back(bus_->every(kGuidePeriod, [this] {
      bus_->publish(wire::topics::guide_pose(), wire::encode(true_pose(twin_, site_)));
    }));
  }

  void publish(const recording::Sample& sample) {
    const EncodedSample encoded = encode(sample, names_);
    bus_->publish(encoded.topic, encoded.cdr);
  }

  void tick() {
    const Stamp now = bus_->now();
    if (now - twin_.now() > kTooLate && !std::exchange(late_, true)) {
      spdlog::warn("{}: the twin cannot keep real time on this machine; use fewer robots or lidar_rate 5",
                   name_);
    }
    for (sim::TwinSample& sample : twin_.advance(now)) {
      std::visit(
          [this](auto& s) {
            if constexpr (std::is_same_v<std::decay_t<decltype(s)>, sim::ScanJob>) {
              cast(std::move(s));
            } else {
              publish(s);
            }
          },
          sample);
    }
    truth_.follow(twin_);
  }

  void cast(sim::ScanJob job) {
    auto scan = std::make_shared<sensor::Scan>();
    bus_->offload(
        bus::Lane::kPerception,
        [this, scan, job = std::move(job)] { *scan = sim::cast_scan(*scene_, twin_.config().lidar, job); },
        [this, scan] { publish(*scan); });
  }

  std::string name_;
  agent::SensorTopics names_;
  LocalFrame site_;
  std::unique_ptr<bus::DdsBus> bus_;
  sim::RobotTwin twin_;
  std::shared_ptr<const sim::Scene> scene_;
  TruthTrack truth_;
  bool late_ = false;
  std::vector<bus::Handle> handles_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

int run(const SimOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  auto config = config::load_fleet(options.config, *overrides);
  if (!config) return report(config.error(), kBadConfiguration);
  if (!config->twin)
    return report({options.config + ": has no twin; expected world: {file: WORLD.yaml}"}, kBadConfiguration);
  const auto setup = set_up_twin(*config);
  if (!setup) return report(setup.error(), kBadConfiguration);
  if (!options.out.empty()) {
    if (const Status writable = make_writable(options.out); !writable)
      return report(writable.error(), kFailed);
    if (const Status drawn = write_site(options.out, *setup); !drawn) return report(drawn.error(), kFailed);
  }
  auto scene = sim::Scene::create(setup->world->mesh());
  if (!scene) return report(scene.error(), kFailed);
  std::vector<std::unique_ptr<LiveRobot>> robots;
  for (const auto& member : config->members) {
    auto robot = LiveRobot::create(member, *setup, *scene);
    if (!robot) return report(robot.error(), kBadConfiguration);
    robots.push_back(std::move(*robot));
  }
  for (const auto& robot : robots) robot->start();
  spdlog::info("twin of {} robots runs in real time; stop with Ctrl-C", robots.size());

  const std::atomic<bool>& stop = stop_on_signals();
  const auto begin = std::chrono::steady_clock::now();
  while (!stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    if (options.duration > 0.0 && elapsed.count() > options.duration) break;
  }
  for (const auto& robot : robots) robot->stop();
  for (const auto& robot : robots) {
    std::cout << robot->name() << " drove " << robot->odometer() << " m\n";
    if (options.out.empty()) continue;
    if (const Status written =
            write_truth(std::filesystem::path(options.out) / robot->name(), robot->truth());
        !written)
      return report(written.error(), kFailed);
  }
  if (!options.out.empty()) {
    if (const Status written = write_truth_cloud(options.out, *setup->world); !written)
      return report(written.error(), kFailed);
  }
  return kDone;
}

}  // namespace

void add_sim(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command =
      app.add_subcommand("sim", "the digital twin over DDS, in real time, for agents in other processes");
  command->add_option("-c,--config", options->config, "FLEET.yaml with world: {file: WORLD.yaml}")
      ->required();
  command->add_option("--out", options->out, "leave the truth there: NAME/truth.tum and truth.ply")
      ->check(some_path());
  command->add_option("--duration", options->duration, "s; end by itself")->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
