#include "experiment/runner.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <thread>

namespace fleetmap::apps::experiment {
namespace {

namespace fs = std::filesystem;

/// Held as long as cases are run in a directory.
class DirectoryLock {
 public:
  static Result<DirectoryLock> take(const fs::path& directory) {
    const fs::path file = directory / ".lock";
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0) return failure(file.string() + ": cannot be written; choose another --out");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      ::close(descriptor);
      return failure(directory.string() +
                     ": another experiment is at work here; wait for it or choose another --out");
    }
    return DirectoryLock(descriptor);
  }
  DirectoryLock(DirectoryLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  DirectoryLock& operator=(DirectoryLock&&) = delete;
  ~DirectoryLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  explicit DirectoryLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

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
    const bool database =
        extension == ".db" || extension == ".ply" || extension == ".mcap" || extension == ".db3";
    if (database || entry->file_size(error) > kSmall) large.push_back(entry->path());
  }
  for (const fs::path& file : large) fs::remove(file, error);
}

/// Cases with equal inputs: one run serves them all.
struct Group {
  std::vector<std::size_t> cases;
  std::string hash;
};

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
    if (const Status grouped = group_cases(); !grouped) return tl::unexpected(grouped.error());
    progress_.total = cases_.size();
    take_finished();
    begin_ = std::chrono::steady_clock::now();
    {
      std::vector<std::jthread> workers;
      const std::size_t count = std::min<std::size_t>(std::max(1U, config_.jobs), waiting_.size());
      for (std::size_t k = 0; k < count; ++k) workers.emplace_back([this] { work(); });
    }
    Outcome outcome;
    outcome.total = cases_.size();
    for (std::optional<CaseRecord>& record : records_) {
      if (record) outcome.records.push_back(std::move(*record));
    }
    outcome.interrupted = outcome.records.size() < outcome.total;
    return outcome;
  }

 private:
  fs::path folder(const std::string& name) const { return config_.directory / "cases" / name; }

  Status group_cases() {
    std::map<std::string, std::size_t> known;
    for (std::size_t k = 0; k < cases_.size(); ++k) {
      const auto hash = input_hash(cases_[k]);
      if (!hash) return tl::unexpected(hash.error());
      const auto [entry, is_new] = known.emplace(*hash, groups_.size());
      if (is_new) groups_.push_back({{}, *hash});
      groups_[entry->second].cases.push_back(k);
    }
    return {};
  }

  /// Puts the others in line: every point's first seed first, so that an interrupt leaves a thin but complete
  /// picture; of them the large fleets first, so that no long case is left for the end.
  void take_finished() {
    for (const Group& group : groups_) {
      if (!take(group)) waiting_.push_back(&group);
    }
    std::ranges::stable_sort(waiting_, [this](const Group* a, const Group* b) {
      const Case &x = cases_[a->cases.front()], &y = cases_[b->cases.front()];
      return x.seed != y.seed ? x.seed < y.seed : x.agents > y.agents;
    });
    on_progress_(progress_);
  }

  bool take(const Group& group) {
    for (const std::size_t k : group.cases) {
      const auto found = finished_record(folder(cases_[k].name), cases_[k], group.hash,
                                         config_.any_program ? std::string() : config_.program);
      if (!found) continue;
      settle(group, *found);
      progress_.reused += group.cases.size();
      return true;
    }
    return false;
  }

  void settle(const Group& group, const CaseRecord& record) {
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
      const Group& group = *waiting_[next_++];
      const Case& one = cases_[group.cases.front()];
      progress_.running.push_back(one.name);
      tell(nullptr);
      lock.unlock();
      const CaseRecord record = run_one(one, group.hash);
      lock.lock();
      std::erase(progress_.running, one.name);
      if (!record.done() && stop_) return;  // ended by the interrupt, not by a fault of its own
      settle(group, record);
      weight_done_ += static_cast<double>(one.agents);
      tell(&record);
    }
  }

  CaseRecord run_one(const Case& one, const std::string& hash) const {
    CaseRecord record;
    record.of = one;
    record.folder = one.name;
    record.hash = hash;
    record.program = config_.program;
    const fs::path directory = folder(one.name);
    const auto start = std::chrono::steady_clock::now();
    try {
      fs::remove_all(directory);
      fs::create_directories(directory);
      auto result = engine_(one, directory);
      if (result) {
        record.result = std::move(*result);
      } else {
        record.reason = result.error().message;
      }
    } catch (const std::exception& error) {
      record.reason = error.what();
    }
    record.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!config_.keep) remove_large_files(directory);
    if (!record.done() && stop_) return record;
    if (const Status written = write_record(directory, record); !written) {
      record.result.reset();
      record.reason = written.error().message;
    }
    return record;
  }

  /// A case takes about as long as it has agents.
  void tell(const CaseRecord* ended) {
    progress_.ended = ended;
    if (weight_done_ > 0.0) {
      const double left = std::accumulate(
          waiting_.begin() + static_cast<std::ptrdiff_t>(next_), waiting_.end(),
          0.5 * static_cast<double>(progress_.running.size()), [this](double sum, const Group* group) {
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
  std::vector<Group> groups_;
  std::vector<const Group*> waiting_;
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
  std::error_code error;
  fs::create_directories(config.directory / "cases", error);
  if (error) return failure(config.directory.string() + ": " + error.message());
  const auto lock = DirectoryLock::take(config.directory);
  if (!lock) return tl::unexpected(lock.error());
  return Runner(cases, engine, config, stop, on_progress).run();
}

}  // namespace fleetmap::apps::experiment
