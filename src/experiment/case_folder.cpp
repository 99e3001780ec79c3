#include "case_folder.hpp"

#include <chrono>
#include <exception>
#include <set>
#include <utility>
#include <vector>

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;

/// Removes what is large and can be made again; reports, tables, pictures and logs stay.
void remove_large_files(const fs::path& directory) {
  constexpr std::uintmax_t kSmall = 256U << 10U;
  const std::set<std::string> kept{".json", ".png", ".svg", ".csv", ".log", ".yaml"};
  std::error_code error;
  std::vector<fs::path> large;
  for (fs::recursive_directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->is_regular_file(error) || kept.contains(entry->path().extension().string())) continue;
    const std::string extension = entry->path().extension().string();
    const bool database = extension == ".db" || extension == ".ply" || extension == ".mcap" ||
                          extension == ".db3" || extension == ".previews";
    if (database || entry->file_size(error) > kSmall) large.push_back(entry->path());
  }
  for (const fs::path& file : large) fs::remove(file, error);
}

}  // namespace

std::optional<CaseRecord> recorded(const RunnerConfig& config, const Case& one, const std::string& hash,
                                   LostPictures pictures) {
  return read_record(config.folder(one.name), one, hash, config.any_program ? std::string() : config.program,
                     pictures);
}

CaseRecord run_in_folder(const RunnerConfig& config, const Case& one, const std::string& hash,
                         const Engine& engine, const std::atomic<bool>& stop) {
  CaseRecord record;
  record.of = one;
  record.folder = one.name;
  record.hash = hash;
  record.program = config.program;
  const fs::path directory = config.folder(one.name);
  const auto start = std::chrono::steady_clock::now();
  try {
    fs::remove_all(directory);
    fs::create_directories(directory);
    auto result = engine(one, directory);
    if (result) {
      record.result = std::move(*result);
    } else {
      record.reason = result.error().message;
    }
  } catch (const std::exception& error) {
    record.reason = error.what();
  }
  record.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!config.keep) remove_large_files(directory);
  if (!record.done() && stop) return record;
  if (const Status written = write_record(directory, record); !written) {
    record.result.reset();
    record.reason = written.error().message;
  }
  return record;
}

}  // namespace fleetmap::experiment
