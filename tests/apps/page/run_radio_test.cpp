#include "page/run_radio.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "fleetmap/output/link_trace.hpp"
#include "support/robots.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// kSelf heard kPeer for a second; its file ends within a line. Both left a report.
class RunRadio : public ::testing::Test {
 protected:
  RunRadio() {
    output::LinkTraceRow row{Stamp{std::chrono::seconds(5)}, "long_range", kPeer, kSelf};
    row.used_kbit_s = 0.8;
    row.messages = 1;
    for (const AgentId& robot : {kSelf, kPeer}) {
      const auto folder = folder_.path() / robot.str();
      std::filesystem::create_directories(folder);
      std::ofstream(folder / "store.db") << "is not read";
      std::ofstream(folder / "report.json")
          << R"({"topics": [{"link": "long_range", "kind": "node", "sent_bytes": 7, "received_bytes": 9}]})";
      run_.files.push_back({robot, folder, folder / "store.db"});
    }
    std::ofstream(run_.files[0].folder / output::kLinkTraceFile) << output::kLinkTraceHeader << '\n'
                                                                 << to_line(row) << "\n5.0,lon";
  }
  testing::TemporaryFolder folder_;
  LoadedRun run_;
};

TEST_F(RunRadio, IsOfAllRobotsWhoseFilesAreThere) {
  add_radio(run_, {});
  const monitor::RadioHistory& radio = run_.view.radio;
  EXPECT_THAT(radio.traces, ElementsAre(kSelf));
  ASSERT_THAT(radio.links, SizeIs(1));
  EXPECT_EQ(radio.links[0].bytes, 100.0);
  EXPECT_THAT(radio.reports, ElementsAre(kSelf, kPeer));
  ASSERT_THAT(radio.kinds, SizeIs(1));
  EXPECT_EQ(radio.kinds[0].received_bytes, 18u);
  EXPECT_THAT(run_.view.notes, ElementsAre(HasSubstr("link_trace.csv: 1 lines cannot be read")));
}

TEST_F(RunRadio, OfARobotThatIsLeftOutNothingIsThere) {
  add_radio(run_, std::vector{kPeer});
  EXPECT_THAT(run_.view.radio.traces, ElementsAre(kSelf));
  EXPECT_THAT(run_.view.radio.links, IsEmpty());
  EXPECT_THAT(run_.view.radio.kinds, IsEmpty()) << "kSelf's report counts what came from kPeer, too";
  add_radio(run_, std::vector{kSelf});
  EXPECT_THAT(run_.view.radio.traces, IsEmpty());
}

}  // namespace
}  // namespace fleetmap::apps
