#include "fleetmap/experiment/runner.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <numeric>
#include <optional>
#include <thread>

#include "case_folder.hpp"
#include "case_groups.hpp"
#include "fleetmap/core/file_lock.hpp"

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;

/// Held as long as cases are run in a directory: exclusively by run_cases(), shared by single cases.
Result<FileLock> lock_directory(const fs::path& directory, FileLock::Kind kind) {
  std::error_code error;
  fs::create_directories(directory / "cases", error);
  if (error) return failure(directory.string() + ": " + error.message());
  auto lock = FileLock::try_lock(directory / ".lock", kind);
  if (!lock) return tl::unexpected(lock.error());
  if (!*lock) {
    return failure(directory.string() +
                   ": another experiment is at work here; wait for it or choose another --out");
  }
  return std::move(**lock);
}

/// Result of an earlier start of the group: done by any of its cases, else failed.
std::optional<CaseRecord> recorded(const RunnerConfig& config, const std::vector<Case>& cases,
                                   const CaseGroup& group, LostPictures pictures = LostPictures::kRunAgain) {
  std::optional<CaseRecord> failed;
  for (const std::size_t k : group.cases) {
    auto found = recorded(config, cases[k], group.hash, pictures);
    if (found && found->done()) return found;
    if (!failed) failed = std::move(found);
  }
  return failed;
}

/// `records[k]` is of `cases[k]`, empty: not run.
Outcome outcome_of(const std::vector<Case>& cases, const std::vector<CaseGroup>& groups,
                   std::vector<std::optional<CaseRecord>>&& records) {
  Outcome outcome;
  outcome.total = cases.size();
  for (const CaseGroup& group : groups) {
    if (!records[group.cases.front()]) outcome.missing.push_back(cases[group.cases.front()].name);
  }
  for (std::optional<CaseRecord>& record : records) {
    if (record) outcome.records.push_back(std::move(*record));
  }
  return outcome;
}

class Runner {
 public:
  Runner(const std::vector<Case>& cases, const Engine& engine, const RunnerConfig& config,
         const std::atomic<bool>& stop, const std::function<void(const Progress&)>& on_progress)
      : cases_(cases),
        engine_(engine),
        config_(config),
        stop_(stop),
        on_progress_(on_progress),
        records_(cases.size()) {}

  Result<Outcome> run() {
    auto groups = grouped(cases_);
    if (!groups) return tl::unexpected(groups.error());
    groups_ = std::move(*groups);
    progress_.total = cases_.size();
    take_finished();
    begin_ = std::chrono::steady_clock::now();
    {
      std::vector<std::jthread> workers;
      const std::size_t count = std::min<std::size_t>(std::max(1U, config_.jobs), waiting_.size());
      for (std::size_t k = 0; k < count; ++k) workers.emplace_back([this] { work(); });
    }
    return outcome_of(cases_, groups_, std::move(records_));
  }

 private:
  /// Puts the others in line: every point's first seed first, so that an interrupt leaves a thin but complete
  /// picture; of them the large fleets first, so that no long case is left for the end.
  void take_finished() {
    for (const CaseGroup& group : groups_) {
      if (!take(group)) waiting_.push_back(&group);
    }
    std::ranges::stable_sort(waiting_, [this](const CaseGroup* a, const CaseGroup* b) {
      const Case &x = cases_[a->cases.front()], &y = cases_[b->cases.front()];
      return x.seed != y.seed ? x.seed < y.seed : x.agents > y.agents;
    });
    on_progress_(progress_);
  }

  bool take(const CaseGroup& group) {
    const auto found = recorded(config_, cases_, group);
    if (!found || !found->done()) return false;
    finish_group(group, *found);
    progress_.reused += group.cases.size();
    return true;
  }

