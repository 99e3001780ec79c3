// Metrics that `fleetmap trial` computes from the files of the robots.
#include "field_measures.hpp"

#include <gmock/gmock.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::DoubleNear;
using ::testing::HasSubstr;

/// r1 makes three nodes, of which r2 gets two after 0.1 and 2 s; r2 makes one, which r1 gets after 0.5 s.
class FieldMeasures : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("field.json", R"({"all_know_s": 0.5, "ended_s": null, "equal": 1, "worst_kbit_s": 152})");
    folder_.write("r1/node_times.csv",
                  "time_ns,node\n1000000000,r1#7/0\n5000000000,r1#7/1\n9000000000,r1#7/2\n"
                  "10500000000,r2#9/0\n20000000000,r1#7/0\n");  // told again after a restart
    folder_.write("r2/node_times.csv",
                  "time_ns,node\n1100000000,r1#7/0\n7000000000,r1#7/1\n10000000000,r2#9/0\n1200");
    folder_.write("r1/link_trace.csv",
                  "time_s,link,from,to,kbit_s,ms,loss_percent,used_kbit_s,messages\n"
                  "10.2,short_range,r2,r1,6000.0,1.0,0.0,6000.0,90\n11.2,short_range,r2,r1,,1.0,0.0,5.0,2\n"
                  "10.2,long_range,r2,r1,99.0,1.0,0.0,99.0,9\n");
    folder_.write("r2/link_trace.csv",
                  "time_s,link,from,to,kbit_s,ms,loss_percent,used_kbit_s,messages\n"
                  "9.8,short_range,r1,r2,4000.0,1.0,0.0,4000.0,60\n"
                  "10.8,short_range,r1,r2,4000.0,1.0,0.0,4000.0,60\n");
    for (const char* robot : {"r1", "r2"})
      folder_.write(std::string(robot) + "/report.json",
                    R"({"topics": [{"link": "long_range", "kind": "node", "received_bytes": 1500},
                                 {"link": "short_range", "kind": "submap_chunk", "received_bytes": 500000}]})");
  }
  std::map<std::string, double> measures() {
    const auto measured = field_measures(folder_.path());
    EXPECT_TRUE(measured) << measured.error().message;
    return measured.value_or(std::map<std::string, double>{});
  }

  testing::TemporaryFolder folder_;
};

TEST_F(FieldMeasures, ANodesWayIsFromItsMakingToEachOtherRobot) {
  auto all = measures();
  EXPECT_THAT(all["field.node_p50_s"], DoubleNear(0.5, 1e-6));
  EXPECT_THAT(all["field.node_p95_s"], DoubleNear(2.0, 1e-6));
  EXPECT_THAT(all["field.nodes_missing"], DoubleNear(25.0, 1e-9)) << "r1#7/2 never came to r2";
}

TEST_F(FieldMeasures, GoodputIsOfTheSecondsInWhichAnyRobotFilledTheChannel) {
  // 1 MB in the seconds 9 and 10.
  EXPECT_THAT(measures()["field.wifi_goodput_kbit_s"], DoubleNear(4000.0, 1e-9));
}

TEST_F(FieldMeasures, CountersAndKindsAreThere) {
  auto all = measures();
  EXPECT_EQ(all["field.all_know_s"], 0.5);
  EXPECT_EQ(all["field.worst_kbit_s"], 152.0);
  EXPECT_FALSE(all.contains("field.ended_s")) << "they did not end by themselves";
  EXPECT_THAT(all["field.long_range.node_kb"], DoubleNear(3.0, 1e-9));
}

TEST_F(FieldMeasures, AMissingFileIsNamed) {
  std::filesystem::remove(folder_.path() / "r2" / "report.json");
  const auto measured = field_measures(folder_.path());
  ASSERT_FALSE(measured);
  EXPECT_THAT(measured.error().message, HasSubstr("report.json"));
}

TEST_F(FieldMeasures, FilesThatLackAColumnOrATopicsNumberAreNamed) {
  const auto why = [&] {
    const auto measured = field_measures(folder_.path());
    return measured ? std::string("accepted") : measured.error().message;
  };
  folder_.write("r2/report.json", R"({"topics": [{"link": "long_range", "received_bytes": "many"}]})");
  EXPECT_THAT(why(), HasSubstr("r2/report.json: a topic lacks"));
  folder_.write("r2/report.json", "[1, 2]");
  EXPECT_THAT(why(), HasSubstr("r2/report.json: lists no topics"));
  SetUp();
  folder_.write("r2/link_trace.csv", "time_s,from,to\n1.0,r1,r2\n");
  EXPECT_THAT(why(), HasSubstr("link_trace.csv: its first line names no column 'link'"));
  SetUp();
  folder_.write("r2/node_times.csv", "node\nr1#7/0\n");
  EXPECT_THAT(why(), HasSubstr("node_times.csv: its first line names no column 'time_ns'"));
}

/// They are no times; as seconds of the day they would be undefined.
TEST_F(FieldMeasures, TimesThatAreNoneAreLeftOut) {
  folder_.write("r2/link_trace.csv",
                "time_s,link,kbit_s\n9.8,short_range,4000.0\n10.8,short_range,4000.0\nnan,short_range,1\n"
                "inf,short_range,1\n1e300,short_range,1\n");
  EXPECT_THAT(measures()["field.wifi_goodput_kbit_s"], DoubleNear(4000.0, 1e-9));
}

TEST_F(FieldMeasures, AFolderWithoutRobotsIsRefused) {
  for (const char* robot : {"r1", "r2"}) std::filesystem::remove_all(folder_.path() / robot);
  EXPECT_FALSE(field_measures(folder_.path()));
}

}  // namespace
}  // namespace fleetmap::experiment
