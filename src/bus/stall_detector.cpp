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

std::vector<StallNews> StallDetector::check(SteadyTime now, const ThreadActivity& activity) {
  note_pause(now, activity);
  std::vector<StallNews> news;
  for (const EndedWork& ended : activity.ended) {
    const Duration lasted = taken(ended.work.begun, ended.ended);
    if (lasted < limit_) continue;
    if (report(now, ended.work, lasted, " was stuck for ", news)) continue;
    if (reported_ == ended.work.number) {
      news.push_back(
          {counters_.thread + " goes on after " + in_seconds(lasted) + " in " + ended.work.name, true});
    }
  }
  if (activity.under_way) {
    const Duration lasted = taken(activity.under_way->begun, now);
    if (lasted >= limit_) report(now, *activity.under_way, lasted, " stuck for ", news);
  }
  if (more_.times > 0 && now - *reported_at_ >= kReportPeriod) {
    news.push_back({summary(now), false});
    reported_at_ = now;
    more_ = {};
  }
  return news;
}

bool StallDetector::report(SteadyTime now, const WorkUnderWay& work, Duration lasted, const char* how,
                           std::vector<StallNews>& news) {
  const bool fresh = count(work, lasted);
  const bool soon = reported_at_ && now - *reported_at_ < kReportPeriod;
  if (fresh && !soon && more_.times == 0) {
    reported_ = work.number;
    reported_at_ = now;
    news.push_back({counters_.thread + how + in_seconds(lasted) + " in " + work.name, false});
    return true;
  }
  if (reported_ == work.number) return false;
  more_.times += fresh;
  if (more_.times > 0 && lasted > more_.longest) {
    more_.longest = lasted;
    more_.longest_work = work.name;
  }
  return fresh;
}

std::string StallDetector::summary(SteadyTime now) const {
  const bool one = more_.times == 1;
  return counters_.thread + " was stuck " + (one ? "once" : std::to_string(more_.times) + " times") +
         " more in " + std::to_string(std::chrono::round<std::chrono::seconds>(now - *reported_at_).count()) +
         " s, for " + (one ? "" : "up to ") + in_seconds(more_.longest) + " in " + more_.longest_work;
}

void StallDetector::note_pause(SteadyTime now, const ThreadActivity& activity) {
  if (last_check_ && now - *last_check_ > kMaxCheckInterval) pauses_.push_back({*last_check_, now});
  last_check_ = now;
  SteadyTime oldest = activity.under_way ? activity.under_way->begun : now;
  for (const EndedWork& ended : activity.ended) oldest = std::min(oldest, ended.work.begun);
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
