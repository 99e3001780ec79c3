#include "fleetmap/config/experiment_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "study_axes.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

constexpr std::uint32_t kMaxSeeds = 10'000;

std::vector<MetricSpec> read_metrics(Section& top) {
  std::vector<MetricSpec> metrics;
  for (Section& entry : top.list("metrics")) {
    MetricSpec metric;
    entry.read("name", metric.name);
    metric.title = metric.name;
    entry.read("title", metric.title);
    entry.read("unit", metric.unit);
    entry.read("log", metric.log_scale);
    entry.read("resolution", metric.resolution);
    entry.read("with", metric.with);
    entry.read("series", metric.series);
    if (!metric.with.empty() && std::ranges::find(metrics, metric.with, &MetricSpec::name) == metrics.end())
      entry.problem("with", "'" + metric.with + "' is not listed above");
    if (!(std::isfinite(metric.resolution) && metric.resolution >= 0.0))
      entry.problem("resolution", "must be >= 0: the metric's values are multiples of it");
    if (metric.log_scale && metric.resolution > 0.0)
      entry.problem("resolution", "a metric that is compared as logarithms has none; leave it out");
    entry.finish();
    if (metric.name.empty())
      entry.problem("name", "expected the metric's name in a case's result, e.g. map.rmse");
    if (std::ranges::find(metrics, metric.name, &MetricSpec::name) != metrics.end())
      entry.problem("name", "'" + metric.name + "' is listed above");
    metrics.push_back(std::move(metric));
  }
  return metrics;
}

std::optional<Shape> shape_named(const std::string& name) {
  for (const Shape shape : {Shape::kFalls, Shape::kRises, Shape::kFallsLessThanLinearly, Shape::kDoesNotRise,
                            Shape::kDoesNotFall})
    if (name == to_string(shape)) return shape;
  return std::nullopt;
}

void read_expectations(Section& section, Study& study, const std::vector<MetricSpec>& metrics) {
  for (Section& entry : section.list("expect")) {
    Expectation expectation;
    std::string shape;
    entry.read("metric", expectation.metric);
    entry.read("over", expectation.over);
    entry.read("shape", shape);
    entry.read("by", expectation.by);
    entry.read("required", expectation.required);
    entry.finish();
    if (std::ranges::find(metrics, expectation.metric, &MetricSpec::name) == metrics.end())
      entry.problem("metric", "'" + expectation.metric + "' is not listed under 'metrics' of the file");
    const auto axis = std::ranges::find(study.axes, expectation.over, &Axis::name);
    if (axis == study.axes.end()) {
      entry.problem("over", "'" + expectation.over + "' is not an axis of this study");
    } else if (axis->values.size() < 2) {
      entry.problem("over", "the axis '" + expectation.over + "' has a single value, so it has no shape");
    }
    const auto known = shape_named(shape);
    if (!known)
      entry.problem(
          "shape",
          "expected falls, rises, falls_less_than_linearly, does_not_rise or does_not_fall, found '" + shape +
              "'");
    const bool has_limit = known == Shape::kDoesNotRise || known == Shape::kDoesNotFall;
    if (has_limit && !(expectation.by > 0.0))
      entry.problem("by", shape + " needs the change that would matter, > 0 in the metric's unit");
    if (known && !has_limit && entry.has("by"))
      entry.problem("by", "only does_not_rise and does_not_fall have it");
    expectation.shape = known.value_or(Shape::kFalls);
    study.expectations.push_back(std::move(expectation));
  }
}

std::vector<std::uint64_t> seeds_up_to(std::uint32_t count) {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = 1; seed <= count; ++seed) seeds.push_back(seed);
  return seeds;
}

void read_seeds(Section& section, std::vector<std::uint64_t>& seeds) {
  if (!section.has("seeds")) return;
  std::uint32_t count = 1;
  section.read("seeds", count);
  if (count < 1 || count > kMaxSeeds) {
    section.problem("seeds", "expected how many runs of each point, 1 to " + std::to_string(kMaxSeeds));
    count = 1;
  }
  seeds = seeds_up_to(count);
}

/// Keeps only the listed values of each axis.
void read_kept_values(Section& quick, Study& study, bool apply) {
  Section keep = quick.section("keep");
  for (Axis& axis : study.axes) {
    std::vector<std::string> labels;
    keep.read(axis.name, labels);
    if (labels.empty()) continue;
    std::vector<AxisValue> kept;
    for (const std::string& label : labels) {
      const auto value = std::ranges::find(axis.values, label, &AxisValue::label);
      if (value == axis.values.end()) {
        keep.problem(axis.name, "'" + label + "' is not a value of this axis");
      } else if (std::ranges::find(kept, label, &AxisValue::label) == kept.end()) {
        kept.push_back(*value);
      }
    }
    std::ranges::stable_sort(kept, {}, &AxisValue::position);
    if (apply && !kept.empty()) axis.values = std::move(kept);
  }
  keep.finish();
}

