#include "fleetmap/bus/stall_detector.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace fleetmap::bus {
namespace {

std::string in_seconds(Duration duration) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", to_seconds(duration));
  return text;
}

}  // namespace

StallDetector::StallDetector(std::string thread, Duration limit) : limit_(limit) {
  counters_.thread = std::move(thread);
}

std::vector<StallNews> StallDetector::look(SteadyTime now, const ThreadActivity& seen) {
  note_pause(now, seen);
  std::vector<StallNews> news;
  for (const EndedWork& ended : seen.ended) {
    const Duration lasted = taken(ended.work.begun, ended.ended);
    if (lasted < limit_) continue;
    const bool fresh = count(ended.work, lasted);
    news.push_back({counters_.thread + (fresh ? " was stuck for " : " goes on after ") + in_seconds(lasted) +
                        " in " + ended.work.name,
                    !fresh});
  }
  if (seen.under_way) {
    const Duration lasted = taken(seen.under_way->begun, now);
    if (lasted >= limit_ && count(*seen.under_way, lasted)) {
      news.push_back(
          {counters_.thread + " stuck for " + in_seconds(lasted) + " in " + seen.under_way->name, false});
    }
  }
  return news;
}

void StallDetector::note_pause(SteadyTime now, const ThreadActivity& seen) {
  if (last_look_ && now - *last_look_ > kLongestBetweenLooks) pauses_.push_back({*last_look_, now});
  last_look_ = now;
  SteadyTime oldest = seen.under_way ? seen.under_way->begun : now;
  for (const EndedWork& ended : seen.ended) oldest = std::min(oldest, ended.work.begun);
  std::erase_if(pauses_, [oldest](const Pause& pause) { return pause.ended <= oldest; });
}

Duration StallDetector::taken(SteadyTime begun, SteadyTime ended) const {
  Duration all = ended - begun;
  for (const Pause& pause : pauses_) {
    const Duration within = std::min(pause.ended, ended) - std::max(pause.begun, begun);
    all -= std::max(within, Duration::zero());
  }
  return all;
}

bool StallDetector::count(const WorkUnderWay& work, Duration lasted) {
  if (lasted > counters_.longest) {
    counters_.longest = lasted;
    counters_.longest_work = work.name;
  }
  if (counted_ == work.number) return false;
  counted_ = work.number;
  ++counters_.times;
  return true;
}

}  // namespace fleetmap::bus
