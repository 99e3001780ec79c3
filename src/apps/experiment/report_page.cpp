#include "experiment/report_page.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "experiment/chart.hpp"
#include "experiment/study_values.hpp"

namespace fleetmap::apps::experiment {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStyle =
    "<style>body{font-family:sans-serif;max-width:1440px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:3px "
    "8px;text-align:right}"
    "th{background:#f4f4f4}td:first-child,th:first-child{text-align:left}.holds{color:#2a7d2a}"
    ".holds_weakly{color:#946200}.violated,.no_data,.failed{color:#b00020;font-weight:600}"
    "td.words{text-align:left}.charts,.maps{display:flex;flex-wrap:wrap;gap:12px}figure{margin:0}"
    "figure img{max-width:340px;border:1px solid #ddd}figcaption{font-size:12px;color:#555}"
    "pre{white-space:pre-wrap;margin:0}</style>\n";

std::string base64(const std::string& bytes) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t block = 0;
    for (std::size_t j = 0; j < 3; ++j)
      block = block << 8U | (k + j < bytes.size() ? static_cast<std::uint8_t>(bytes[k + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j)
      out += k + j > bytes.size() ? '=' : kDigits[block >> (18U - 6U * j) & 63U];
  }
  return out;
}

std::string metric_title(const config::ExperimentConfig& config, const std::string& name) {
  const config::MetricSpec* metric = config.metric(name);
  if (!metric) return name;
  return metric->title + (metric->unit.empty() ? "" : " (" + metric->unit + ")");
}

std::string cell(const std::string& text, const char* attributes = "") {
  return std::string("<td") + attributes + ">" + escaped(text) + "</td>";
}

std::string shapes_table(const std::vector<ShapeCheck>& checks) {
  if (checks.empty()) return "";
  std::string html =
      "<h2>Expected shapes</h2>\n<p>A shape holds when the last mean lies beyond the first in the expected "
      "direction, the least-squares line through the means goes there too, and no mean steps back from its "
      "neighbour by more than the seeds explain (97.5 % point of Student's t of the paired differences). p "
      "is "
      "the one-sided chance of such slopes without any trend; above 0.05 it holds weakly.</p>\n<table><tr>"
      "<th>study</th><th>metric</th><th>shape</th><th>at</th><th>verdict</th><th>measured</th></tr>\n";
  for (const ShapeCheck& check : checks) {
    html +=
        "<tr>" + cell(check.study) + cell(check.expectation.metric) +
        cell(std::string(config::to_string(check.expectation.shape)) + " over " + check.expectation.over) +
        cell(check.at) + "<td class=\"" + to_string(check.verdict) + "\">" + to_string(check.verdict) +
        "</td>" + cell(check.detail, " class=\"words\"") + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string failures_table(const Outcome& outcome) {
  std::string rows;
  for (const CaseRecord& record : outcome.records) {
    if (!record.done())
      rows += "<tr>" + cell(record.of.name) + "<td class=\"words\"><pre>" + escaped(record.reason) +
              "</pre></td></tr>\n";
  }
  if (rows.empty()) return "";
  return "<h2 class=\"failed\">Failed cases</h2>\n<table><tr><th>case</th><th>why</th></tr>\n" + rows +
         "</table>\n";
}

/// A line for each combination of the other axes, along the study's first axis.
std::string metric_chart(const config::ExperimentConfig& config, const config::Study& study,
                         const std::vector<CaseRecord>& records, const std::string& metric) {
  const config::MetricSpec* spec = config.metric(metric);
  const config::Axis& axis = study.axes.front();
  BandChart chart;
  chart.title = spec ? spec->title : metric;
  chart.x_title = axis.name + (axis.unit.empty() ? "" : " (" + axis.unit + ")");
  chart.y_title = spec ? spec->unit : "";
  chart.log_scale = spec && spec->log_scale;
  for (const config::AxisValue& value : axis.values) chart.ticks.push_back({value.position, value.label});
  for (const Slice& slice : slices(study, 0)) {
    const SliceValues along = values_along(study, records, 0, slice, metric);
    BandLine line;
    line.name = slice.name;
    for (std::size_t k = 0; k < along.x.size(); ++k) {
      const Spread values = spread(along.values[k], chart.log_scale);
      if (values.count > 0) line.points.push_back({along.x[k], values.min, values.mean, values.max});
    }
    chart.lines.push_back(std::move(line));
  }
  return band_chart(chart);
}

std::string point_name(const config::Study& study, const std::vector<std::string>& labels) {
  std::string name;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const std::string& unit = study.axes[k].unit;
    name += (k > 0 ? ", " : "") + study.axes[k].name + "=" + labels[k] + (unit.empty() ? "" : " " + unit);
  }
  return name.empty() ? "all" : name;
}

std::string points_table(const config::ExperimentConfig& config, const config::Study& study,
                         const std::vector<CaseRecord>& records) {
  std::string html = "<table><tr><th>point</th><th>runs</th>";
  for (const std::string& metric : study.metrics)
    html += "<th>" + escaped(metric_title(config, metric)) + "</th>";
  html += "</tr>\n";
  for (const Slice& point : slices(study, study.axes.size())) {
    const auto found = records_at(study, records, point.labels);
    const auto done = std::ranges::count_if(found, [](const CaseRecord* record) { return record->done(); });
    html += "<tr>" + cell(point_name(study, point.labels)) +
            cell(std::to_string(done) + "/" + std::to_string(study.seeds.size()));
    for (const std::string& metric : study.metrics) {
      const config::MetricSpec* spec = config.metric(metric);
      std::vector<double> values;
      for (const CaseRecord* record : found) {
        if (!record->done()) continue;
        const auto value = record->result->metrics.find(metric);
        if (value != record->result->metrics.end()) values.push_back(value->second);
      }
      const Spread all = spread(values, spec && spec->log_scale);
      if (all.count == 0) {
        html += cell("-");
        continue;
      }
      std::string text = short_number(all.mean);
      if (all.count > 1) text += " [" + short_number(all.min) + ", " + short_number(all.max) + "]";
      if (all.count != static_cast<std::size_t>(done)) text += " of " + std::to_string(all.count);
      html += cell(text);
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

const CaseRecord* first_done(const config::Study& study, const std::vector<CaseRecord>& records,
                             const std::vector<std::string>& point) {
  for (const CaseRecord* record : records_at(study, records, point))
    if (record->done()) return record;
  return nullptr;
}

std::string histogram_charts(const config::Study& study, const std::vector<CaseRecord>& records) {
  std::string html;
  for (const std::string& name : study.histograms) {
    std::vector<NamedHistogram> curves;
    for (const Slice& point : slices(study, study.axes.size())) {
      const CaseRecord* record = first_done(study, records, point.labels);
      if (!record) continue;
      const auto histogram = record->result->histograms.find(name);
      if (histogram != record->result->histograms.end())
        curves.push_back({point_name(study, point.labels), histogram->second});
    }
    if (!curves.empty()) html += histogram_chart(name + ", first seed", curves);
  }
  return html.empty() ? "" : "<div class=\"charts\">" + html + "</div>\n";
}

std::string pictures(const config::Study& study, const std::vector<CaseRecord>& records,
                     const fs::path& directory) {
  std::string html;
  for (const std::string& kind : study.pictures) {
    std::string row;
    for (const Slice& point : slices(study, study.axes.size())) {
      const CaseRecord* record = first_done(study, records, point.labels);
      if (!record) continue;
      const auto picture = record->result->pictures.find(kind);
      if (picture == record->result->pictures.end()) continue;
      std::ifstream in(directory / "cases" / record->folder / picture->second, std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(in), {}};
      if (bytes.empty()) continue;
      row += "<figure><img alt=\"\" src=\"data:image/png;base64," + base64(bytes) + "\"><figcaption>" +
             escaped(point_name(study, point.labels)) + ", seed " + std::to_string(record->of.seed) +
             "</figcaption></figure>\n";
    }
    if (!row.empty()) html += "<h3>Map: " + escaped(kind) + "</h3>\n<div class=\"maps\">" + row + "</div>\n";
  }
  return html;
}

std::string study_section(const config::ExperimentConfig& config, const config::Study& study,
                          const std::vector<CaseRecord>& records, const fs::path& directory) {
  std::string html = "<h2>" + escaped(study.title) + "</h2>\n";
  html += "<p>" + escaped(study.name) +
          (study.figure.empty() ? "" : ", " + escaped(study.figure) + " of the paper") + "; " +
          std::to_string(study.seeds.size()) +
          " seed(s) a point. Lines and cells are means, bands and brackets run from least to greatest.</p>\n";
  if (!study.axes.empty()) {
    html += "<div class=\"charts\">";
    for (const std::string& metric : study.metrics) html += metric_chart(config, study, records, metric);
    html += "</div>\n";
  }
  return html + points_table(config, study, records) + histogram_charts(study, records) +
         pictures(study, records, directory);
}

}  // namespace

std::string report_page(const config::ExperimentConfig& config, const Outcome& outcome,
                        const std::vector<ShapeCheck>& checks, const fs::path& directory) {
  const auto failed =
      std::ranges::count_if(outcome.records, [](const CaseRecord& record) { return !record.done(); });
  std::string html = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" +
                     escaped(config.title) + "</title>\n" + kStyle + "<h1>" + escaped(config.title) +
                     "</h1>\n<p>" + std::to_string(outcome.records.size()) + " of " +
                     std::to_string(outcome.total) + " cases run, " + std::to_string(failed) +
                     " failed. Every case starts from " + escaped(config.base.filename().string()) +
                     ".</p>\n";
  if (outcome.interrupted)
    html += "<p class=\"failed\">Interrupted: what follows is of the cases that were finished.</p>\n";
  html += failures_table(outcome) + shapes_table(checks);
  for (const config::Study& study : config.studies)
    html += study_section(config, study, outcome.records, directory);
  return html + "</html>\n";
}

}  // namespace fleetmap::apps::experiment
