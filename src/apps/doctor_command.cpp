// `fleetmap doctor`: listens to a robot's sensors as its agent would, beside it or before it runs.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "live_bus.hpp"
#include "live_devices.hpp"
#include "machine_check.hpp"
#include "options.hpp"
#include "sample_check.hpp"
#include "sample_player.hpp"
#include "stream_summary.hpp"

namespace fleetmap::apps {
namespace {

struct DoctorOptions {
  std::string config;
  double seconds = 30.0;
  std::vector<std::string> set;
};

/// Hears all sensors of a robot.
class Listener {
 public:
  Listener(const agent::PerceptionConfig& config, bus::DdsBus& bus)
      : config_(config), bus_(bus), check_({}, config), mounts_(config) {
    subscriptions_.push_back(bus.subscribe(ros_codec::topics::tf_static(), [this](const Bytes& cdr) {
      const auto transforms = ros_codec::decode_transforms(cdr);
      if (!transforms) return void(++refused_["/tf_static: " + transforms.error().message]);
      mounts_.add(*transforms);
    }));
    const std::vector<bus::Topic> topics = sensor_topics(config.topics);
    subscriptions_.push_back(bus.subscribe(topics[0], [this, name = topics[0].name](const Bytes& cdr) {
      add(ros_codec::decode<sensor::Scan>(cdr), cdr, name);
    }));
    listen<sensor::Imu>(topics[1]);
    listen<sensor::Fix>(topics[2]);
    listen<sensor::Wheel>(topics[3]);
  }
  const StreamSummary& streams() const { return streams_; }
  std::vector<std::string> mounts() const { return mounts_.summaries(); }
  std::vector<std::string> findings() {
    std::vector<std::string> all = check_.take_warnings();
    std::ranges::move(mounts_.take_warnings(), std::back_inserter(all));
    for (const auto& [what, count] : refused_)
      all.push_back(what + " (" + std::to_string(count) + " messages)");
    return all;
  }

 private:
  template <class T>
  void listen(const bus::Topic& topic) {
    subscriptions_.push_back(bus_.subscribe(
        topic, [this, name = topic.name](const Bytes& cdr) { add(ros_codec::decode<T>(cdr), cdr, name); }));
  }
  template <class T>
  void add(Result<T> decoded, const Bytes& cdr, const std::string& topic) {
    if (!decoded) {
      ++refused_[topic + ": " + decoded.error().message];
      return;
    }
    recording::Sample sample(std::move(*decoded));
    streams_.add(sample);
    const auto source = static_cast<sensor::Source>(sample.index());
    if (!place(source, ros_codec::frame_id_of(cdr).value_or(""))) return;
    check_.admit(sample, bus_.now());
  }
  /// False while the sensor's mount is not known.
  bool place(sensor::Source source, const std::string& frame_id) {
    const auto state = mounts_.on_message(source, frame_id, bus_.now());
    if (state != agent::SensorMounts::State::kDecided) return state == agent::SensorMounts::State::kKnown;
    mounts_.apply_to(config_, source);
    check_.set_mounts(config_);
    return true;
  }

  agent::PerceptionConfig config_;
  bus::DdsBus& bus_;
  SampleCheck check_;
  agent::SensorMounts mounts_;
  StreamSummary streams_;
  std::map<std::string, std::size_t> refused_;  ///< by reason
  std::vector<bus::Handle> subscriptions_;
};

int examine(const DoctorOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  auto robot = config::load_robot(options.config, *overrides);
  if (!robot) return report(robot.error(), kBadConfiguration);
  bus::DdsBusConfig dds = robot->dds;
  dds.long_range.enabled = dds.short_range.enabled = false;
  dds.agent = free_name("doctor", robot->agent.exchange.fleet);
  auto bus = join_dds(dds);
  if (!bus) return report(bus.error(), kBadConfiguration);
  robot->agent.perception.frame_patience = agent::kFramePatience;
  Listener listener(robot->agent.perception, **bus);
  // Its agent receives there if it runs, and publishes the scans.
  const auto lidar = publish_velodyne(robot->agent.perception, **bus);
  if (!lidar) spdlog::info("{}", lidar.error().message);
  // gpsd would serve the agent and this program, so that each fix came twice.
  agent::PerceptionConfig perception = robot->agent.perception;
  if (perception.devices.gpsd) spdlog::info("gps.gpsd: heard where the agent runs");
  perception.devices.gpsd.reset();
  const auto devices = publish_devices(perception, **bus);
  std::cout << "listening for " << options.seconds << " s; drive a turn, so that units of turn rates show\n";
  (*bus)->run_until([] { return stop_on_signals().load(); }, from_seconds(options.seconds));
  listener.streams().print(std::cout);
  for (const std::string& mount : listener.mounts()) std::cout << mount << '\n';
  std::vector<std::string> findings = listener.findings();
  std::ranges::move(machine_findings(machine_state(robot->agent.directory)), std::back_inserter(findings));
  if (listener.streams().scans() == 0) {
    findings.insert(findings.begin(), "no scan on " + robot->agent.perception.topics.points +
                                          ": is the driver on, with ROS_DOMAIN_ID=" +
                                          std::to_string(dds.onboard.domain) + " (dds.onboard.domain)?");
  }
  for (const std::string& finding : findings) std::cout << "- " << finding << '\n';
  if (findings.empty()) std::cout << "nothing found\n";
  return findings.empty() ? kDone : kFailed;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand("doctor",
                                         "listens to a robot's sensors and says what is wrong with their "
                                         "clocks, units, rates and mounts; exit code "
                                         "1 if anything is");
  command->add_option("-c,--config", options->config, "AGENT.yaml")->required();
  command->add_option("--seconds", options->seconds, "how long to listen")->check(CLI::PositiveNumber);
  command->add_option("--set", options->set, "key=value")->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = examine(*options); });
}

}  // namespace fleetmap::apps
