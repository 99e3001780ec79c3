#include "fleetmap/experiment/experiment.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/experiment/progress_line.hpp"
#include "report_page.hpp"
#include "results_file.hpp"
#include "study_plots.hpp"
#include "study_table.hpp"
#include "study_values.hpp"

namespace fleetmap::experiment {
namespace {

bool met(const ShapeCheck& check) {
  return check.verdict == Verdict::kHolds || check.verdict == Verdict::kHoldsWeakly ||
         !check.expectation.required;
}

/// plots/NAME.svg: what report.html shows, for documents.
Status write_plots(const config::ExperimentConfig& config, const std::vector<CaseRecord>& records,
                   const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failure(directory.string() + ": " + error.message());
  for (const config::Study& study : config.studies) {
    for (const StudyPlot& plot : study_plots(config, study, records)) {
      const Status written = write_whole_file(directory / (plot.name + ".svg"), plot.svg);
      if (!written) return written;
    }
  }
  return {};
}

Status write_results(const config::ExperimentConfig& config, const Outcome& outcome,
                     const std::vector<ShapeCheck>& checks, const std::filesystem::path& directory) {
  const std::string json =
      results_json(config, outcome, checks).dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (const Status written = write_whole_file(directory / "results.json", json + "\n"); !written)
    return written;
  if (const Status written = write_whole_file(directory / "results.csv", results_csv(config, outcome));
      !written)
    return written;
  if (const Status written =
          write_whole_file(directory / "tables.md", markdown_tables(config, outcome.records));
      !written)
    return written;
  if (const Status written = write_plots(config, outcome.records, directory / "plots"); !written)
    return written;
  return write_whole_file(directory / "report.html", report_page(config, outcome, checks, directory));
}

void print_outcome(const ExperimentResult& result, const std::filesystem::path& directory,
                   std::ostream& out) {
  for (const ShapeCheck& check : result.checks) {
    out << (met(check) ? "  " : "! ") << check.study << (check.at.empty() ? "" : " at " + check.at) << ": "
        << check.expectation.metric << ' ' << config::to_string(check.expectation.shape) << " over "
        << check.expectation.over << (check.expectation.required ? "" : " (only reported)") << ": "
        << to_string(check.verdict) << " (" << check.detail << ")\n";
  }
  for (const CaseRecord& record : result.outcome.records)
    if (!record.done()) out << "! " << record.of.name << ": " << record.reason << '\n';
  for (const std::string& name : result.outcome.missing) out << "? " << name << ": not run\n";
  out << "report: " << (directory / "report.html").string() << '\n';
}

}  // namespace

bool ExperimentResult::good() const {
  return outcome.complete() && std::ranges::all_of(outcome.records, &CaseRecord::done) &&
         std::ranges::all_of(checks, met);
}

namespace {

Result<ExperimentResult> reported(const config::ExperimentConfig& config, Result<Outcome>&& outcome,
                                  const std::filesystem::path& directory, std::ostream& out) {
  if (!outcome) return tl::unexpected(outcome.error());
  ExperimentResult result;
  result.outcome = std::move(*outcome);
  result.checks = check_shapes(config, result.outcome.records);
  if (const Status written = write_results(config, result.outcome, result.checks, directory); !written)
    return tl::unexpected(written.error());
  for (const std::string& line : absent_metrics(config, result.outcome.records))
    out << "! " << line << "; the columns of results.csv are those that there are\n";
  print_outcome(result, directory, out);
  return result;
}

}  // namespace

Result<ExperimentResult> run_experiment(const config::ExperimentConfig& config, const Engine& engine,
                                        const RunnerConfig& runner, const std::atomic<bool>& stop,
                                        std::ostream& out, bool terminal) {
  ProgressLine line(out, terminal);
  auto outcome = run_cases(all_cases(config), engine, runner, stop,
                           [&line](const Progress& progress) { line.show(progress); });
  line.finish();
  return reported(config, std::move(outcome), runner.directory, out);
}

Result<ExperimentResult> report_experiment(const config::ExperimentConfig& config, const RunnerConfig& runner,
                                           std::ostream& out) {
  if (!is_folder(runner.directory / "cases"))
    return failure(runner.directory.string() + ": holds no cases; run some first, or correct --out");
  return reported(config, collect_cases(all_cases(config), runner), runner.directory, out);
}

}  // namespace fleetmap::experiment
