#include "fleetmap/experiment/progress_line.hpp"

#include <cmath>
#include <cstdio>

namespace fleetmap::experiment {
namespace {

std::string status_text(const Progress& progress) {
  std::string text = std::to_string(progress.finished) + "/" + std::to_string(progress.total) + " done";
  if (progress.failed > 0) text += ", " + std::to_string(progress.failed) + " failed";
  if (progress.seconds_left >= 0.0 && progress.finished < progress.total)
    text += ", about " + duration_text(progress.seconds_left) + " left";
  return text;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::string duration_text(double seconds) {
  const long long whole = std::llround(seconds);
  char text[48];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%lld h %02lld min", whole / 3600, whole / 60 % 60);
  } else if (whole >= 60) {
    std::snprintf(text, sizeof text, "%lld min %02lld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld s", whole);
  }
  return text;
}

void ProgressLine::show(const Progress& progress) {
  if (open_) *out_ << "\r\x1b[K";
  open_ = false;
  if (progress.ended) {
    const CaseRecord& record = *progress.ended;
    *out_ << record.of.name << (record.done() ? ": done in " : ": failed after ")
          << duration_text(record.wall_seconds);
    if (!record.done()) *out_ << ": " << first_line(record.reason);
    *out_ << "  [" << status_text(progress) << "]\n";
  } else if (progress.running.empty() && progress.reused > 0) {
    *out_ << progress.reused << " of " << progress.total << " cases were finished by an earlier start\n";
  }
  if (terminal_ && !progress.running.empty()) {
    *out_ << status_text(progress) << "; running " << progress.running.front();
    if (progress.running.size() > 1) *out_ << " and " << progress.running.size() - 1 << " more";
    open_ = true;
  }
  out_->flush();
}

void ProgressLine::finish() {
  if (open_) *out_ << "\r\x1b[K" << std::flush;
  open_ = false;
}

}  // namespace fleetmap::experiment
