#include "virtual_fleet.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <utility>

#include "sample_player.hpp"

namespace fleetmap::apps {
namespace {

/// Recordings that began within this of each other were made together and keep their times.
constexpr Duration kSameOccasion = std::chrono::hours(1);
/// A first fix on the wrong side of the world is not where the site is.
constexpr std::size_t kFixesThatAgree = 3;
constexpr double kSiteRadius = 5000.0;  // m
constexpr Duration kStep = std::chrono::seconds(1);
constexpr Duration kReportEvery = std::chrono::seconds(30);

}  // namespace

Result<std::unique_ptr<VirtualFleet>> VirtualFleet::create(
    config::FleetConfig config, const std::filesystem::path& out,
    const std::optional<std::filesystem::path>& record) {
  std::unique_ptr<VirtualFleet> fleet(new VirtualFleet(std::move(config)));
  if (const Status opened = fleet->open_recordings(); !opened) return tl::unexpected(opened.error());
  if (const Status found = fleet->find_origin(); !found) return tl::unexpected(found.error());
  fleet->set_shifts();
  if (const Status added = fleet->add_agents(out, record); !added) return tl::unexpected(added.error());
  return fleet;
}

Status VirtualFleet::open_recordings() {
  for (const auto& source : config_.members) {
    auto reader = recording::open(source.recording.path, source.recording.reader);
    if (!reader) return tl::unexpected(reader.error());
    Member member;
    member.reader = std::move(*reader);
    members_.push_back(std::move(member));
    if (const Status first = advance(members_.back()); !first) return first;
    if (!members_.back().next)
      return failure(source.recording.path.string() + ": the recording holds no sensor sample");
  }
  return {};
}

/// The first fix of the first agent that the fixes after it bear out, unless the configuration names an
/// origin.
Status VirtualFleet::find_origin() {
  const auto& first = config_.members.front();
  origin_ = first.agent.site_origin;
  if (origin_) return {};
  auto reader = recording::open(first.recording.path, first.recording.reader);
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

void VirtualFleet::set_shifts() {
  Stamp earliest = Stamp::max();
  Stamp latest = Stamp::min();
  for (const Member& member : members_) {
    earliest = std::min(earliest, recording::stamp_of(*member.next));
    latest = std::max(latest, recording::stamp_of(*member.next));
  }
  const bool same_occasion = latest - earliest < kSameOccasion;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const Stamp first = recording::stamp_of(*members_[k].next);
    const std::optional<double>& start = config_.members[k].recording.start;
    if (start) {
      members_[k].shift = earliest + from_seconds(*start) - first;
    } else {
      members_[k].shift = same_occasion ? Duration::zero() : earliest - first;
    }
  }
  config_.network.start = earliest;
}

Status VirtualFleet::add_agents(const std::filesystem::path& out,
                                const std::optional<std::filesystem::path>& record) {
  auto network = bus::LocalNetwork::create(config_.network);
  if (!network) return tl::unexpected(network.error());
  network_ = std::move(*network);
  for (std::size_t k = 0; k < members_.size(); ++k) {
    agent::AgentConfig& config = config_.members[k].agent;
    config.directory = out / config.id.str();
    if (origin_) config.site_origin = origin_;
    std::error_code error;
    if (std::filesystem::exists(config.directory / "store.db", error)) {
      return failure(config.directory.string() +
                     ": holds the result of an earlier run; give another --out or delete it");
    }
    members_[k].bus = &network_->add_robot(config.id);
    auto agent = agent::Agent::create(config, *members_[k].bus);
    if (!agent) return tl::unexpected(agent.error());
    members_[k].agent = std::move(*agent);
    if (record) {
      auto bag = recording::BagWriter::create(*record / config.id.str());
      if (!bag) return tl::unexpected(bag.error());
      members_[k].bag.emplace(std::move(*bag));
    }
  }
  return {};
}

Status VirtualFleet::advance(Member& member) {
  auto sample = member.reader->next();
  if (!sample) return tl::unexpected(sample.error());
  member.next = std::move(*sample);
  member.ended = !member.next.has_value();
  return {};
}

void VirtualFleet::schedule(Member& member) {
  if (!member.next) return;
  network_->at(recording::stamp_of(*member.next) + member.shift, [this, &member] { play(member); });
}

void VirtualFleet::play(Member& member) {
  const EncodedSample encoded = encode(*member.next, member.agent->config().perception.topics);
  member.bus->publish(encoded.topic, encoded.cdr);
  if (member.bag) {
    const Status written = member.bag->write(encoded.topic.name, encoded.topic.type,
                                             network_->now() - member.shift, encoded.cdr);
    if (!written) error_ = written.error().message;
  }
  if (const Status read = advance(member); !read) {
    // What was played so far is a recording too: say so and go on with the others.
    spdlog::error("{}", read.error().message);
    member.problem = read.error().message;
    member.ended = true;
    member.next.reset();
  }
  schedule(member);
}

void VirtualFleet::update_positions() {
  if (!origin_) return;
  const LocalFrame site(*origin_);
  for (const Member& member : members_) {
    const auto G = member.agent->perception().global_pose();
    if (!G) continue;
    const Eigen::Vector3d p = site.to_enu(G->position);
    network_->set_position(member.agent->config().id, {p.x(), p.y(), p.z()});
  }
}

bool VirtualFleet::settled() {
  bool all = true;
  for (Member& member : members_) {
    if (member.ended && !member.rest_frozen && member.agent->perception().idle()) {
      member.agent->freeze_rest();
      member.rest_frozen = true;
      all = false;
    }
    all &= member.ended && member.rest_frozen && member.agent->idle() && member.agent->complete() &&
           member.agent->fleet_caught_up();
  }
  return all;
}

Result<FleetOutcome> VirtualFleet::run() {
  for (Member& member : members_) schedule(member);
  FleetOutcome outcome;
  const Stamp start = network_->now();
  Stamp last_sample = start;
  Stamp next_report = start + kReportEvery;
  const auto playing = [this] {
    return std::ranges::any_of(members_, [](const Member& m) { return !m.ended; });
  };
  while (error_.empty()) {
    network_->run_until(network_->now() + kStep);
    update_positions();
    if (playing()) last_sample = network_->now();
    outcome.settled = settled();
    if (outcome.settled || network_->now() - last_sample > from_seconds(config_.settle_time)) break;
    if (network_->now() < next_report) continue;
    next_report += kReportEvery;
    for (const Member& member : members_) {
      const store::Store& store = member.agent->store();
      spdlog::info("{:.0f} s {}: {} nodes, {} alignments, {} submaps", to_seconds(network_->now() - start),
                   member.agent->config().id.str(), store.nodes().size(), store.alignments().size(),
                   store.submap_set().size());
    }
  }
  if (!error_.empty()) return failure(error_);
  outcome.virtual_time = network_->now() - start;
  outcome.settle_time = network_->now() - last_sample;
  outcome.links = network_->link_use();
  outcome.origin_known = origin_.has_value();
  if (origin_) outcome.origin = *origin_;
  for (Member& member : members_) {
    FleetOutcome::AgentOutcome result;
    auto written = agent::write_results(member.agent->store(), member.agent->config());
    if (written) {
      result.results = std::move(*written);
    } else {
      result.problem = written.error().message;
    }
    if (result.problem.empty()) result.problem = member.problem;
    result.recording = member.reader->counters();
    if (member.bag) {
      if (const Status closed = member.bag->close(); !closed) return tl::unexpected(closed.error());
    }
    result.agent = std::move(member.agent);
    outcome.agents.push_back(std::move(result));
  }
  return outcome;
}

}  // namespace fleetmap::apps
