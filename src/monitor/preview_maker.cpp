#include "preview_maker.hpp"

#include <sched.h>

#include <boost/asio/post.hpp>
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

}  // namespace

void PreviewMaker::refresh() {
  while (given_ < kAheadPerThread * threads_ && content_.misses_previews()) start_one();
}

void PreviewMaker::start_one() {
  auto [hash, make] = content_.begin_preview();
  ++given_;
  pool_.run([this, hash = std::move(hash), make = std::move(make)] {
    if (background_) yield_to_all();
    boost::asio::post(io_, [this, hash, preview = make()] {
      --given_;
      content_.end_preview(hash, preview);
      refresh();
    });
  });
}

}  // namespace fleetmap::monitor
