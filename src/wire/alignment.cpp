#include <algorithm>

#include "cdr.hpp"
#include "fields.hpp"
#include "fleetmap/wire/messages.hpp"
#include "fleetmap_long_range.h"
#include "type_names.hpp"

namespace fleetmap::wire {

Bytes encode(const graph::Alignment& alignment) {
  msg::Alignment out;
  out.schema(kSchemaVersion);
  out.computed_by(agent_name(alignment.computed_by));
  out.agent_i(agent_name(alignment.i.agent));
  out.agent_j(agent_name(alignment.j.agent));
  out.seq(alignment.seq);
  out.seq_i(alignment.i.seq);
  out.seq_j(alignment.j.seq);
  out.translation(to_floats(alignment.T_i_j.translation()));
  out.rotation(encode_rotation<std::int32_t>(alignment.T_i_j.linear()));
  out.rmse(to_float(alignment.rmse));
  out.inlier_fraction(to_float(alignment.inlier_fraction));
  out.covariance(upper_triangle<float>(alignment.covariance));
  return to_cdr(out);
}

template <>
Result<graph::Alignment> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::Alignment>(cdr, type_name::kAlignment);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kAlignment);
  graph::Alignment alignment;
  alignment.i = check.node(in->agent_i(), in->seq_i(), "agent_i");
  alignment.j = check.node(in->agent_j(), in->seq_j(), "agent_j");
  alignment.computed_by = check.agent(in->computed_by(), "computed_by");
  alignment.seq = check.seq(in->seq(), "seq");
  alignment.T_i_j =
      make_pose(decode_rotation(in->rotation(), check, "rotation is not a rotation vector within pi"),
                check.translation(in->translation(), "translation"));
  alignment.rmse = check.size(static_cast<double>(in->rmse()), 1e6, "rmse");
  alignment.inlier_fraction = check.size(static_cast<double>(in->inlier_fraction()), 1.0, "inlier_fraction");
  alignment.covariance = covariance_from(in->covariance(), check);
  check.require(alignment.i != alignment.j, "nodes i and j are the same");
  return check.finish(alignment);
}

Result<graph::Alignment> quantised(const graph::Alignment& alignment) {
  return decode<graph::Alignment>(encode(alignment));
}

}  // namespace fleetmap::wire
