#include "study_table.hpp"

#include <algorithm>

#include "fleetmap/eval/plot.hpp"

namespace fleetmap::experiment {
namespace {

std::string spread_text(const Spread& values, std::size_t done) {
  if (values.count == 0) return "-";
  std::string text = eval::short_number(values.mean);
  if (values.count > 1)
    text += " [" + eval::short_number(values.min) + ", " + eval::short_number(values.max) + "]";
  if (values.count != done) text += " of " + std::to_string(values.count);
  return text;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += ' ';
    for (const char c : cell) row.append(c == '|' ? "\\|" : std::string(1, c));
    row += " |";
  }
  return row + "\n";
}

}  // namespace

std::string metric_title(const config::ExperimentConfig& config, const std::string& name) {
  const config::MetricSpec* metric = config.metric(name);
  if (!metric) return name;
  return metric->unit.empty() ? metric->title : metric->title + " [" + metric->unit + "]";
}

std::string point_name(const Slice& point) { return point.name.empty() ? "all" : point.name; }

std::vector<std::vector<std::string>> study_table(const config::ExperimentConfig& config,
                                                  const config::Study& study,
                                                  const std::vector<CaseRecord>& records) {
  std::vector<std::vector<std::string>> table{{""}, {"runs"}};
  for (const std::string& metric : study.metrics) table.push_back({metric_title(config, metric)});
  for (const Slice& point : slices(study, study.axes.size())) {
    const auto found = records_at(study, records, point.labels);
    const auto done = static_cast<std::size_t>(std::ranges::count_if(found, &CaseRecord::done));
    table[0].push_back(point_name(point));
    table[1].push_back(std::to_string(done) + " of " + std::to_string(study.seeds.size()));
    for (std::size_t k = 0; k < study.metrics.size(); ++k) {
      const config::MetricSpec* spec = config.metric(study.metrics[k]);
      const Spread values = spread(values_at(found, study.metrics[k]), spec && spec->log_scale);
      table[2 + k].push_back(spread_text(values, done));
    }
  }
  return table;
}

std::string markdown_tables(const config::ExperimentConfig& config, const std::vector<CaseRecord>& records) {
  std::string text = "# " + config.title + "\n\nMean [least, greatest] over the seeds.\n";
  for (const config::Study& study : config.studies) {
    text += "\n## " + study.title + " (`" + study.name + "`)\n\n";
    const auto table = study_table(config, study, records);
    text += markdown_row(table.front());
    text += markdown_row(std::vector<std::string>(table.front().size(), "---"));
    for (std::size_t k = 1; k < table.size(); ++k) text += markdown_row(table[k]);
  }
  return text;
}

}  // namespace fleetmap::experiment
