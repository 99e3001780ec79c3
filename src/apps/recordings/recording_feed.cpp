#include "recording_feed.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <utility>

namespace fleetmap::apps {
namespace {

/// Recordings that began within this of each other were made together and keep their times.
constexpr Duration kSameOccasion = std::chrono::hours(1);
/// A first fix on the wrong side of the world is not where the site is.
constexpr std::size_t kFixesThatAgree = 3;
constexpr double kSiteRadius = 5000.0;  // m

}  // namespace

Status RecordingFeed::advance(Member& member) {
  auto sample = member.reader->next();
  member.next.reset();
  if (!sample) return tl::unexpected(sample.error());
  member.next = std::move(*sample);
  if (member.next) member.due = member.times.of(*member.next, member.reader->recorded());
  return {};
}

Result<std::unique_ptr<RecordingFeed>> RecordingFeed::create(
    const std::vector<config::RecordingConfig>& recordings,
    const std::vector<recording::LogClock>& log_clocks, const std::optional<GeoPoint>& site_origin,
    const std::vector<bool>& uses_gps) {
  std::unique_ptr<RecordingFeed> feed(new RecordingFeed);
  for (const config::RecordingConfig& source : recordings) {
    auto reader = recording::open(source.path, source.reader);
    if (!reader) return tl::unexpected(reader.error());
    Member member;
    member.times = recording::PlayTimes(log_clocks[feed->members_.size()]);
    member.reader = std::move(*reader);
    if (const Status first = advance(member); !first) return tl::unexpected(first.error());
    if (!member.next) return failure(source.path.string() + ": the recording holds no sensor sample");
    feed->members_.push_back(std::move(member));
  }
  feed->origin_ = site_origin;
  const auto first = std::ranges::find(uses_gps, true) - uses_gps.begin();
  if (!site_origin && (uses_gps.empty() || first < std::ssize(recordings))) {
    const std::size_t robot = uses_gps.empty() ? 0 : static_cast<std::size_t>(first);
    if (const Status found = feed->find_origin(recordings[robot]); !found)
      return tl::unexpected(found.error());
  }
  feed->set_shifts(recordings);
  return feed;
}

Status RecordingFeed::find_origin(const config::RecordingConfig& recording) {
  auto reader = recording::open(recording.path, recording.reader, recording::ScanContent::kStampOnly);
  if (!reader) return tl::unexpected(reader.error());
  std::deque<GeoPoint> fixes;
  while (!origin_) {
    const auto sample = (*reader)->next();
    if (!sample) return tl::unexpected(sample.error());
    if (!*sample) break;
    const auto* fix = std::get_if<sensor::Fix>(&**sample);
    if (fix == nullptr || !fix->valid || !is_valid(fix->position)) continue;
    fixes.push_back(fix->position);
    if (fixes.size() < kFixesThatAgree) continue;
    const bool agree = std::ranges::all_of(
        fixes, [&](const GeoPoint& p) { return haversine_distance(p, fixes.front()) < kSiteRadius; });
    if (agree) origin_ = fixes.front();
    fixes.pop_front();
  }
  if (!origin_ && !fixes.empty()) origin_ = fixes.back();
  return {};
}

void RecordingFeed::set_shifts(const std::vector<config::RecordingConfig>& recordings) {
  Stamp earliest = Stamp::max();
  Stamp latest = Stamp::min();
  for (const Member& member : members_) {
    earliest = std::min(earliest, member.due);
    latest = std::max(latest, member.due);
  }
  const bool same_occasion = latest - earliest < kSameOccasion;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const Stamp first = members_[k].due;
    const std::optional<double>& start = recordings[k].start;
    if (start) {
      members_[k].shift = earliest + from_seconds(*start) - first;
    } else {
      members_[k].shift = same_occasion ? Duration::zero() : earliest - first;
    }
  }
  start_ = earliest;
}

Status RecordingFeed::begin(bus::LocalNetwork& network, Deliver deliver) {
  network_ = &network;
  deliver_ = std::move(deliver);
  for (std::size_t k = 0; k < members_.size(); ++k) schedule(k);
  return {};
}

void RecordingFeed::schedule(std::size_t member) {
  Member& self = members_[member];
  if (!self.next) return;
  network_->at(self.due + self.shift, [this, member] { play(member); });
}

void RecordingFeed::play(std::size_t member) {
  Member& self = members_[member];
  deliver_(member, *self.next, network_->now() - self.shift);
  if (const Status read = advance(self); !read) {
    // The samples played so far are still a recording, so the error is logged and the others continue.
    spdlog::error("{}", read.error().message);
    self.problem = read.error().message;
  }
  schedule(member);
}

}  // namespace fleetmap::apps
