#include "fleetmap/fleet_codec/long_range.hpp"

#include <algorithm>

#include "fields.hpp"
#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap_long_range.h"
#include "schema.hpp"
#include "type_names.hpp"

namespace fleetmap::fleet_codec {
namespace {

constexpr double kMaxMetres = 2.1e7;  // half the way round the Earth

/// The bytes of piece `index` of a cloud of `total` bytes.
std::size_t piece_size(std::uint32_t total, std::uint16_t index) {
  const std::size_t first = index * messages::CloudFragment::kMaxPayload;
  return first >= total ? 0 : std::min<std::size_t>(messages::CloudFragment::kMaxPayload, total - first);
}

std::vector<std::uint32_t> first_of(const std::vector<std::uint32_t>& values, std::size_t limit) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), limit))};
}

}  // namespace

Bytes encode(const messages::ProximityMatch& match) {
  msg::ProximityMatch out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(match.from));
  out.recipient(agent_name(match.to));
  out.theirs(node_ref(match.theirs));
  out.ours(node_ref(match.ours));
  out.distance(to_float(match.distance));
  out.radius(to_float(match.radius));
  return bus::to_cdr(out);
}

template <>
Result<messages::ProximityMatch> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::ProximityMatch>(cdr, type_name::kProximityMatch);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kProximityMatch);
  messages::ProximityMatch match;
  match.from = check.agent(in->sender(), "sender");
  match.to = check.agent(in->recipient(), "recipient");
  match.theirs = check.node(in->theirs(), "theirs");
  match.ours = check.node(in->ours(), "ours");
  match.distance = check.size(static_cast<double>(in->distance()), kMaxMetres, "distance");
  match.radius = check.size(static_cast<double>(in->radius()), kMaxMetres, "radius");
  return check.finish(match);
}

Bytes encode(const messages::SpherizedCloud& cloud) {
  msg::SpherizedCloud out;
  out.schema(kSchemaVersion);
  out.node(node_ref(cloud.node));
  out.radius(to_float(cloud.radius));
  out.voxel(to_float(cloud.voxel));
  out.points(cloud.points);
  out.payload(bounded(cloud.payload, kMaxCloudPayload));
  return bus::to_cdr(out);
}

template <>
Result<messages::SpherizedCloud> decode(ByteView cdr) {
  auto in = fleet_type_from_cdr<msg::SpherizedCloud>(cdr, type_name::kSpherizedCloud);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kSpherizedCloud);
  messages::SpherizedCloud cloud;
  cloud.node = check.node(in->node(), "node");
  cloud.radius = check.size(static_cast<double>(in->radius()), 1e4, "radius");
  cloud.voxel = check.size(static_cast<double>(in->voxel()), 1e4, "voxel");
  cloud.points = in->points();
  check.require(in->payload().size() <= kMaxCloudPayload, "payload is beyond 25000 bytes");
  // Draco never packs 255 points into a byte; more is a decompression bomb.
  check.require(cloud.points <= 255 * in->payload().size(), "points are more than the payload can hold");
  cloud.payload = std::move(in->payload());
  return check.finish(std::move(cloud));
}

Bytes encode(const messages::CloudFragment& fragment) {
  msg::CloudFragment out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(fragment.from));
  out.recipient(agent_name(fragment.to));
  out.node(node_ref(fragment.node));
  out.cloud_hash(fragment.cloud_hash);
  out.total_bytes(fragment.total_bytes);
  out.index(fragment.index);
  out.count(fragment.count);
  out.payload(bounded(fragment.payload, messages::CloudFragment::kMaxPayload));
  return bus::to_cdr(out);
}

template <>
Result<messages::CloudFragment> decode(ByteView cdr) {
  auto in = fleet_type_from_cdr<msg::CloudFragment>(cdr, type_name::kCloudFragment);
  if (!in) return tl::unexpected(in.error());
  constexpr std::size_t kPiece = messages::CloudFragment::kMaxPayload;
  FieldCheck check(type_name::kCloudFragment);
  messages::CloudFragment fragment;
  fragment.from = check.agent(in->sender(), "sender");
  fragment.to = check.agent(in->recipient(), "recipient");
  fragment.node = check.node(in->node(), "node");
  fragment.cloud_hash = in->cloud_hash();
  fragment.total_bytes = in->total_bytes();
  fragment.index = in->index();
  fragment.count = in->count();
  check.require(fragment.total_bytes > 0 && fragment.total_bytes <= kMaxEncodedCloud,
                "total_bytes is 0 or more than a cloud can have");
  check.require(fragment.count == (fragment.total_bytes + kPiece - 1) / kPiece,
                "count does not fit total_bytes");
  check.require(fragment.index < fragment.count, "index is not below count");
  check.require(in->payload().size() == piece_size(fragment.total_bytes, fragment.index),
                "payload does not have the length of its piece");
  fragment.payload = std::move(in->payload());
  return check.finish(std::move(fragment));
}