  void finish_group(const CaseGroup& group, const CaseRecord& record) {
    for (const std::size_t k : group.cases) {
      records_[k] = record;
      records_[k]->of = cases_[k];
    }
    progress_.finished += group.cases.size();
    if (!record.done()) progress_.failed += group.cases.size();
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (next_ < waiting_.size() && !stop_) {
      const CaseGroup& group = *waiting_[next_++];
      const Case& one = cases_[group.cases.front()];
      progress_.running.push_back(one.name);
      report_progress(nullptr);
      lock.unlock();
      const CaseRecord record = run_in_folder(config_, one, group.hash, engine_, stop_);
      lock.lock();
      std::erase(progress_.running, one.name);
      if (!record.done() && stop_) return;  // ended by the interrupt, not by a fault of its own
      finish_group(group, record);
      weight_done_ += static_cast<double>(one.agents);
      report_progress(&record);
    }
  }

  /// A case takes about as long as it has agents.
  void report_progress(const CaseRecord* ended) {
    progress_.ended = ended;
    if (weight_done_ > 0.0) {
      const double left = std::accumulate(
          waiting_.begin() + static_cast<std::ptrdiff_t>(next_), waiting_.end(),
          0.5 * static_cast<double>(progress_.running.size()), [this](double sum, const CaseGroup* group) {
            return sum + static_cast<double>(cases_[group->cases.front()].agents);
          });
      const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
      progress_.seconds_left = spent / weight_done_ * left;
    }
    on_progress_(progress_);
    progress_.ended = nullptr;
  }

  const std::vector<Case>& cases_;
  const Engine& engine_;
  const RunnerConfig& config_;
  const std::atomic<bool>& stop_;
  const std::function<void(const Progress&)>& on_progress_;
  std::vector<CaseGroup> groups_;
  std::vector<const CaseGroup*> waiting_;
  std::chrono::steady_clock::time_point begin_;

  std::mutex mutex_;  ///< of everything below, once the workers are at work
  std::size_t next_ = 0;
  double weight_done_ = 0.0;
  Progress progress_;
  std::vector<std::optional<CaseRecord>> records_;
};

}  // namespace

Result<Outcome> run_cases(const std::vector<Case>& cases, const Engine& engine, const RunnerConfig& config,
                          const std::atomic<bool>& stop,
                          const std::function<void(const Progress&)>& on_progress) {
  const auto lock = lock_directory(config.directory, FileLock::Kind::kExclusive);
  if (!lock) return tl::unexpected(lock.error());
  return Runner(cases, engine, config, stop, on_progress).run();
}

Result<CaseRecord> run_single_case(const std::vector<Case>& cases, std::size_t index, const Engine& engine,
                                   const RunnerConfig& config, const std::atomic<bool>& stop) {
  const auto directory_lock = lock_directory(config.directory, FileLock::Kind::kShared);
  if (!directory_lock) return tl::unexpected(directory_lock.error());
  const auto groups = grouped(cases);
  if (!groups) return tl::unexpected(groups.error());
  const auto group = std::ranges::find_if(*groups, [index](const CaseGroup& candidate) {
    return std::ranges::find(candidate.cases, index) != candidate.cases.end();
  });
  const Case& one = cases[index];
  // Beside the case's folder, which is emptied when the case begins.
  const auto lock =
      FileLock::try_lock(config.directory / "cases" / (one.name + ".lock"), FileLock::Kind::kExclusive);
  if (!lock) return tl::unexpected(lock.error());
  if (!*lock) return failure(one.name + ": another process is running this case");
  if (auto found = recorded(config, cases, *group); found && found->done()) {
    found->of = one;
    return std::move(*found);
  }
  CaseRecord record = run_in_folder(config, one, group->hash, engine, stop);
  if (!record.done() && stop) return failure(one.name + ": interrupted; the same command runs it again");
  return record;
}

Result<Outcome> collect_cases(const std::vector<Case>& cases, const RunnerConfig& config) {
  const auto groups = grouped(cases);
  if (!groups) return tl::unexpected(groups.error());
  std::vector<std::optional<CaseRecord>> records(cases.size());
  for (const CaseGroup& group : *groups) {
    const auto found = recorded(config, cases, group, LostPictures::kLeftOut);
    if (!found) continue;
    for (const std::size_t k : group.cases) {
      records[k] = found;
      records[k]->of = cases[k];
    }
  }
  return outcome_of(cases, *groups, std::move(records));
}

}  // namespace fleetmap::experiment
