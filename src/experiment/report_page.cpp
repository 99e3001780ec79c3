#include "report_page.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "fleetmap/eval/html_page.hpp"
#include "study_plots.hpp"
#include "study_table.hpp"
#include "study_values.hpp"

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;

void add_shapes(eval::HtmlPage& page, const std::vector<ShapeCheck>& checks) {
  if (checks.empty()) return;
  page.heading("Expected shapes");
  page.paragraph(
      "A shape holds when the last mean lies beyond the first in the expected direction, the least-squares "
      "line "
      "through the means goes there too, and no mean steps back from its neighbour by more than the seeds "
      "explain: the 97.5 % point of Student's t times the standard error of a difference, from the residual "
      "variance of all points and seeds. p is the one-sided chance of such slopes without any trend; above "
      "0.05 "
      "the shape holds weakly. falls_less_than_linearly also asks that the metric times the axis rises. "
      "does_not_rise asks that no mean lies above the first by the stated amount or more, does_not_fall "
      "below; p is the chance of "
      "such means if one truly did. A shape that is only reported does not fail the experiment.");
  eval::Table table{{"study", "metric", "expected", "at", "verdict", "measured"}};
  for (const ShapeCheck& check : checks) {
    table.push_back({check.study, check.expectation.metric,
                     std::string(config::to_string(check.expectation.shape)) + " over " +
                         check.expectation.over + (check.expectation.required ? "" : " (only reported)"),
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

void add_missing(eval::HtmlPage& page, const Outcome& outcome) {
  if (outcome.complete()) return;
  std::string names;
  for (const std::string& name : outcome.missing) names += name + "\n";
  page.details("Not run", names);
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
  for (const StudyPlot& plot : study_plots(config, study, records)) page.figure(plot.svg);
  page.table(study_table(config, study, records));
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
  if (!outcome.complete()) {
    page.paragraph("Incomplete: " + std::to_string(outcome.missing.size()) +
                   " runs are still to be made, and what follows is of the cases that were finished.");
  }
  for (const std::string& line : absent_metrics(config, outcome.records))
    page.paragraph(line + "; the columns of results.csv are those that there are.");
  add_failures(page, outcome);
  add_missing(page, outcome);
  add_shapes(page, checks);
  for (const config::Study& study : config.studies)
    add_study(page, config, study, outcome.records, directory);
  return page.str();
}

}  // namespace fleetmap::experiment