Bytes encode(const messages::CloudRequest& request) {
  msg::CloudRequest out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(request.from));
  out.recipient(agent_name(request.to));
  out.node(node_ref(request.node));
  out.information(request.information);
  out.missing({request.missing.begin(), request.missing.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                      request.missing.size(), kMaxMissing))});
  return bus::to_cdr(out);
}

template <>
Result<messages::CloudRequest> decode(ByteView cdr) {
  auto in = fleet_type_from_cdr<msg::CloudRequest>(cdr, type_name::kCloudRequest);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kCloudRequest);
  messages::CloudRequest request;
  request.from = check.agent(in->sender(), "sender");
  request.to = check.agent(in->recipient(), "recipient");
  request.node = check.node(in->node(), "node");
  check.size(static_cast<double>(in->information()), 1e3, "information");
  request.information = in->information();
  check.require(in->missing().size() <= kMaxMissing, "missing has more than 256 entries");
  request.missing = std::move(in->missing());
  return check.finish(std::move(request));
}

Bytes encode(const messages::Digest& digest) {
  msg::Digest out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(digest.from));
  out.nodes(ranges(digest.nodes, kMaxRanges));
  out.alignments(ranges(digest.alignments, kMaxRanges));
  out.node_prints(first_of(digest.node_prints, kMaxRanges));
  out.alignment_prints(first_of(digest.alignment_prints, kMaxRanges));
  return bus::to_cdr(out);
}

template <>
Result<messages::Digest> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::Digest>(cdr, type_name::kDigest);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kDigest);
  messages::Digest digest;
  digest.from = check.agent(in->sender(), "sender");
  digest.nodes = check.ranges(in->nodes(), kMaxRanges, "nodes");
  digest.alignments = check.ranges(in->alignments(), kMaxRanges, "alignments");
  digest.node_prints = in->node_prints();
  digest.alignment_prints = in->alignment_prints();
  check.require(digest.node_prints.size() == digest.nodes.size() &&
                    digest.alignment_prints.size() == digest.alignments.size(),
                "there is not one print for each range");
  return check.finish(std::move(digest));
}

Bytes encode(const messages::ItemRequest& request) {
  msg::ItemRequest out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(request.from));
  out.recipient(agent_name(request.to));
  out.nodes(ranges(request.nodes, kMaxRanges));
  out.alignments(ranges(request.alignments, kMaxRanges));
  return bus::to_cdr(out);
}

template <>
Result<messages::ItemRequest> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::ItemRequest>(cdr, type_name::kItemRequest);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kItemRequest);
  messages::ItemRequest request;
  request.from = check.agent(in->sender(), "sender");
  request.to = check.agent(in->recipient(), "recipient");
  request.nodes = check.ranges(in->nodes(), kMaxRanges, "nodes");
  request.alignments = check.ranges(in->alignments(), kMaxRanges, "alignments");
  return check.finish(std::move(request));
}

Bytes encode(const messages::AgentStatus& status) {
  msg::AgentStatus out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(status.from));
  out.stamp(to_ns(status.stamp));
  out.latitude(status.position.latitude);
  out.longitude(status.position.longitude);
  out.altitude(to_float(status.position.altitude));
  out.heading(status.heading);
  out.position_stddev(to_float(static_cast<double>(status.position_stddev)));
  out.battery(status.battery);
  out.nodes(status.nodes);
  out.alignments(status.alignments);
  out.submaps(status.submaps);
  out.backlog_bytes(status.backlog_bytes);
  out.busy(status.busy);
  out.problems(status.health.problems);
  out.clock_sensor(status.health.clock_sensor);
  out.clock_offset(status.health.clock_offset);
  out.loans().resize(std::min(status.loans.size(), kMaxLoans));
  for (std::size_t k = 0; k < out.loans().size(); ++k) {
    out.loans()[k].borrower(agent_name(status.loans[k].borrower));
    out.loans()[k].bytes_per_second(status.loans[k].bytes_per_second);
  }
  return bus::to_cdr(out);
}

template <>
Result<messages::AgentStatus> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::AgentStatus>(cdr, type_name::kAgentStatus);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kAgentStatus);
  messages::AgentStatus status;
  status.from = check.agent(in->sender(), "sender");
  status.stamp = check.stamp(in->stamp());
  status.position = check.position(in->latitude(), in->longitude(), static_cast<double>(in->altitude()));
  check.within(static_cast<double>(in->heading()), 10.0, "heading");
  check.size(static_cast<double>(in->position_stddev()), 3.5e38, "position_stddev");
  check.within(static_cast<double>(in->battery()), 1.0, "battery");
  status.heading = in->heading();
  status.position_stddev = in->position_stddev();
  status.battery = in->battery();
  status.nodes = in->nodes();
  status.alignments = in->alignments();
  status.submaps = in->submaps();
  status.backlog_bytes = in->backlog_bytes();
  status.busy = in->busy();
  check.require(in->problems() <= messages::Health::kAllProblems, "problems are not known");
  check.require(in->clock_sensor() < messages::Health::kSensors, "clock_sensor is not known");
  status.health = {in->problems(), in->clock_sensor(), in->clock_offset()};
  check.require(in->loans().size() <= kMaxLoans, "more than 4 loans");
  for (const msg::Loan& loan : in->loans()) {
    status.loans.push_back({check.agent(loan.borrower(), "borrower"), loan.bytes_per_second()});
  }
  return check.finish(std::move(status));
}

