#include "experiment/report_page.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "experiment/study_table.hpp"
#include "experiment/study_values.hpp"
#include "fleetmap/eval/html_page.hpp"
#include "fleetmap/eval/plot.hpp"

namespace fleetmap::apps::experiment {
namespace {

namespace fs = std::filesystem;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

void add_shapes(eval::HtmlPage& page, const std::vector<ShapeCheck>& checks) {
  if (checks.empty()) return;
  page.heading("Expected shapes");
  page.paragraph(
      "A shape holds when the last mean lies beyond the first in the expected direction, the least-squares "
      "line "
      "through the means goes there too, and no mean steps back from its neighbour by more than the seeds "
      "explain (97.5 % point of Student's t of the paired differences). p is the one-sided chance of such "
      "slopes "
      "without any trend; above 0.05 the shape holds weakly. falls_less_than_linearly also asks that the "
      "metric "
      "times the axis rises.");
  eval::Table table{{"study", "metric", "expected", "at", "verdict", "measured"}};
  for (const ShapeCheck& check : checks) {
    table.push_back(
        {check.study, check.expectation.metric,
         std::string(config::to_string(check.expectation.shape)) + " over " + check.expectation.over,
         check.at, to_string(check.verdict), check.detail});
  }
  page.table(table);
}

void add_failures(eval::HtmlPage& page, const Outcome& outcome) {
  if (std::ranges::all_of(outcome.records, &CaseRecord::done)) return;
  page.heading("Failed cases");
  for (const CaseRecord& record : outcome.records)
    if (!record.done()) page.details(record.of.name, record.reason);
}

bool has_numbers(const config::Axis& axis) {
  return std::ranges::none_of(axis.values, [](const config::AxisValue& value) {
    return value.label.find_first_not_of("0123456789.+-eE") != std::string::npos;
  });
}

/// Min-mean-max of a metric along the study's first axis, a line for each combination of the others.
std::string metric_lines(const config::Study& study, const std::vector<CaseRecord>& records,
                         const std::string& metric, eval::Axes axes) {
  std::vector<eval::LineSeries> lines;
  for (const Slice& slice : slices(study, 0)) {
    const SliceValues along = values_along(study, records, 0, slice, metric);
    eval::LineSeries line;
    line.name = slice.name;
    for (std::size_t k = 0; k < along.x.size(); ++k) {
      const Spread values = spread(along.values[k], axes.log_y);
      if (values.count == 0) continue;
      line.x.push_back(along.x[k]);
      line.y.push_back(values.mean);
      line.low.push_back(values.min);
      line.high.push_back(values.max);
    }
    lines.push_back(std::move(line));
  }
  return eval::line_plot(axes, lines);
}

/// The same where the first axis has names instead of numbers: means alone.
std::string metric_bars(const config::Study& study, const std::vector<CaseRecord>& records,
                        const std::string& metric, const eval::Axes& axes) {
  std::vector<std::string> groups;
  for (const config::AxisValue& value : study.axes.front().values) groups.push_back(value.label);
  std::vector<eval::Bars> bars;
  for (const Slice& slice : slices(study, 0)) {
    const SliceValues along = values_along(study, records, 0, slice, metric);
    eval::Bars means{slice.name, {}};
    for (const std::vector<double>& values : along.values)
      means.values.push_back(spread(values, axes.log_y).mean);
    bars.push_back(std::move(means));
  }
  return eval::bar_plot(axes, groups, bars);
}

void add_metric(eval::HtmlPage& page, const config::ExperimentConfig& config, const config::Study& study,
                const std::vector<CaseRecord>& records, const std::string& metric) {
  const config::MetricSpec* spec = config.metric(metric);
  const config::Axis& axis = study.axes.front();
  eval::Axes axes;
  axes.title = spec ? spec->title : metric;
  axes.x_label = with_unit(axis.name, axis.unit);
  axes.y_label = metric_title(config, metric);
  axes.log_y = spec && spec->log_scale;
  page.figure(has_numbers(axis) ? metric_lines(study, records, metric, axes)
                                : metric_bars(study, records, metric, axes));
}

const CaseRecord* first_done(const config::Study& study, const std::vector<CaseRecord>& records,
                             const std::vector<std::string>& point) {
  const auto found = records_at(study, records, point);
  const auto done = std::ranges::find_if(found, &CaseRecord::done);
  return done == found.end() ? nullptr : *done;
}

void add_histograms(eval::HtmlPage& page, const config::Study& study,
                    const std::vector<CaseRecord>& records) {
  for (const std::string& name : study.histograms) {
    // Only those with bins of the same width can be laid over each other.
    std::map<double, std::vector<eval::HistogramSeries>> by_width;
    for (const Slice& point : slices(study, study.axes.size())) {
      const CaseRecord* record = first_done(study, records, point.labels);
      if (!record) continue;
      const auto found = record->result->histograms.find(name);
      if (found == record->result->histograms.end()) continue;
      by_width[found->second.bin_width].push_back({point_name(point), found->second.shares});
    }
    for (const auto& [width, series] : by_width) {
      eval::Axes axes;
      axes.title = name + ", first seed";
      axes.x_label = name;
      axes.y_label = "share";
      axes.zero_based = true;
      page.figure(eval::histogram(axes, series, width));
    }
  }
}

void add_pictures(eval::HtmlPage& page, const config::Study& study, const std::vector<CaseRecord>& records,
                  const fs::path& directory) {
  for (const std::string& kind : study.pictures) {
    for (const Slice& point : slices(study, study.axes.size())) {
      const CaseRecord* record = first_done(study, records, point.labels);
      if (!record) continue;
      const auto picture = record->result->pictures.find(kind);
      if (picture == record->result->pictures.end()) continue;
      std::ifstream in(directory / "cases" / record->folder / picture->second, std::ios::binary);
      const std::vector<std::uint8_t> png{std::istreambuf_iterator<char>(in), {}};
      if (png.empty()) continue;
      page.picture(png, kind + ": " + point_name(point) + ", seed " + std::to_string(record->of.seed));
    }
  }
}

void add_study(eval::HtmlPage& page, const config::ExperimentConfig& config, const config::Study& study,
               const std::vector<CaseRecord>& records, const fs::path& directory) {
  page.heading(study.title);
  std::string text = study.name;
  if (!study.figure.empty()) text += ", " + study.figure + " of the paper";
  page.paragraph(text + "; seeds a point: " + std::to_string(study.seeds.size()) +
                 ". Lines and cells are means, bands and brackets run from least to greatest.");
  if (!study.axes.empty())
    for (const std::string& metric : study.metrics) add_metric(page, config, study, records, metric);
  page.table(study_table(config, study, records));
  add_histograms(page, study, records);
  add_pictures(page, study, records, directory);
}

}  // namespace

std::string report_page(const config::ExperimentConfig& config, const Outcome& outcome,
                        const std::vector<ShapeCheck>& checks, const fs::path& directory) {
  const auto done = std::ranges::count_if(outcome.records, &CaseRecord::done);
  eval::HtmlPage page(config.title);
  page.paragraph(std::to_string(done) + " of " + std::to_string(outcome.total) +
                 " cases came to their end, " +
                 std::to_string(outcome.records.size() - static_cast<std::size_t>(done)) +
                 " failed. Every case starts from " + config.base.filename().string() + ".");
  if (outcome.interrupted) page.paragraph("Interrupted: what follows is of the cases that were finished.");
  for (const std::string& line : absent_metrics(config, outcome.records))
    page.paragraph(line + "; the columns of results.csv are those that there are.");
  add_failures(page, outcome);
  add_shapes(page, checks);
  for (const config::Study& study : config.studies)
    add_study(page, config, study, outcome.records, directory);
  return page.str();
}

}  // namespace fleetmap::apps::experiment
