#include "results_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "study_values.hpp"

namespace fleetmap::experiment {
namespace {

using nlohmann::json;

json finite(double value) { return std::isfinite(value) ? json(value) : json(); }

json check_json(const ShapeCheck& check) {
  return {{"study", check.study},
          {"metric", check.expectation.metric},
          {"over", check.expectation.over},
          {"shape", config::to_string(check.expectation.shape)},
          {"required", check.expectation.required},
          {"at", check.at},
          {"verdict", to_string(check.verdict)},
          {"x", check.x},
          {"means", check.means},
          {"change", finite(check.change)},
          {"p", finite(check.p)},
          {"tolerance", finite(check.tolerance)},
          {"seeds", check.seeds},
          {"seeds_planned", check.seeds_planned},
          {"detail", check.detail}};
}

json spread_json(const Spread& spread) {
  return {{"count", spread.count},
          {"min", spread.min},
          {"mean", spread.mean},
          {"max", spread.max},
          {"deviation", spread.deviation}};
}

json points_json(const config::ExperimentConfig& config, const config::Study& study,
                 const std::vector<CaseRecord>& records) {
  json points = json::array();
  for (const Slice& point : slices(study, study.axes.size())) {
    json entry{{"point", point.labels}, {"metrics", json::object()}};
    const auto found = records_at(study, records, point.labels);
    for (const std::string& metric : study.metrics) {
      const config::MetricSpec* spec = config.metric(metric);
      if (const Spread all = spread(values_at(found, metric), spec && spec->log_scale); all.count > 0)
        entry["metrics"][metric] = spread_json(all);
    }
    points.push_back(std::move(entry));
  }
  return points;
}

/// With the comma before it.
std::string csv_field(const std::string& text) {
  std::string field(1, ',');
  if (text.find_first_of(",\"\n\r") == std::string::npos) return field.append(text);
  field += '"';
  for (const char c : text) field.append(c == '"' ? 2 : 1, c);
  field += '"';
  return field;
}

std::string csv_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::vector<std::string> axis_names(const config::ExperimentConfig& config) {
  std::vector<std::string> names;
  for (const config::Study& study : config.studies)
    for (const config::Axis& axis : study.axes)
      if (axis.name != "agents" && std::ranges::find(names, axis.name) == names.end())
        names.push_back(axis.name);
  return names;
}

std::string axis_label(const config::ExperimentConfig& config, const Case& one, const std::string& axis) {
  const auto study = std::ranges::find(config.studies, one.study, &config::Study::name);
  if (study == config.studies.end()) return "";
  for (std::size_t k = 0; k < study->axes.size() && k < one.point.size(); ++k)
    if (study->axes[k].name == axis) return one.point[k];
  return "";
}

}  // namespace

json results_json(const config::ExperimentConfig& config, const Outcome& outcome,
                  const std::vector<ShapeCheck>& checks) {
  json out{{"title", config.title},      {"base", config.base.string()}, {"cases_planned", outcome.total},
           {"missing", outcome.missing}, {"studies", json::array()},     {"shapes", json::array()},
           {"cases", json::array()}};
  for (const config::Study& study : config.studies) {
    json axes = json::array();
    for (const config::Axis& axis : study.axes) {
      json values = json::array();
      for (const config::AxisValue& value : axis.values) values.push_back(value.label);
      axes.push_back({{"name", axis.name}, {"unit", axis.unit}, {"values", values}});
    }
    out["studies"].push_back({{"name", study.name},
                              {"title", study.title},
                              {"figure", study.figure},
                              {"axes", axes},
                              {"seeds", study.seeds},
                              {"points", points_json(config, study, outcome.records)}});
  }
  for (const ShapeCheck& check : checks) out["shapes"].push_back(check_json(check));
  for (const CaseRecord& record : outcome.records) out["cases"].push_back(to_json(record));
  return out;
}

std::string results_csv(const config::ExperimentConfig& config, const Outcome& outcome) {
  std::set<std::string> metrics;
  for (const CaseRecord& record : outcome.records)
    if (record.done())
      for (const auto& [name, value] : record.result->metrics) metrics.insert(name);
  const std::vector<std::string> axes = axis_names(config);
  std::string csv = "case,study,agents";
  for (const std::string& axis : axes) csv += csv_field(axis);
  csv += ",seed,status,wall_s";
  for (const std::string& metric : metrics) csv += csv_field(metric);
  csv += "\n";
  for (const CaseRecord& record : outcome.records) {
    csv += record.of.name;
    csv += csv_field(record.of.study) + ',';
    csv += std::to_string(record.of.agents);
    for (const std::string& axis : axes) csv += csv_field(axis_label(config, record.of, axis));
    csv += ',';
    csv += std::to_string(record.of.seed) + (record.done() ? ",done," : ",failed,") +
           csv_number(record.wall_seconds);
    for (const std::string& metric : metrics) {
      csv += ',';
      if (!record.done()) continue;
      const auto value = record.result->metrics.find(metric);
      if (value != record.result->metrics.end() && std::isfinite(value->second))
        csv += csv_number(value->second);
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace fleetmap::experiment
