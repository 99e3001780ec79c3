#include "fleetmap/ros_codec/markers.hpp"

#include <gtest/gtest.h>

#include "fleetmap/bus/cdr.hpp"
#include "visualization_msgs.h"

namespace fleetmap::ros_codec {
namespace {

TEST(Markers, TheFirstDeletesWhatWasDrawnAndTheRestIsDrawn) {
  Marker line;
  line.group = "tracks";
  line.id = 3;
  line.type = Marker::Type::line_list;
  line.rgb = 0xff8000;
  line.scale.setConstant(0.1);
  line.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  const Bytes cdr = encode(MarkersMsg{stamp_from_ns(9), "map", {line}});
  const auto back = bus::from_cdr<visualization_msgs::msg::dds_::MarkerArray_>(cdr, "MarkerArray");
  ASSERT_TRUE(back && back->markers().size() == 2);
  EXPECT_EQ(back->markers()[0].action(), 3);
  const auto& drawn = back->markers()[1];
  EXPECT_EQ(drawn.action(), 0);
  EXPECT_EQ(drawn.header().frame_id(), "map");
  EXPECT_EQ(drawn.header().stamp().nanosec(), 9u);
  EXPECT_EQ(drawn.ns(), "tracks");
  EXPECT_EQ(drawn.id(), 3);
  EXPECT_EQ(drawn.type(), 5);
  EXPECT_EQ(drawn.color().r(), 1.0f);
  EXPECT_NEAR(drawn.color().g(), 0.5f, 0.01f);
  EXPECT_EQ(drawn.color().b(), 0.0f);
  EXPECT_EQ(drawn.color().a(), 1.0f) << "or it is not to be seen";
  EXPECT_EQ(drawn.pose().orientation().w(), 1.0);
  EXPECT_EQ(drawn.scale().x(), 0.1);
  ASSERT_EQ(drawn.points().size(), 2u);
  EXPECT_EQ(drawn.points()[1].y(), 5.0);
}

}  // namespace
}  // namespace fleetmap::ros_codec