Bytes encode(const messages::MissionReport& report) {
  msg::MissionReport out;
  out.schema(kSchemaVersion);
  out.sender(agent_name(report.from));
  out.state(static_cast<std::uint8_t>(report.state));
  out.stamp(to_ns(report.stamp));
  out.east(to_float(report.position.x()));
  out.north(to_float(report.position.y()));
  out.battery(to_float(std::clamp(report.battery, 0.0, 1.0)));
  out.current(report.current);
  out.done(bounded(report.done.bytes(), kMaxRowSet));
  out.claimed(bounded(report.claimed.bytes(), kMaxRowSet));
  out.failed(bounded(report.failed.bytes(), kMaxRowSet));
  return bus::to_cdr(out);
}

template <>
Result<messages::MissionReport> decode(ByteView cdr) {
  auto in = fleet_type_from_cdr<msg::MissionReport>(cdr, type_name::kMissionReport);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kMissionReport);
  messages::MissionReport report;
  report.from = check.agent(in->sender(), "sender");
  report.stamp = check.stamp(in->stamp());
  check.require(in->state() <= 6, "state is not known");
  const bool sets_fit = in->done().size() <= kMaxRowSet && in->claimed().size() <= kMaxRowSet &&
                        in->failed().size() <= kMaxRowSet;
  check.require(sets_fit, "a set of rows is beyond 512 bytes");
  report.state = static_cast<messages::MissionState>(in->state());
  report.position = {check.within(static_cast<double>(in->east()), kMaxMetres, "east"),
                     check.within(static_cast<double>(in->north()), kMaxMetres, "north")};
  report.battery = check.size(static_cast<double>(in->battery()), 1.0, "battery");
  report.current = in->current();
  report.done = messages::RowSet(std::move(in->done()));
  report.claimed = messages::RowSet(std::move(in->claimed()));
  report.failed = messages::RowSet(std::move(in->failed()));
  return check.finish(std::move(report));
}

Bytes encode(const messages::Hold& hold) {
  msg::Hold out;
  out.schema(kSchemaVersion);
  out.driving(static_cast<std::uint8_t>(hold.driving));
  out.sender(agent_name(hold.from));
  out.orders().resize(std::min(hold.orders.size(), kMaxHoldOrders));
  for (std::size_t k = 0; k < out.orders().size(); ++k) {
    msg::HoldOrder& order = out.orders()[k];
    order.stamp(to_ns(hold.orders[k].stamp));
    order.robot(agent_name(hold.orders[k].robot));
    order.issuer(agent_name(hold.orders[k].issuer));
    order.kind(static_cast<std::uint8_t>(hold.orders[k].kind));
  }
  out.rows().resize(std::min(hold.rows.size(), kMaxRowOrders));
  for (std::size_t k = 0; k < out.rows().size(); ++k) {
    msg::RowOrder& order = out.rows()[k];
    order.stamp(to_ns(hold.rows[k].stamp));
    order.robot(agent_name(hold.rows[k].robot));
    order.to(agent_name(hold.rows[k].to));
    order.issuer(agent_name(hold.rows[k].issuer));
    order.row(hold.rows[k].row);
  }
  return bus::to_cdr(out);
}

template <>
Result<messages::Hold> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::Hold>(cdr, type_name::kHold);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kHold);
  messages::Hold hold;
  hold.from = check.agent(in->sender(), "sender");
  check.require(in->driving() <= 4, "driving is not known");
  hold.driving = static_cast<messages::Hold::Driving>(in->driving());
  check.require(in->orders().size() <= kMaxHoldOrders, "orders are more than 32");
  for (const msg::HoldOrder& order : in->orders()) {
    const bool all = order.robot() == AgentName{};
    check.require(order.kind() <= 3, "kind of an order is not known");
    hold.orders.push_back({check.stamp(order.stamp()), all ? AgentId{} : check.agent(order.robot(), "robot"),
                           check.agent(order.issuer(), "issuer"),
                           static_cast<messages::HoldOrder::Kind>(order.kind())});
  }
  check.require(in->rows().size() <= kMaxRowOrders, "orders for rows are more than 16");
  for (const msg::RowOrder& order : in->rows()) {
    const bool anyone = order.to() == AgentName{};
    hold.rows.push_back({check.stamp(order.stamp()), check.agent(order.robot(), "robot"),
                         anyone ? AgentId{} : check.agent(order.to(), "to"),
                         check.agent(order.issuer(), "issuer"), order.row()});
  }
  return check.finish(std::move(hold));
}

}  // namespace fleetmap::fleet_codec
