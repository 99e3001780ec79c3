#include "fleetmap/experiment/run_case.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "child_process.hpp"
#include "fleetmap/core/text_list.hpp"

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kLongestList = 8;  ///< longer lists are data, not metrics

std::vector<std::string> run_arguments(const Case& one, const fs::path& directory, unsigned threads) {
  std::vector<std::string> arguments{"run",
                                     "-c",
                                     one.base.string(),
                                     "--out",
                                     directory.string(),
                                     "--agents",
                                     std::to_string(one.agents),
                                     "--threads",
                                     std::to_string(threads)};
  for (const config::Override& entry : one.overrides) {
    arguments.emplace_back("--set");
    arguments.push_back(entry.key + "=" + entry.value);
  }
  return arguments;
}

/// The path of `key` within what lies at `path`.
std::string below(const std::string& path, const std::string& key) {
  std::string inner = path;
  if (!inner.empty()) inner += '.';
  return inner += key;
}

void add_numbers(const json& value, const std::string& path, CaseResult& result) {
  if (value.is_number()) {
    if (const double number = value.get<double>(); std::isfinite(number)) result.metrics[path] = number;
  } else if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) add_numbers(inner, below(path, key), result);
  } else if (value.is_array() && value.size() <= kLongestList) {
    for (std::size_t k = 0; k < value.size(); ++k)
      add_numbers(value[k], path + "[" + std::to_string(k) + "]", result);
  }
}

/// X_histogram beside X_bin.
void add_histograms(const json& value, const std::string& path, CaseResult& result) {
  static const std::string kEnd = "_histogram";
  if (!value.is_object()) return;
  for (const auto& [key, inner] : value.items()) {
    const std::string inner_path = below(path, key);
    add_histograms(inner, inner_path, result);
    if (!key.ends_with(kEnd) || !inner.is_array()) continue;
    const std::string stem = key.substr(0, key.size() - kEnd.size());
    Histogram histogram;
    if (const auto bin = value.find(stem + "_bin"); bin != value.end() && bin->is_number())
      histogram.bin_width = bin->get<double>();
    for (const json& share : inner) histogram.shares.push_back(share.is_number() ? share.get<double>() : 0.0);
    result.histograms[inner_path.substr(0, inner_path.size() - kEnd.size())] = std::move(histogram);
  }
}

void add_links(const json& report, CaseResult& result) {
  const auto links = report.find("links");
  if (links == report.end() || !links->is_array()) return;
  for (const json& row : *links) {
    if (!row.is_object()) continue;
    const std::string link = "links." + row.value("link", std::string("unknown"));
    for (const char* key : {"wire_bytes", "airtime_s"})
      if (row.contains(key) && row[key].is_number())
        result.metrics[link + "." + key] += row[key].get<double>();
  }
}

/// Pictures that the evaluation left, by the names of their files: map_error.png is "error".
void find_pictures(const fs::path& directory, CaseResult& result) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".png") continue;
    result.pictures[name.starts_with("map_") ? name.substr(4) : name] = entry.path().filename().string();
  }
}

}  // namespace

Result<json> read_json(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(file.filename().string() + " was not written");
  json content = json::parse(in, nullptr, false);
  if (content.is_discarded()) return failure(file.filename().string() + " is not JSON");
  return content;
}

CaseResult gather(const json& report, const json& evaluation) {
  CaseResult result;
  add_numbers(evaluation, "", result);
  add_histograms(evaluation, "", result);
  if (!report.is_object()) return result;
  for (const char* key : {"completion", "profile", "wall_time_s", "virtual_time_s"})
    if (report.contains(key)) add_numbers(report[key], key, result);
  add_links(report, result);
  return result;
}

Result<CaseResult> ChildEngine::operator()(const Case& one, const fs::path& directory) const {
  const auto ran = run_self(run_arguments(one, directory, threads_), directory / "run.log", *stop_);
  if (const Status good = check_exit(ran, "fleetmap run", directory / "run.log"); !good)
    return tl::unexpected(good.error());
  std::vector<std::string> evaluation_arguments{"eval", directory.string()};
  if (!one.pictures) evaluation_arguments.emplace_back("--no-pictures");
  std::string modes;
  for (const std::string& mode : one.modes) append_to_list(modes, mode, ",");
  evaluation_arguments.insert(evaluation_arguments.end(), {"--modes", modes.empty() ? "none" : modes});
  if (!one.overlap) evaluation_arguments.emplace_back("--no-overlap");
  const auto evaluated = run_self(evaluation_arguments, directory / "eval.log", *stop_);
  if (const Status good = check_exit(evaluated, "fleetmap eval", directory / "eval.log"); !good)
    return tl::unexpected(good.error());
  const auto report = read_json(directory / "report.json");
  if (!report) return tl::unexpected(report.error());
  const auto evaluation = read_json(directory / "evaluation.json");
  if (!evaluation) return tl::unexpected(evaluation.error());
  CaseResult result = gather(*report, *evaluation);
  find_pictures(directory, result);
  result.metrics["process.run_cpu_s"] = ran->cpu_seconds;
  result.metrics["process.run_peak_mb"] = ran->peak_megabytes;
  result.metrics["process.eval_cpu_s"] = evaluated->cpu_seconds;
  return result;
}

}  // namespace fleetmap::experiment
