#include "study_plots.hpp"

#include <algorithm>
#include <map>

#include "fleetmap/eval/plot.hpp"
#include "study_table.hpp"
#include "study_values.hpp"

namespace fleetmap::experiment {
namespace {

/// A metric in a plot, and what its lines are called beside the other axes' values.
struct PlotMetric {
  std::string name;
  std::string label;
};

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

bool has_numbers(const config::Axis& axis) {
  return std::ranges::none_of(axis.values, [](const config::AxisValue& value) {
    return value.label.find_first_not_of("0123456789.+-eE") != std::string::npos;
  });
}

/// Whether the metric is drawn in the plot of another one that the study shows.
bool is_companion(const config::ExperimentConfig& config, const config::Study& study,
                  const std::string& metric) {
  const config::MetricSpec* spec = config.metric(metric);
  return spec && !spec->with.empty() && std::ranges::find(study.metrics, spec->with) != study.metrics.end();
}

std::vector<PlotMetric> metrics_of_plot(const config::ExperimentConfig& config, const config::Study& study,
                                        const std::string& metric) {
  const config::MetricSpec* spec = config.metric(metric);
  std::vector<PlotMetric> metrics{{metric, spec ? spec->series : ""}};
  for (const std::string& other : study.metrics) {
    const config::MetricSpec* candidate = config.metric(other);
    if (candidate && candidate->with == metric) metrics.push_back({other, candidate->series});
  }
  if (metrics.size() == 1) metrics.front().label.clear();
  return metrics;
}

std::string line_name(const Slice& slice, const PlotMetric& metric) {
  if (slice.name.empty() || metric.label.empty()) return slice.name + metric.label;
  return metric.label + ", " + slice.name;
}

std::string lines_of(const config::Study& study, const std::vector<CaseRecord>& records,
                     const std::vector<PlotMetric>& metrics, eval::Axes axes) {
  std::vector<eval::LineSeries> lines;
  for (const PlotMetric& metric : metrics) {
    for (const Slice& slice : slices(study, 0)) {
      const SliceValues along = values_along(study, records, 0, slice, metric.name);
      axes.x_ticks = along.x;
      eval::LineSeries line;
      line.name = line_name(slice, metric);
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
  }
  return eval::line_plot(axes, lines);
}

std::string bars_of(const config::Study& study, const std::vector<CaseRecord>& records,
                    const std::vector<PlotMetric>& metrics, const eval::Axes& axes) {
  std::vector<std::string> groups;
  for (const config::AxisValue& value : study.axes.front().values) groups.push_back(value.label);
  std::vector<eval::Bars> bars;
  for (const PlotMetric& metric : metrics) {
    for (const Slice& slice : slices(study, 0)) {
      const SliceValues along = values_along(study, records, 0, slice, metric.name);
      eval::Bars means{line_name(slice, metric), {}};
      for (const std::vector<double>& values : along.values)
        means.values.push_back(spread(values, axes.log_y).mean);
      bars.push_back(std::move(means));
    }
  }
  return eval::bar_plot(axes, groups, bars);
}

std::string plot_of(const config::ExperimentConfig& config, const config::Study& study,
                    const std::vector<CaseRecord>& records, const std::string& metric) {
  const config::MetricSpec* spec = config.metric(metric);
  const config::Axis& axis = study.axes.front();
  eval::Axes axes;
  axes.title = spec ? spec->title : metric;
  axes.x_label = with_unit(axis.title.empty() ? axis.name : axis.title, axis.unit);
  axes.y_label = metric_title(config, metric);
  axes.log_y = spec && spec->log_scale;
  axes.opaque = true;
  const auto metrics = metrics_of_plot(config, study, metric);
  return has_numbers(axis) ? lines_of(study, records, metrics, axes) : bars_of(study, records, metrics, axes);
}

/// Only those with bins of the same width can be laid over each other.
std::map<double, std::vector<eval::HistogramSeries>> histograms_of(const config::Study& study,
                                                                   const std::vector<CaseRecord>& records,
                                                                   const std::string& name) {
  std::map<double, std::vector<eval::HistogramSeries>> by_width;
  for (const Slice& point : slices(study, study.axes.size())) {
    const CaseRecord* record = first_done(study, records, point.labels);
    if (!record) continue;
    const auto found = record->result->histograms.find(name);
    if (found == record->result->histograms.end()) continue;
    by_width[found->second.bin_width].push_back({point_name(point), found->second.shares});
  }
  return by_width;
}

}  // namespace

std::vector<StudyPlot> study_plots(const config::ExperimentConfig& config, const config::Study& study,
                                   const std::vector<CaseRecord>& records) {
  std::vector<StudyPlot> plots;
  for (const std::string& metric : study.metrics) {
    if (study.axes.empty() || is_companion(config, study, metric)) continue;
    plots.push_back({file_name(study.name + "_" + metric), plot_of(config, study, records, metric)});
  }
  for (const std::string& name : study.histograms) {
    std::string file = file_name(study.name + "_" + name).append("_histogram");
    for (const auto& [width, series] : histograms_of(study, records, name)) {
      eval::Axes axes;
      axes.title = name + ", first seed";
      axes.x_label = name;
      axes.y_label = "share";
      axes.zero_based = true;
      axes.opaque = true;
      plots.push_back({file, eval::histogram(axes, series, width)});
      file += "_next";  // another width of the bins
    }
  }
  return plots;
}

}  // namespace fleetmap::experiment
