#include "fleetmap/ros_codec/diagnostics.hpp"

#include "diagnostic_msgs.h"
#include "fleetmap/bus/cdr.hpp"
#include "ros_time.hpp"

namespace fleetmap::ros_codec {

Bytes encode(const DiagnosticsMsg& diagnostics) {
  diagnostic_msgs::msg::dds_::DiagnosticArray_ out;
  out.header().stamp(to_ros(diagnostics.stamp));
  for (const DiagnosticsMsg::Item& item : diagnostics.items) {
    diagnostic_msgs::msg::dds_::DiagnosticStatus_& status = out.status().emplace_back();
    status.level(static_cast<std::uint8_t>(item.level));
    status.name(item.name);
    status.message(item.message);
    status.hardware_id(item.hardware_id);
    for (const auto& [key, value] : item.values) {
      diagnostic_msgs::msg::dds_::KeyValue_& pair = status.values().emplace_back();
      pair.key(key);
      pair.value(value);
    }
  }
  return bus::to_cdr(out);
}

}  // namespace fleetmap::ros_codec
