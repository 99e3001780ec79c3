#include "fleetmap/ros_codec/diagnostics.hpp"

#include <gtest/gtest.h>

#include "diagnostic_msgs.h"
#include "fleetmap/bus/cdr.hpp"

namespace fleetmap::ros_codec {
namespace {

TEST(DiagnosticsMessage, KeepsLevelsTextsAndValues) {
  using Level = DiagnosticsMsg::Level;
  const DiagnosticsMsg message{stamp_from_ns(2'000'000'001),
                               {{Level::ok, "a", "fine", "r1", {}},
                                {Level::stale, "b", "is silent", "r2", {{"samples", "7"}, {"rate", "0"}}}}};
  const auto back =
      bus::from_cdr<diagnostic_msgs::msg::dds_::DiagnosticArray_>(encode(message), "DiagnosticArray");
  ASSERT_TRUE(back && back->status().size() == 2);
  EXPECT_EQ(back->header().stamp().sec(), 2);
  EXPECT_EQ(back->status()[0].level(), 0);
  const auto& second = back->status()[1];
  EXPECT_EQ(second.level(), 3);
  EXPECT_EQ(second.name() + "/" + second.message() + "/" + second.hardware_id(), "b/is silent/r2");
  ASSERT_EQ(second.values().size(), 2u);
  EXPECT_EQ(second.values()[0].key() + "=" + second.values()[0].value(), "samples=7");
}

}  // namespace
}  // namespace fleetmap::ros_codec
