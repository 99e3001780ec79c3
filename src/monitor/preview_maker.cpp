#include "preview_maker.hpp"

#include <sys/resource.h>

#include <memory>
#include <utility>

namespace fleetmap::monitor {
namespace {

/// Work that waits for each thread, so that none stands while the server's thread answers a page.
constexpr unsigned kAheadPerThread = 8;

/// From now on the calling thread gets a thirtieth of a processor that others want. Not less, since the
/// program waits for it at its end, and the server for what it reads of the store. A system that refuses that
/// leaves it as it is: the work is short.
void give_way() {
  constexpr int kNice = 15;
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kNice));  // 0: on Linux this thread
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
    if (stopped_) return;
    if (background_) give_way();
    loop_.post([this, hash, preview = make()] {
      --in_flight_;
      content_.end_preview(hash, preview);
      refresh();
    });
  });
}

}  // namespace fleetmap::monitor
