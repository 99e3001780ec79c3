#include "fleetmap/experiment/progress_line.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace fleetmap::experiment {
namespace {

/// Returns the text that showing `steps` one after another writes.
std::string shown(const std::vector<Progress>& steps, bool terminal, bool finish = false) {
  std::ostringstream out;
  ProgressLine line(out, terminal);
  for (const Progress& progress : steps) line.show(progress);
  if (finish) line.finish();
  return out.str();
}

Progress running(std::size_t finished, std::size_t total, std::vector<std::string> names) {
  Progress progress;
  progress.finished = finished;
  progress.total = total;
  progress.running = std::move(names);
  return progress;
}

TEST(ProgressLine, DurationsHaveTwoUnits) {
  EXPECT_EQ(duration_text(0.0), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s");  // rounded before it is divided
  EXPECT_EQ(duration_text(200.0), "3 min 20 s");
  EXPECT_EQ(duration_text(3599.7), "1 h 00 min");
  EXPECT_EQ(duration_text(3840.0), "1 h 04 min");
  EXPECT_EQ(duration_text(90'000.0), "25 h 00 min");
}

TEST(ProgressLine, AFileHasALineForEachCaseThatEnds) {
  CaseRecord good, bad;
  good.of.name = "a.seed=1";
  good.wall_seconds = 61.0;
  good.result.emplace();
  bad.of.name = "a.seed=2";
  bad.wall_seconds = 3.0;
  bad.reason = "no map\nof many lines";
  Progress first = running(1, 3, {"a.seed=2"});
  first.ended = &good;
  first.seconds_left = 120.0;
  Progress second = running(3, 3, {});
  second.ended = &bad;
  second.failed = 1;
  second.seconds_left = 0.0;  // not told at the end
  EXPECT_EQ(shown({running(0, 3, {"a.seed=1"}), first, second}, false),
            "a.seed=1: done in 1 min 01 s  [1/3 done, about 2 min 00 s left]\n"
            "a.seed=2: failed after 3 s: no map  [3/3 done, 1 failed]\n");
}

TEST(ProgressLine, ATerminalShowsWhatRunsOnALineThatIsRewritten) {
  const std::string clear = "\r\x1b[K";
  EXPECT_EQ(shown({running(0, 5, {"a", "b", "c"}), running(1, 5, {"b"})}, true),
            "0/5 done; running a and 2 more" + clear + "1/5 done; running b");
  EXPECT_EQ(shown({running(4, 5, {"a"})}, true, true), "4/5 done; running a" + clear);
  EXPECT_EQ(shown({running(5, 5, {})}, true, true), "");  // nothing is open, so nothing is cleared
}

TEST(ProgressLine, CasesOfAnEarlierStartAreToldBeforeAnyRuns) {
  Progress progress = running(2, 5, {});
  progress.reused = 2;
  EXPECT_EQ(shown({progress}, false), "2 of 5 cases were finished by an earlier start\n");
  progress.running = {"a"};
  EXPECT_EQ(shown({progress}, false), "");
}

}  // namespace
}  // namespace fleetmap::experiment