/// False: the quick set leaves this study out.
bool read_quick(Section& section, Study& study, bool apply) {
  Section quick = section.section("quick");
  bool skip = false;
  quick.read("skip", skip);
  std::vector<std::uint64_t> seeds = study.seeds;
  read_seeds(quick, seeds);
  std::vector<Override> overrides;
  read_overrides(quick, "set", overrides);
  read_kept_values(quick, study, apply);
  quick.finish();
  if (!apply) return true;
  study.seeds = std::move(seeds);
  study.overrides.insert(study.overrides.end(), overrides.begin(), overrides.end());
  std::erase_if(study.expectations, [&](const Expectation& expectation) {
    const auto axis = std::ranges::find(study.axes, expectation.over, &Axis::name);
    return axis == study.axes.end() || axis->values.size() < 2;
  });
  return !skip;
}

void check_agents(Section& section, const Study& study, std::size_t available) {
  std::size_t max_agents = study.agents;
  const auto axis = std::ranges::find(study.axes, kAgentsAxis, &Axis::name);
  if (axis != study.axes.end())
    for (const AxisValue& value : axis->values) max_agents = std::max(max_agents, value.agents.value_or(0));
  if (available > 0 && max_agents > available) {
    section.problem(axis == study.axes.end() ? "agents" : "axes",
                    std::to_string(max_agents) + " robots are wanted, the fleet's file lists " +
                        std::to_string(available) + "; list more there");
  }
}

Study read_study(Section& section, const std::vector<MetricSpec>& metrics) {
  Study study;
  section.read("name", study.name);
  if (!is_name(study.name)) section.problem("name", "expected a name of letters, digits, '_' and '-'");
  study.title = study.name;
  section.read("title", study.title);
  section.read("figure", study.figure);
  std::uint32_t agents = 0;
  section.read("agents", agents);
  if (section.has("agents") && agents < 1) section.problem("agents", "expected a number of robots");
  study.agents = agents;
  study.seeds = seeds_up_to(1);
  read_seeds(section, study.seeds);
  read_overrides(section, "set", study.overrides);
  for (Section& entry : section.list("axes")) {
    Axis axis = read_axis(entry);
    if (std::ranges::find(study.axes, axis.name, &Axis::name) != study.axes.end())
      entry.problem("name", "'" + axis.name + "' is an axis above");
    if (axis.values.empty()) entry.problem("values", "expected at least one value");
    study.axes.push_back(std::move(axis));
  }
  section.read("metrics", study.metrics);
  for (const std::string& name : study.metrics) {
    if (std::ranges::find(metrics, name, &MetricSpec::name) == metrics.end())
      section.problem("metrics", "'" + name + "' is not listed under 'metrics' of the file");
  }
  section.read("histograms", study.histograms);
  section.read("pictures", study.pictures);
  read_expectations(section, study, metrics);
  return study;
}

/// 0: the file lists no agents, or cannot be read.
std::size_t agents_of(const std::filesystem::path& base) {
  const auto document = Document::load(base);
  if (!document) return 0;
  const YAML::Node& root = document->root();
  const YAML::Node agents = root["agents"];
  return agents.IsDefined() && agents.IsSequence() ? agents.size() : 0;
}

/// The fleet's file, and how many agents it lists.
std::size_t read_base(Section& section, std::filesystem::path& base) {
  section.read_path("base", base);
  if (!section.has("base")) return 0;
  if (const auto reason = unreadable(base)) {
    section.problem("base",
                    base.string() + ": " + *reason + "; give the FLEET.yaml that every case starts from");
    return 0;
  }
  const std::size_t agents = agents_of(base);
  if (agents == 0) section.problem("base", base.string() + " lists no agents");
  return agents;
}

}  // namespace

Result<ExperimentConfig> load_experiment(const std::filesystem::path& file, bool quick) {
  Result<Document> document = Document::load(file);
  if (!document) return tl::unexpected(document.error());
  ExperimentConfig config;
  Section top(*document, document->root(), "");
  config.title = file.stem().string();
  top.read("title", config.title);
  if (!top.has("base")) top.problem("base", "expected the FLEET.yaml that every case starts from");
  std::size_t agents = read_base(top, config.base);
  read_overrides(top, "set", config.overrides);
  top.read("seed_keys", config.seed_keys);
  config.seed_keys_at = top.place("seed_keys");
  config.metrics = read_metrics(top);

  Section quick_section = top.section("quick");
  std::filesystem::path quick_base = config.base;
  const std::size_t quick_agents = quick_section.has("base") ? read_base(quick_section, quick_base) : agents;
  std::vector<Override> quick_overrides;
  read_overrides(quick_section, "set", quick_overrides);
  quick_section.finish();
  if (quick) {
    config.base = quick_base;
    agents = quick_agents;
    config.overrides.insert(config.overrides.end(), quick_overrides.begin(), quick_overrides.end());
  }

  std::set<std::string> names;
  for (Section& entry : top.list("studies")) {
    Study study = read_study(entry, config.metrics);
    const bool wanted = read_quick(entry, study, quick);
    if (!names.insert(study.name).second) entry.problem("name", "'" + study.name + "' is a study above");
    if (wanted) check_agents(entry, study, agents);
    if (study.agents == 0) study.agents = agents;
    entry.finish();
    if (study.seeds.size() > 1 && config.seed_keys.empty())
      entry.problem("seeds",
                    "expected seed_keys at the top of the file: with none, every seed is the same run");
    if (wanted) config.studies.push_back(std::move(study));
  }
  if (names.empty()) top.problem("studies", "expected a list with at least one study");
  top.finish();
  if (const Status status = document->status(); !status) return tl::unexpected(status.error());
  return config;
}

}  // namespace fleetmap::config
