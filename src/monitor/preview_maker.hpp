#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "content.hpp"
#include "event_loop.hpp"
#include "fleetmap/core/thread_pool.hpp"

namespace fleetmap::monitor {

/// Decodes the first points of every shown submap before a viewer asks for them, on threads beside the
/// server's. Used by the server's thread alone, which hands out the work and keeps what comes back.
class PreviewMaker {
 public:
  /// `loop` is the server's thread. In the `background`, other work of the machine goes first. Reads what
  /// is in `file` and keeps it up to date, unless its name is empty. While submaps lack previews, reads those
  /// of `others` first, one file after the other.
  PreviewMaker(EventLoop& loop, Content& content, unsigned threads, bool background,
               std::filesystem::path file, std::vector<std::filesystem::path> others = {});

  ~PreviewMaker() { stop(); }
  PreviewMaker(const PreviewMaker&) = delete;
  PreviewMaker& operator=(const PreviewMaker&) = delete;

  /// Goes on with what is shown now.
  void refresh();
  /// Begins no further preview, also of those that wait for a thread.
  void stop() { stopped_ = true; }

 private:
  void start_one();
  void save();

  EventLoop& loop_;
  Content& content_;
  unsigned threads_;
  bool background_;
  std::filesystem::path file_;
  std::vector<std::filesystem::path> unread_;  ///< the next one last
  unsigned in_flight_ = 0;                     ///< to the pool, and not back yet
  std::atomic<bool> stopped_ = false;
  ThreadPool pool_;  ///< last: its threads end first
};

}  // namespace fleetmap::monitor
