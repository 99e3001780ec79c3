#include "fleetmap/experiment/case_record.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::experiment {
namespace {

using nlohmann::json;

json overrides_json(const std::vector<config::Override>& overrides) {
  json list = json::array();
  for (const config::Override& entry : overrides) list.push_back(entry.key + "=" + entry.value);
  return list;
}

CaseResult result_from(const json& record) {
  CaseResult result;
  for (const auto& [name, value] : record.at("metrics").items()) result.metrics[name] = value.get<double>();
  for (const auto& [name, value] : record.at("histograms").items()) {
    result.histograms[name] = {value.at("bin_width").get<double>(),
                               value.at("shares").get<std::vector<double>>()};
  }
  for (const auto& [kind, file] : record.at("pictures").items()) {
    result.pictures[kind] = file.get<std::string>();
  }
  return result;
}

bool pictures_are_there(const std::filesystem::path& directory, const CaseResult& result) {
  std::error_code error;
  for (const auto& [kind, file] : result.pictures) {
    if (!std::filesystem::is_regular_file(directory / file, error)) return false;
  }
  return true;
}

}  // namespace

json to_json(const CaseRecord& record) {
  json out{{"case", record.of.name},
           {"study", record.of.study},
           {"point", record.of.point},
           {"seed", record.of.seed},
           {"base", record.of.base.string()},
           {"agents", record.of.agents},
           {"set", overrides_json(record.of.overrides)},
           {"folder", record.folder},
           {"hash", record.hash},
           {"program", record.program},
           {"wall_s", record.wall_seconds},
           {"status", record.done() ? "done" : "failed"}};
  if (!record.done()) {
    out["reason"] = record.reason;
    return out;
  }
  out["metrics"] = json::object();
  for (const auto& [name, value] : record.result->metrics) {
    if (std::isfinite(value)) out["metrics"][name] = value;
  }
  out["histograms"] = json::object();
  for (const auto& [name, histogram] : record.result->histograms) {
    if (!std::ranges::all_of(histogram.shares, [](double share) { return std::isfinite(share); })) continue;
    out["histograms"][name] = {{"bin_width", histogram.bin_width}, {"shares", histogram.shares}};
  }
  out["pictures"] = json::object();
  for (const auto& [kind, file] : record.result->pictures) out["pictures"][kind] = file;
  return out;
}

Status write_record(const std::filesystem::path& directory, const CaseRecord& record) {
  const std::string text = to_json(record).dump(1, ' ', false, json::error_handler_t::replace);
  return write_whole_file(directory / "result.json", text + "\n");
}

std::optional<CaseRecord> read_record(const std::filesystem::path& directory, const Case& one,
                                      const std::string& hash, const std::string& program,
                                      LostPictures pictures) {
  std::ifstream in(directory / "result.json", std::ios::binary);
  if (!in) return std::nullopt;
  const json record = json::parse(in, nullptr, false);
  try {
    if (record.at("hash") != hash) return std::nullopt;
    CaseRecord found;
    found.of = one;
    found.hash = hash;
    found.folder = directory.filename().string();
    found.program = record.at("program").get<std::string>();
    if (!program.empty() && found.program != program) return std::nullopt;
    found.wall_seconds = record.at("wall_s").get<double>();
    found.reused = true;
    if (record.at("status") != "done") {
      found.reason = record.at("reason").get<std::string>();
      return found;
    }
    found.result = result_from(record);
    if (pictures == LostPictures::kRunAgain && !pictures_are_there(directory, *found.result))
      return std::nullopt;
    return found;
  } catch (const json::exception&) {
    return std::nullopt;  // cut off, or written by something else: the case is run again
  }
}

}  // namespace fleetmap::experiment
