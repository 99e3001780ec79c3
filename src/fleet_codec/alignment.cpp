#include "fleetmap/fleet_codec/alignment.hpp"

#include <algorithm>
#include <string>

#include "covariance_root.hpp"
#include "fields.hpp"
#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap_long_range.h"
#include "rounding.hpp"
#include "schema.hpp"
#include "type_names.hpp"

namespace fleetmap::fleet_codec {
namespace {

msg::AlignmentMode encoded(const graph::AlignmentMode& mode) {
  msg::AlignmentMode out;
  out.translation(to_floats(mode.T_i_j.translation()));
  out.rotation(encode_rotation<std::int32_t>(mode.T_i_j.linear()));
  out.rmse(to_float(mode.rmse));
  out.inlier_fraction(to_float(mode.inlier_fraction));
  out.score(to_float(mode.score));
  out.covariance(encode_covariance(mode.covariance));
  return out;
}

graph::AlignmentMode decoded(const msg::AlignmentMode& in, FieldCheck& check) {
  graph::AlignmentMode mode;
  mode.T_i_j = make_pose(decode_rotation(in.rotation(), check, "rotation is not a rotation vector within pi"),
                         check.translation(in.translation(), "translation"));
  mode.rmse = check.size(static_cast<double>(in.rmse()), 1e6, "rmse");
  mode.inlier_fraction = check.size(static_cast<double>(in.inlier_fraction()), 1.0, "inlier_fraction");
  mode.score = check.size(static_cast<double>(in.score()), 1.0, "score");
  mode.covariance = decode_covariance(in.covariance(), check, "covariance");
  return mode;
}

/// Without schema version and signature.
msg::Alignment unsigned_alignment(const graph::Alignment& alignment) {
  msg::Alignment out;
  out.computed_by(agent_name(alignment.computed_by));
  out.agent_i(agent_name(alignment.i.agent));
  out.agent_j(agent_name(alignment.j.agent));
  out.seq(alignment.seq);
  out.seq_i(alignment.i.seq);
  out.seq_j(alignment.j.seq);
  const std::size_t modes = std::min(alignment.modes.size(), graph::Alignment::kMaxModes);
  for (std::size_t k = 0; k < modes; ++k) out.modes().push_back(encoded(alignment.modes[k]));
  return out;
}

bool encodes_alignment(const graph::Alignment& alignment, const msg::Alignment& message) {
  msg::Alignment again = unsigned_alignment(alignment);
  again.schema(message.schema());
  again.signature(message.signature());
  return again == message;
}

/// Also a message that encoding the item again changes.
Result<graph::Alignment> read_alignment(const msg::Alignment& in) {
  FieldCheck check(type_name::kAlignment);
  graph::Alignment alignment;
  alignment.i = check.node(in.agent_i(), in.seq_i(), "agent_i");
  alignment.j = check.node(in.agent_j(), in.seq_j(), "agent_j");
  alignment.computed_by = check.agent(in.computed_by(), "computed_by");
  alignment.seq = check.seq(in.seq(), "seq");
  check.require(!in.modes().empty() && in.modes().size() <= graph::Alignment::kMaxModes,
                "the number of modes is not 1 to 6");
  const std::size_t modes = std::min(in.modes().size(), graph::Alignment::kMaxModes);
  alignment.modes.clear();
  for (std::size_t k = 0; k < modes; ++k) alignment.modes.push_back(decoded(in.modes()[k], check));
  check.require(alignment.i != alignment.j, "nodes i and j are the same");
  alignment.signature = check.signature(in.signature());
  return check.finish(alignment);
}

}  // namespace

Bytes encode(const graph::Alignment& alignment) {
  msg::Alignment out = unsigned_alignment(alignment);
  out.schema(kSchemaVersion);
  out.signature(signature_bytes(alignment.signature));
  return bus::to_cdr(out);
}

Bytes signed_bytes(const graph::Alignment& alignment) { return bus::to_cdr(unsigned_alignment(alignment)); }

template <>
Result<graph::Alignment> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::Alignment>(cdr, type_name::kAlignment);
  if (!in) return tl::unexpected(in.error());
  auto alignment = read_alignment(*in);
  if (!alignment || encodes_alignment(*alignment, *in)) return alignment;
  // Else another content than the signed one could bear the signature.
  if (alignment->signature)
    return failure(std::string(type_name::kAlignment) +
                   ": is signed and is not what encoding it again gives");
  // Else this robot would hold a content that it cannot hand on.
  return quantised(*alignment);
}

Result<graph::Alignment> quantised(const graph::Alignment& alignment) {
  return rounded<msg::Alignment>(alignment, type_name::kAlignment, read_alignment);
}

}  // namespace fleetmap::fleet_codec
