#include "preview_maker.hpp"

#include <sched.h>

#include <memory>
#include <utility>

namespace fleetmap::monitor {
namespace {

/// Work that waits for each thread, so that none stands while the server's thread answers a page.
constexpr unsigned kAheadPerThread = 8;

/// From now on the calling thread runs when no other thread wants to. A system that refuses that leaves it as
/// it is: the work is short.
void yield_to_all() {
  const sched_param none{};
  static_cast<void>(sched_setscheduler(0, SCHED_IDLE, &none));  // 0: this thread
}

/// A file is written again when so large a share of it is new; the rest is soon made again.
constexpr std::size_t kNewShare = 8;

}  // namespace

PreviewMaker::PreviewMaker(EventLoop& loop, Content& content, unsigned threads, bool background,
                           std::filesystem::path file, std::vector<std::filesystem::path> others)
    : loop_(loop),
      content_(content),
      threads_(threads),
      background_(background),
      file_(std::move(file)),
      unread_(others.rbegin(), others.rend()),
      pool_(threads) {
  if (!file_.empty()) content_.keep(read_previews(file_));
}

void PreviewMaker::refresh() {
  while (!unread_.empty() && content_.misses_previews()) {
    content_.keep(read_previews(unread_.back()));
    unread_.pop_back();
  }
  while (in_flight_ < kAheadPerThread * threads_ && content_.misses_previews()) start_one();
  if (in_flight_ == 0 && threads_ > 0 && !file_.empty()) save();
}

void PreviewMaker::save() {
  if (content_.new_previews() * kNewShare <= content_.kept_previews()) return;
  pool_.run([file = file_, previews = content_.previews()] {
    // In a read-only folder there is none, and they are made again the next time.
    static_cast<void>(write_previews(file, previews));
  });
}

void PreviewMaker::start_one() {
  auto [hash, make] = content_.begin_preview();
  ++in_flight_;
  pool_.run([this, hash = std::move(hash), make = std::move(make)] {
    if (background_) yield_to_all();
    loop_.post([this, hash, preview = make()] {
      --in_flight_;
      content_.end_preview(hash, preview);
      refresh();
    });
  });
}

}  // namespace fleetmap::monitor
