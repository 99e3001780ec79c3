#include "fleetmap/experiment/field_engine.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "child_process.hpp"
#include "field_measures.hpp"
#include "fleetmap/config/field_config.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/input_fingerprint.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/experiment/run_case.hpp"

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFieldKeys = "field.";
constexpr int kSkipped = 77;

bool is_of_field(const config::Override& entry) { return entry.key.starts_with(kFieldKeys); }

}  // namespace

Result<FieldEngine::Recordings> FieldEngine::recordings_of(const Case& one,
                                                           const config::FieldConfig& field) const {
  if (!field.recordings.empty()) return Recordings{field.recordings, field.truth};
  const auto inputs = config::input_fingerprint(one.base, {});
  if (!inputs) return tl::unexpected(inputs.error());
  // Another file, or the same one after an edit, has other recordings.
  const std::string robots = std::to_string(one.agents);
  const std::string name = robots + "-" + inputs->substr(0, 8);
  const fs::path bags = directory_ / ("recordings-" + name), run = directory_ / ("recorded-" + name);
  if (is_there(run / "report.json")) return Recordings{bags, run};
  fs::remove_all(bags);  // of a start that was interrupted
  fs::remove_all(run);
  const fs::path log = directory_ / ("recorded-" + name + ".log");
  const auto ended = run_self(
      {"run", "-c", one.base.string(), "--agents", robots, "--record", bags.string(), "--out", run.string()},
      log, *stop_);
  if (const Status good = check_exit(ended, "fleetmap run --record", log); !good)
    return tl::unexpected(good.error());
  return Recordings{bags, run};
}

Status FieldEngine::run_field(const Case& one, const config::FieldConfig& field, const Recordings& recordings,
                              const fs::path& directory) const {
  std::vector<std::string> arguments{"--scenario",   "trial",
                                     "--agents",     std::to_string(one.agents),
                                     "--recordings", absolute_path(recordings.bags),
                                     "--out",        absolute_path(directory)};
  const std::vector<std::string> options = config::field_options(field);
  arguments.insert(arguments.end(), options.begin(), options.end());
  for (const config::Override& entry : one.overrides) {
    if (is_of_field(entry)) continue;
    arguments.emplace_back("--set");
    arguments.push_back(entry.key + "=" + entry.value);
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  arguments.insert(arguments.end(), {"--program", program.string()});
  const fs::path log = directory / "field.log";
  const auto ended = run_program(script_, arguments, log, *stop_);
  if (ended && ended->code == kSkipped) return failure(tail_of(log, 1));
  return check_exit(ended, script_.string(), log);
}

Result<CaseResult> FieldEngine::operator()(const Case& one, const fs::path& directory) const {
  const auto fleet = config::load_fleet(one.base, one.overrides);
  if (!fleet) return tl::unexpected(fleet.error());
  if (fleet->field.robot.empty()) {
    return failure(
        "field.robot: expected the AGENT.yaml with the sensors of the recordings; config/agents/twin.yaml "
        "has those "
        "of config/fleets/farm_small.yaml");
  }
  const auto recordings = recordings_of(one, fleet->field);
  if (!recordings) return tl::unexpected(recordings.error());
  if (const Status ran = run_field(one, fleet->field, *recordings, directory); !ran)
    return tl::unexpected(ran.error());
  auto measures = field_measures(directory);
  if (!measures) return tl::unexpected(measures.error());
  CaseResult result;
  if (!recordings->truth.empty()) {
    const fs::path log = directory / "eval.log";
    const auto evaluated =
        run_self({"eval", directory.string(), "--truth-trajectories", recordings->truth.string(), "--modes",
                  "none", "--no-overlap", "--no-pictures"},
                 log, *stop_);
    if (const Status good = check_exit(evaluated, "fleetmap eval", log); !good)
      return tl::unexpected(good.error());
    const auto evaluation = read_json(directory / "evaluation.json");
    if (!evaluation) return tl::unexpected(evaluation.error());
    result = gather({}, *evaluation);
  }
  result.metrics.merge(*measures);
  return result;
}

}  // namespace fleetmap::experiment
